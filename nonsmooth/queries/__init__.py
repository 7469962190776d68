"""Queries without a run: distances of bodies and shapes, and the pairs of bodies that are near each other."""
