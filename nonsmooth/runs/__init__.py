"""Runs of a model: start, calls of the engine, output under way, and the end with its diagnosis."""
