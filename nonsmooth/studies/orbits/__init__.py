"""Periodic orbits: found, followed along a parameter, and what happens to them there."""
