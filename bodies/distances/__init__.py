"""Distances of solids by libraries for collision detection: seeds and an independent look, never the gap of a run."""
