"""Painleve's rod (scenario.py), closed forms of its contact (paradox.py) and its figures (figures.py)."""

from .scenario import SlidingRod

__all__ = ["SlidingRod"]
