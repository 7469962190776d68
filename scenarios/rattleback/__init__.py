"""The rattleback (scenario.py), and the equations of its rolling, by which it is judged (rolling.py)."""

from .scenario import Rattleback

__all__ = ["Rattleback"]
