"""Runs of models: again, from anywhere, in several threads."""
