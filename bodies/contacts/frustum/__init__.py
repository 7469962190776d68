"""Cylinders, cones and discs: their parts, and contacts of these with each other."""
