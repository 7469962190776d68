"""Boxes with their edges along each other, where FCL is wrong for some poses."""

from __future__ import annotations

import numpy as np

from nonsmooth.interfaces.body import Vector
from nonsmooth.interfaces.distance_backend import Place

_ALIGNED = 1e-9


def aligned_boxes(one: Place, half: Vector, two: Place, other: Vector) -> tuple[float, Vector, Vector] | None:
    """Return distance [m] and nearest points of two boxes whose edges are parallel to 1e-9 rad; else None.

    Parameters
    ----------
    one, two : tuple
        Centre [m], shape [3], and axes as columns, shape [3, 3].
    half, other : Vector
        Half-lengths along their axes [m], shape [3].
    """
    (place, axes), (second_place, second_axes) = one, two
    relative = axes.T @ second_axes
    signs = np.round(relative)
    if np.max(np.abs(relative - signs)) > _ALIGNED:
        return None
    reach = np.abs(signs) @ other
    way = axes.T @ (second_place - place)
    # along every axis the nearest interval of either box, in the frame of the first
    low, high = np.maximum(-half, way - reach), np.minimum(half, way + reach)
    middle = 0.5 * (low + high)
    # where the intervals do not meet, low is above high: the ends that face each other
    apart = low > high
    first = np.where(apart, np.where(way > 0.0, half, -half), middle)
    second = np.where(apart, np.where(way > 0.0, way - reach, way + reach), middle)
    distance = float(np.linalg.norm(second - first))
    return distance, place + axes @ first, place + axes @ second
