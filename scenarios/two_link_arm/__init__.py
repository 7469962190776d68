"""A two-link arm on a belt (scenario.py), its equations of motion (arm.py), and its paradox (painleve.py)."""

from .scenario import TwoLinkArm

__all__ = ["TwoLinkArm"]
