"""Closed surfaces of triangles, out of files or arrays: checked, measured, repaired on request."""
