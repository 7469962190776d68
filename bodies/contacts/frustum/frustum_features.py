"""Features of a frustum for lists of contacts: names of parts, rims set back by the feet, feet and apex."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from ...shapes.frustum import AXIS, CENTER, COS, HIGH_RADIUS, SIDE, SIN, SWEEP, Frustum, Point, frustum_numbers
from ..surface.surface_tables import Numbers
from .frustum import HIGH_RIM, LOW_RIM

_N_EDGES = 12
"""Number of unit vectors that represent edges of an apex (down the side of the cone) or of a foot (along the cap).

An apex or a foot is treated as a corner with these edges, evenly spaced around the axis.  A face can touch it only if
no edge points into the face steeper than :data:`bodies.contacts.features.edge_crossing.CONE_MARGIN`.  The steepest of
12 edges along a cap has at least cos(15 deg) = 0.966 of the largest sine over all directions.
"""


def part_names(numbers: Sequence[float]) -> tuple[str, ...]:
    """Return the names of the parts that a frustum has, in the order of :func:`part_number`."""
    if numbers[SIDE] == 0.0:
        return "face -", "rim", "face +"
    if numbers[HIGH_RADIUS] == 0.0:
        return "base", "rim", "side", "apex"
    return "cap -", "rim -", "side", "rim +", "cap +"


def set_back(first: Frustum) -> Numbers:
    """Return the numbers of a frustum whose rims are set back by the height of its feet, so that only feet protrude.

    The rims have their radii and centres for contacts with faces (:attr:`bodies.shapes.frustum.Frustum.standing_rims`).
    A rim that rolls from a face over the face's edge then keeps its height.
    """
    own = first.frustum
    center, axis = np.array(own[CENTER : CENTER + 3]), np.array(own[AXIS : AXIS + 7 : 3])
    # a disc has one rim, which is its lower and its upper one
    rims = first.standing_rims if len(first.standing_rims) > 1 else 2 * first.standing_rims
    heights = [float((np.array(place) - center) @ axis) for _, place in rims]
    x, y, z = center.tolist()
    return frustum_numbers(
        [radius for radius, _ in rims], heights, (x, y, z), (axis[0], axis[1], axis[2]), 0.0, own[SWEEP]
    )


def rims_of(numbers: Numbers) -> tuple[int, ...]:
    """Return the numbers of the rims of a frustum; a disc has one rim, an apex is not a rim."""
    return (LOW_RIM, HIGH_RIM) if numbers[SIDE] > 0.0 and numbers[HIGH_RADIUS] > 0.0 else (LOW_RIM,)


def tips_of(first: Frustum, is_sharp: bool) -> Iterator[tuple[Point, Numbers]]:
    """Yield position [m] and unit vectors along :data:`_N_EDGES` edges of each foot and, if ``is_sharp``, of an apex.

    The edges of a foot lie in the plane of the cap, those of an apex on the side.  All vectors are in the body frame;
    the three components of each edge follow one another.
    """
    for foot in first.feet:
        yield foot, _edges_around(first, 1.0, 0.0)
    for radius, place in first.standing_rims:
        if radius == 0.0 and is_sharp:
            yield place, _edges_around(first, first.frustum[SIN], -first.frustum[COS])


def _edges_around(first: Frustum, radial: float, axial: float) -> Numbers:
    """Return ``_N_EDGES`` unit vectors at even angles around the axis in the body frame, three components for each.

    Each has the component ``radial`` away from the axis and ``axial`` along it.
    """
    axes = np.array(first.frustum[AXIS - 2 : AXIS + 7]).reshape(3, 3)
    angles = [2.0 * math.pi * i / _N_EDGES for i in range(_N_EDGES)]
    edges = [axes @ np.array([radial * math.cos(angle), radial * math.sin(angle), axial]) for angle in angles]
    return tuple(float(x) for edge in edges for x in edge)
