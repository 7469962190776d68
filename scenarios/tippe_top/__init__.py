"""The tippe top (scenario.py), and the friction of its contact disc (friction.py)."""

from scenarios.tippe_top.scenario import TippeTop

__all__ = ["TippeTop"]
