"""Dominoes."""

from scenarios.dominoes.scenario import Dominoes

__all__ = ["Dominoes"]
