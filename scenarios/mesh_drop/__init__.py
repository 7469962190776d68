"""A part, given as a mesh, is dropped on flat ground."""

from scenarios.mesh_drop.scenario import MeshDrop

__all__ = ["MeshDrop"]
