"""Numbers of an edge in tables of compiled functions."""

START, ALONG, LENGTH, INTO_FIRST, INTO_SECOND = 0, 3, 6, 7, 10
"""Offsets in the row of an edge: first end [m], unit vector along the edge, length [m], unit vectors from the edge into
its two faces."""
