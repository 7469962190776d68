"""A ball of triangles."""

from __future__ import annotations

import math

import numpy as np

from bodies import Triangles

_GOLDEN = 0.5 * (1.0 + math.sqrt(5.0))
_CORNERS = [
    *((0.0, a, b * _GOLDEN) for a in (-1.0, 1.0) for b in (-1.0, 1.0)),
    *((a, b * _GOLDEN, 0.0) for a in (-1.0, 1.0) for b in (-1.0, 1.0)),
    *((b * _GOLDEN, 0.0, a) for a in (-1.0, 1.0) for b in (-1.0, 1.0)),
]


def ball(radius: float, subdivisions: int) -> Triangles:
    """Return an icosahedron whose triangles are cut into four so many times, with all vertices on a ball [m]."""
    from scipy.spatial import ConvexHull

    points = np.array(_CORNERS) / math.hypot(1.0, _GOLDEN)
    for _ in range(subdivisions):
        triangles = ConvexHull(points).simplices
        edges = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
        middles = np.sum(points[edges], axis=1)
        points = np.vstack([points, middles / np.linalg.norm(middles, axis=1)[:, None]])
    hull = ConvexHull(points)
    corners = points[hull.simplices]
    # Qhull does not say in which sense it goes round a facet
    inward = (
        np.einsum("ni,ni->n", np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), corners[:, 0]) < 0
    )
    faces = np.where(inward[:, None], hull.simplices[:, ::-1], hull.simplices)
    return Triangles(radius * points, faces, f"of {len(faces)} triangles")
