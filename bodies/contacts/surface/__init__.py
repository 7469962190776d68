"""Surfaces of triangles: tables, searches, and the features of one with a point, an edge or a smooth body."""
