"""Volume, centre and inertia inside of a closed surface, exact for a polyhedron; how often it goes round a point."""

from __future__ import annotations

import numpy as np

from nonsmooth.interfaces.body import Vector

from .topology import Integers


def volume_of(vertices: Vector, faces: Integers) -> float:
    """Return the volume [m^3], negative where the triangles are clockwise seen from outside."""
    a, b, c = _corners(vertices, faces, _middle(vertices))
    return float(np.sum(_determinants(a, b, c))) / 6.0


def mass_properties(vertices: Vector, faces: Integers) -> tuple[float, Vector, Vector]:
    """Return volume [m^3], centroid [m], shape [3], and inertia at density 1 about it [m^5], shape [3, 3].

    By the divergence theorem, as sums over tetrahedra.  Their common corner is the middle of the body: far from it the
    large contributions would cancel.
    """
    middle = _middle(vertices)
    a, b, c = _corners(vertices, faces, middle)
    weights = _determinants(a, b, c)
    volume = float(np.sum(weights)) / 6.0
    sums = a + b + c
    offset = weights @ sums / 24.0 / volume
    moments = sum((np.einsum("n,ni,nj->ij", weights, x, x) for x in (a, b, c, sums)), np.zeros((3, 3))) / 120.0
    moments -= volume * np.outer(offset, offset)
    inertia = np.trace(moments) * np.eye(3) - moments
    return volume, middle + offset, 0.5 * (inertia + inertia.T)


def winding_number(vertices: Vector, faces: Integers, point: Vector) -> float:
    """Return how often the surface goes round a point: 1 inside, 0 outside of a closed one.

    The solid angle of every triangle by A. Van Oosterom and J. Strackee, IEEE Trans. Biomed. Eng. BME-30 (1983) 125.
    """
    a, b, c = _corners(vertices, faces, point)
    la, lb, lc = (np.linalg.norm(x, axis=1) for x in (a, b, c))
    below = la * lb * lc + _dot(a, b) * lc + _dot(b, c) * la + _dot(c, a) * lb
    return float(np.sum(np.arctan2(_determinants(a, b, c), below))) / (2.0 * np.pi)


def areas_of(vertices: Vector, faces: Integers) -> Vector:
    """Return the areas of the triangles [m^2], shape [m]."""
    a, b, c = _corners(vertices, faces, np.zeros(3))
    return np.asarray(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1))


def _middle(vertices: Vector) -> Vector:
    return np.asarray(0.5 * (np.min(vertices, axis=0) + np.max(vertices, axis=0)))


def _corners(vertices: Vector, faces: Integers, origin: Vector) -> tuple[Vector, Vector, Vector]:
    corners = vertices[faces] - origin
    return corners[:, 0], corners[:, 1], corners[:, 2]


def _determinants(a: Vector, b: Vector, c: Vector) -> Vector:
    return _dot(a, np.cross(b, c))


def _dot(a: Vector, b: Vector) -> Vector:
    return np.asarray(np.einsum("ni,ni->n", a, b))
