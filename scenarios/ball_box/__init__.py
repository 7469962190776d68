"""Balls that fall into an open box and come to rest."""

from scenarios.ball_box.scenario import BallBox

__all__ = ["BallBox"]
