"""Boxes and hulls, sharp and rounded."""
