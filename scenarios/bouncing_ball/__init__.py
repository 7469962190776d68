"""A ball on a vibrating table (scenario.py), its orbits in closed form (orbits.py) and figures (figures.py)."""

from .scenario import BouncingBall

__all__ = ["BouncingBall"]
