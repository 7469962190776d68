"""A tower of prisms."""
