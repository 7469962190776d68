"""Three balls, rigidly joined, on a vibrating plate."""

from scenarios.bouncing_trimer.scenario import BouncingTrimer

__all__ = ["BouncingTrimer"]
