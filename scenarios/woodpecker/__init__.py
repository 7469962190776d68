"""The woodpecker toy (scenario.py): a bird on a sleeve that pecks its way down a pole; its equations (toy.py)."""

from .scenario import Woodpecker

__all__ = ["Woodpecker"]
