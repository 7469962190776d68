"""Meshes to draw shapes with, and what follows from any mesh: vertices [n, 3] and triangles [m, 3]."""

from __future__ import annotations

from typing import Any

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.body import Vector
from nonsmooth.vectors import perpendiculars


def check_fineness(fineness: int) -> None:
    """Raise InvalidInput unless a circle drawn with so many edges has an area."""
    if fineness < 3:
        raise InvalidInput("fineness", "must be at least 3", fineness, "It is the number of edges round a circle.")


def revolved(profile: Any, fineness: int, center: Any, axis: Any) -> tuple[Vector, Vector]:
    """Return the mesh of a profile that turns about an axis.

    Parameters
    ----------
    profile : array_like
        Distances from the axis and heights along it, rising from the lower pole to the upper one [m, shape (k, 2)]; the
        distances of both poles are 0 and no other is.
    fineness : int
        Number of edges round the axis.
    center, axis : array_like
        Where height 0 stands [m] and the unit axis, shape [3] each.
    """
    check_fineness(fineness)
    rings = np.asarray(profile, dtype=float)
    (first, second), along = perpendiculars(axis), np.asarray(axis, dtype=float)
    angles = 2.0 * np.pi * np.arange(fineness) / fineness
    round_axis = np.outer(np.cos(angles), first) + np.outer(np.sin(angles), second)
    inner = [radius * round_axis + height * along for radius, height in rings[1:-1]]
    vertices = np.vstack([rings[0, 1] * along, *inner, rings[-1, 1] * along]) + np.asarray(center)
    step = np.arange(fineness)
    after, last = (step + 1) % fineness, len(vertices) - 1
    faces = [np.column_stack([np.zeros_like(step), 1 + after, 1 + step])]
    for ring in range(len(inner) - 1):
        low = 1 + ring * fineness
        high = low + fineness
        faces.append(np.column_stack([low + step, low + after, high + after]))
        faces.append(np.column_stack([low + step, high + after, high + step]))
    top = 1 + (len(inner) - 1) * fineness
    faces.append(np.column_stack([top + step, top + after, np.full_like(step, last)]))
    return vertices, np.vstack(faces)


def arc(fineness: int, start: float, end: float) -> Vector:
    """Return sine and cosine of the angles from ``start`` to ``end`` [rad] as (distance, height), shape [k, 2]."""
    steps = max(2, round(fineness * (start - end) / (2.0 * np.pi)))
    angles = np.linspace(start, end, steps + 1)
    points = np.column_stack([np.sin(angles), np.cos(angles)])
    points[np.abs(points) < 1e-15] = 0.0
    return points


def solid_of(vertices: Vector, faces: Vector) -> tuple[float, Vector, Vector]:
    """Return volume [m^3], centroid [m] and inertia tensor at density 1 about the centroid [m^5] of a closed mesh.

    The signed tetrahedra of the triangles and a point in the middle, so that a place far from the origin costs no
    digits: S. Mirtich's integrals ("Fast and accurate computation of polyhedral mass properties", J. Graphics Tools 1
    (1996) 31-50) in the form of covariances.
    """
    middle = 0.5 * (np.min(vertices, axis=0) + np.max(vertices, axis=0))
    corners = (vertices - middle)[faces]
    sixfold = np.linalg.det(corners)
    volume = float(np.sum(sixfold)) / 6.0
    offset = sixfold @ np.sum(corners, axis=1) / 24.0 / volume
    corners = corners - offset
    sixfold, sums = np.linalg.det(corners), np.sum(corners, axis=1)
    second = np.einsum("t,ti,tj->ij", sixfold, sums, sums) + np.einsum("t,tci,tcj->ij", sixfold, corners, corners)
    second /= 120.0
    return volume, middle + offset, np.trace(second) * np.eye(3) - second
