"""Pairs of convex parts of bodies: how far they are apart, or how deep they overlap."""
