"""Planted faults: what a tier of the tests finds."""
