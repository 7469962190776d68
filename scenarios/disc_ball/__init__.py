"""A disc that strikes two balls at rest: Bernoulli's problem."""

from scenarios.disc_ball.scenario import DiscBall

__all__ = ["DiscBall"]
