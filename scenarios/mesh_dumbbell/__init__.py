"""The dumbbell with balls out of triangles beside the one with balls."""
