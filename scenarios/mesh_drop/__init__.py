"""A part, given as a mesh, that falls on flat ground (scenario.py), and its figures (figures.py)."""

from .scenario import MeshDrop

__all__ = ["MeshDrop"]
