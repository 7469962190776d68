"""A disc that strikes two balls (scenario.py), the cases in closed form (closed_forms.py), figures (figures.py)."""

from .scenario import DiscBall

__all__ = ["DiscBall"]
