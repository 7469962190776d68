"""Convex hulls, and how far a surface is from convex."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.body import Vector

from .topology import Integers, neighbours

FLATNESS = 1e-6
"""Depth up to which a dent is ignored, relative to the largest extent: files with few digits dent flat faces."""
_SINGLE = 5e-7
"""Depth up to which a dent is ignored, relative to the largest coordinate: the round-off of single precision."""
BENT = 2e-7
"""Facets of the hull that stand out of a plane by less than this part of the largest coordinate are one face: they are
bent by single precision."""
_LEAST_CORNERS = 4
"""Corners of the simplest body, a tetrahedron."""


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
    moved : float
        By how much corners were moved to make faces flat that single precision had bent [m].
    """

    corners: Vector
    volume: float
    moved: float


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
    shallow = BENT * max(scale, float(np.max(np.abs(vertices)))) / scale
    corners = _corners(found, shallow)
    if len(corners) < _LEAST_CORNERS:
        thickness = float(np.min(np.ptp(found.points @ _principal_axes(found.points), axis=0))) * scale
        raise InvalidInput(
            f"mesh {name}",
            f"must be thicker than {shallow * scale:.3g} m, below which its faces count as one",
            thickness,
            "Take a thicker body; single precision, which most files have, does not tell such faces apart.",
        )
    unit = found.points[corners]
    flat = flattened(unit, shallow)
    moved = float(np.max(np.linalg.norm(flat - unit, axis=1))) * scale
    return Hull(flat * scale + middle, float(found.volume) * scale**3, moved)


def _principal_axes(points: Vector) -> Vector:
    """Return the axes along which points scatter, in columns, shape [3, 3]."""
    return np.asarray(np.linalg.svd(points - np.mean(points, axis=0), full_matrices=False)[2].T)


def flattened(corners: Vector, shallow: float) -> Vector:
    """Return the corners of a hull, moved so that faces of more than three that are flat to ``shallow`` are flat.

    Every corner goes to the nearest point on the planes fitted to those faces; where more than three of them meet in
    it, planes and corners are fitted in turn.
    """
    from scipy.spatial import ConvexHull

    hull = ConvexHull(corners)
    groups = [face for face in _faces(hull, shallow) if len(np.unique(hull.simplices[face])) > 3]
    for _ in range(10):
        planes: dict[int, list[tuple[Vector, float]]] = {}
        for face in groups:
            about = np.unique(hull.simplices[face])
            normal = _normal(corners, hull.simplices[face], hull.equations[face, :3])
            for corner in about.tolist():
                planes.setdefault(corner, []).append((normal, float(np.mean(corners[about] @ normal))))
        before, corners = corners, corners.copy()
        for corner, own in planes.items():
            normals, heights = np.array([n for n, _ in own]), np.array([h for _, h in own])
            corners[corner] += np.linalg.lstsq(normals, heights - normals @ corners[corner], rcond=1e-6)[0]
        if np.max(np.abs(corners - before)) < 1e-16:
            break
    return corners


def _normal(corners: Vector, triangles: Integers, outward: Vector) -> Vector:
    """Return the unit normal of triangles in one plane, weighted by their areas."""
    a, b, c = (corners[triangles[:, i]] for i in range(3))
    crosses = np.cross(b - a, c - a)
    normal = np.sum(crosses * np.sign(np.einsum("ni,ni->n", crosses, outward))[:, None], axis=0)
    return np.asarray(normal / np.linalg.norm(normal))


def _faces(hull: Any, shallow: float) -> list[list[int]]:
    """Return the groups of facets of which no corner is farther than ``shallow`` from the plane of the largest."""
    corners, facets = hull.points, hull.simplices
    areas = np.linalg.norm(
        np.cross(corners[facets[:, 1]] - corners[facets[:, 0]], corners[facets[:, 2]] - corners[facets[:, 0]]), axis=1
    )
    free, groups = np.ones(len(facets), dtype=bool), []
    for seed in np.argsort(-areas).tolist():
        if not free[seed]:
            continue
        free[seed] = False
        group, heap = [seed], [seed]
        while heap:
            for other in hull.neighbors[heap.pop()].tolist():
                heights = corners[facets[other]] @ hull.equations[seed, :3] + hull.equations[seed, 3]
                if free[other] and np.max(np.abs(heights)) <= shallow:
                    free[other] = False
                    group.append(other)
                    heap.append(other)
        groups.append(group)
    return groups


def _corners(hull: Any, shallow: float) -> Integers:
    """Return the points at which at least three faces meet; others lie in a face or on an edge."""
    met: dict[int, int] = {}
    for face in _faces(hull, shallow):
        for point in np.unique(hull.simplices[face]).tolist():
            met[point] = met.get(point, 0) + 1
    return np.array(sorted(point for point, count in met.items() if count >= 3), dtype=np.int64)


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
