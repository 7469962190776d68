"""Spheres and capsules in closed form."""
