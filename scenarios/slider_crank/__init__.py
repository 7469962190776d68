"""A slider-crank mechanism with clearance (scenario.py) and its equations of motion (mechanism.py)."""

from .scenario import SliderCrank

__all__ = ["SliderCrank"]
