"""Spheres, also against capsules and boxes, in closed form."""
