"""The part that is dropped where no file is given: an angle with a foot, not convex."""

from __future__ import annotations

from bodies import Triangles

OUTLINE = ((0.0, 0.0), (0.06, 0.0), (0.06, 0.01), (0.012, 0.01), (0.012, 0.04), (0.0, 0.04))
"""An L [m], counter-clockwise."""
_CAPS = ((0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5))
_DEPTH, _TAPER = 0.03, 0.25
"""Depth along z [m], and the part by which the far end is smaller, so that no two faces are alike."""


def bracket() -> Triangles:
    """Return a closed surface of 12 vertices and 20 triangles, 60 mm long."""
    n = len(OUTLINE)
    near = [(x, y, 0.0) for x, y in OUTLINE]
    far = [((1.0 - _TAPER) * x, (1.0 - _TAPER) * y, _DEPTH) for x, y in OUTLINE]
    faces = [(a, c, b) for a, b, c in _CAPS] + [(a + n, b + n, c + n) for a, b, c in _CAPS]
    for i in range(n):
        j = (i + 1) % n
        faces += [(i, j, j + n), (i, j + n, i + n)]
    return Triangles((*near, *far), tuple(faces), "bracket")
