"""A rigid triangle of balls on a vibrating plate (scenario.py), its attractors (motion.py), figures (figures.py)."""

from scenarios.bouncing_trimer.scenario import BouncingTrimer

__all__ = ["BouncingTrimer"]
