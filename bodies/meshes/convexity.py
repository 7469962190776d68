"""Convex hulls, and how far a surface is from convex."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from bodies.meshes.topology import Integers, neighbours
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.body import Vector

FLATNESS = 1e-6
"""Depth of a dent that counts as none, over the largest extent: files with few digits have such dents in flat faces."""
_SINGLE = 5e-7
"""The same over the largest coordinate: single precision, of bodies that lie far from the origin."""
_NO_CORNER = 2e-7
"""A point of the hull is left out where that moves the surface by less than this part of its largest coordinate: one in
a face or on an edge, shifted by single precision."""


@final
@dataclass(frozen=True, eq=False)
class Hull:
    """A convex hull.

    Attributes
    ----------
    corners : Vector
        Its corners [m], shape [n, 3].
    volume : float
        Its volume [m^3].
    """

    corners: Vector
    volume: float


def hull_of(name: str, vertices: Vector) -> Hull:
    """Return the convex hull of points that are not in a plane."""
    from scipy.spatial import ConvexHull, QhullError

    middle = 0.5 * (np.min(vertices, axis=0) + np.max(vertices, axis=0))
    scale = float(np.max(np.ptp(vertices, axis=0)))
    try:
        found = ConvexHull((vertices - middle) / scale)
    except QhullError as error:
        raise InvalidInput(
            f"mesh {name}", "must not be flat", str(error).split("\n")[0], "A body has a volume."
        ) from error
    shallow = _NO_CORNER * max(scale, float(np.max(np.abs(vertices)))) / scale
    kept = _corners((vertices - middle) / scale, found.simplices, found.equations[:, :3], shallow)
    return Hull(vertices[kept], float(found.volume) * scale**3)


def _corners(points: Vector, facets: Integers, normals: Vector, shallow: float) -> Integers:
    """Return the points that stand out of what is about them; others lie in a face or on an edge.

    The normals about a point in a face lie on a line, those about one on an edge in a plane, to an angle that makes
    the height of the point when multiplied by the distance of its neighbours.
    """
    kept = []
    order = np.argsort(facets, axis=None, kind="stable")
    numbers, starts = np.unique(facets.ravel()[order], return_index=True)
    for number, about in zip(numbers.tolist(), np.split(order // 3, starts[1:]), strict=True):
        angles = np.linalg.svd(normals[about], compute_uv=False)
        distance = np.max(np.linalg.norm(points[facets[about].ravel()] - points[number], axis=1))
        if len(angles) == 3 and angles[2] * distance > shallow:
            kept.append(number)
    return np.array(kept, dtype=np.int64)


def is_convex(vertices: Vector, faces: Integers) -> bool:
    """Return whether a closed surface of one shell is convex, but for dents as shallow as files make them."""
    extent, farthest = float(np.max(np.ptp(vertices, axis=0))), float(np.max(np.abs(vertices)))
    return dent(vertices, faces) <= max(FLATNESS * extent, _SINGLE * farthest)


def dent(vertices: Vector, faces: Integers) -> float:
    """Return the largest height of a neighbour's far corner over the plane of a triangle [m]; 0 if all are below.

    A closed surface of one shell that is convex at every edge is convex.
    """
    pairs = neighbours(faces)
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    one = pairs[:, 0] // 3
    far = faces.reshape(-1)[pairs[:, 1] // 3 * 3 + (pairs[:, 1] % 3 + 2) % 3]
    heights = np.einsum("ni,ni->n", vertices[far] - a[one], normals[one])
    return max(float(np.max(heights)), 0.0)
