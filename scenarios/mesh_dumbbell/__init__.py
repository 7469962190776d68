"""The dumbbell with balls out of triangles beside the one with balls."""

from scenarios.mesh_dumbbell.scenario import MeshDumbbell

__all__ = ["MeshDumbbell"]
