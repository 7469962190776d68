"""Pairs of bodies that meet head on, in line with their axes, and the closed forms of their collisions."""
