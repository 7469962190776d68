"""Dice, thrown."""
