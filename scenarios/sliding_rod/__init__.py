"""Painleve's rod (scenario.py), closed forms of its contact (paradox.py) and its figures (figures.py)."""

from scenarios.sliding_rod.scenario import SlidingRod

__all__ = ["SlidingRod"]
