"""Runs of a model: where they start, the loop that feeds the engine, what comes of them."""
