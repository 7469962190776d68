"""A rigid triangle of balls on a vibrating plate (scenario.py), its attractors (motion.py), figures (figures.py)."""

from .scenario import BouncingTrimer

__all__ = ["BouncingTrimer"]
