"""The rattleback (scenario.py), and equations of rolling, with which its runs are compared (rolling.py)."""

from .scenario import Rattleback

__all__ = ["Rattleback"]
