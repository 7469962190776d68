"""Distances of cylinders, cones and discs from closed surfaces, found in another way than by the contact pairs."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from bodies import Frustum, TriangleMesh
from bodies.shapes.frustum import AXIS, CENTER, HIGH, LOW
from tests.bodies.surfaces import is_inside

Array = NDArray[Any]
_GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)
_STEPS = 60


def _from_core(shape: Frustum, points: Array) -> Array:
    """Return how far points of the body frame are from the core, 0 within; by the outline in the half-plane."""
    low, high, below, above = shape.frustum[:4]
    axes = np.array(shape.frustum[AXIS - 2 : AXIS + 7]).reshape(3, 3)
    own = (points - shape.frustum[CENTER : CENTER + 3]) @ axes
    point = np.stack([np.hypot(own[..., 0], own[..., 1]), own[..., 2]], axis=-1)
    outline = np.array([(0.0, below), (low, below), (high, above), (0.0, above)])
    nearest, inside = np.full(point.shape[:-1], np.inf), np.ones(point.shape[:-1], dtype=bool)
    for one, two in itertools.pairwise(outline):
        way, off = two - one, point - one
        share = np.clip(off @ way / max(float(way @ way), 1e-300), 0.0, 1.0)
        nearest = np.minimum(nearest, np.linalg.norm(off - share[..., None] * way, axis=-1))
        inside &= way[0] * off[..., 1] - way[1] * off[..., 0] >= 0.0
    return np.where(inside & (above > below), 0.0, nearest)


def _inner_points(shape: Frustum) -> Array:
    """Return points of the core in the body frame, on rings about the axis."""
    low, high, below, above = shape.frustum[:4]
    axes = np.array(shape.frustum[AXIS - 2 : AXIS + 7]).reshape(3, 3)
    share, part, angle = np.meshgrid(np.linspace(0, 1, 6), [0.0, 0.5, 1.0], np.arange(24) * np.pi / 12, indexing="ij")
    away = part * (low + share * (high - low))
    rings = np.stack([away * np.cos(angle), away * np.sin(angle), below + share * (above - below)], axis=-1)
    return np.asarray(shape.frustum[CENTER : CENTER + 3] + rings.reshape(-1, 3) @ axes.T)


def core_distance(mesh: TriangleMesh, shape: Frustum, place: Array, turn: Rotation) -> float:
    """Return the distance of the core of a body at a pose from a surface at the origin [m], 0 where they overlap.

    Along a straight line the distance of a convex body has one minimum, which is found by golden sections; over the
    inside of a triangle it can only be that of the lowest point of a rim, or of the apex.
    """
    corners = mesh.features.vertices[mesh.features.triangles]
    axes = np.array(shape.frustum[AXIS - 2 : AXIS + 7]).reshape(3, 3)
    center = turn.apply(np.array(shape.frustum[CENTER : CENTER + 3])) + place
    axis = turn.apply(axes[:, 2])
    if np.any(is_inside(turn.apply(_inner_points(shape)) + place, corners)):
        return 0.0
    starts, ends = corners.reshape(-1, 3), np.roll(corners, -1, axis=1).reshape(-1, 3)

    def at(share: Array) -> Array:
        return _from_core(shape, turn.inv().apply(starts + share[:, None] * (ends - starts) - place))

    low, high = np.zeros(len(starts)), np.ones(len(starts))
    for _ in range(_STEPS):
        one, two = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
        left = at(one) <= at(two)
        low, high = np.where(left, low, one), np.where(left, two, high)
    found = float(np.min(np.minimum(at(low), at(high))))
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    for radius, height in zip(shape.frustum[:2], shape.frustum[LOW : HIGH + 1], strict=True):
        across = -normals + (normals @ axis)[:, None] * axis
        across /= np.maximum(np.linalg.norm(across, axis=1), 1e-300)[:, None]
        points = center + height * axis + radius * across
        over = np.einsum("ni,ni->n", points - corners[:, 0], normals)
        within = np.ones(len(points), dtype=bool)
        for i in range(3):
            inward = np.cross(normals, corners[:, (i + 1) % 3] - corners[:, i])
            within &= np.einsum("ni,ni->n", points - corners[:, i], inward) >= 0.0
        found = min(found, float(np.min(over[within & (over > 0.0)], initial=np.inf)))
    return found
