"""Comparison of the working tree with another commit."""
