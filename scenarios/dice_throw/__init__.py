"""Dice, thrown."""

from scenarios.dice_throw.scenario import DiceThrow

__all__ = ["DiceThrow"]
