"""Rims, feet and apex of a cylinder, a cone or a disc, as they stand out of each other."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from bodies.contacts.surface.mesh_point import Corner
from bodies.contacts.surface.surface_tables import Numbers
from bodies.shapes.frustum import AXIS, CENTER, COS, SIN, SWEEP, Frustum, frustum_numbers

_WAYS = 12
"""Lines round a cone, or across a cap, of which none may point far into the face that an apex or a foot touches."""


def set_back(first: Frustum) -> Numbers:
    """Return the numbers of the body within its rims as they are set back, out of which only the feet stand.

    So a rim that rolls over the edge of a face goes on at the same height.
    """
    own = first.frustum
    center, axis = np.array(own[CENTER : CENTER + 3]), np.array(own[AXIS : AXIS + 7 : 3])
    rims = first.standing_rims if len(first.standing_rims) > 1 else 2 * first.standing_rims
    heights = [float((np.array(place) - center) @ axis) for _, place in rims]
    x, y, z = center.tolist()
    return frustum_numbers(
        [radius for radius, _ in rims], heights, (x, y, z), (axis[0], axis[1], axis[2]), 0.0, own[SWEEP]
    )


def apex_of(first: Frustum) -> Iterator[Corner]:
    """Yield place, lines of the side and name of the apex of a cone."""
    sine, cosine = first.frustum[SIN], first.frustum[COS]
    for radius, place in first.standing_rims:
        if radius == 0.0:
            yield place, _round(first, sine, -cosine), "apex"


def feet_of(first: Frustum) -> Iterator[Corner]:
    """Yield place, lines of the cap about it and name of the feet."""
    for i, foot in enumerate(first.feet):
        yield foot, _round(first, 1.0, 0.0), f"foot {i}"


def _round(first: Frustum, away: float, along: float) -> Numbers:
    """Return unit vectors round the axis, one after the other."""
    axes = np.array(first.frustum[AXIS - 2 : AXIS + 7]).reshape(3, 3)
    angles = [2.0 * math.pi * i / _WAYS for i in range(_WAYS)]
    ways = [axes @ np.array([away * math.cos(angle), away * math.sin(angle), along]) for angle in angles]
    return tuple(float(x) for way in ways for x in way)
