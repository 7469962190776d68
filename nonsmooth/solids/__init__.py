"""Solids at their places in the world: overlaps, distances and meetings."""
