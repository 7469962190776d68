"""The tippe top (scenario.py), and the friction of its contact disc (friction.py)."""

from .scenario import TippeTop

__all__ = ["TippeTop"]
