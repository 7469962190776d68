"""Orientations as an axis and an angle."""

from __future__ import annotations

import math
from collections.abc import Sequence

from nonsmooth.checks import is_finite
from nonsmooth.errors import InvalidInput
from nonsmooth.vectors import unit_vector


def turned_about(axis: Sequence[float], angle: float) -> tuple[float, float, float, float]:
    """Return the orientation of a body that is turned about an axis, for ``System.place`` and wherever one is asked.

    Parameters
    ----------
    axis : sequence of float
        Unit vector of the axis, shape [3].
    angle : float
        The turn [rad], by the right-hand rule.

    Returns
    -------
    tuple of float
        The unit quaternion (cos(angle / 2), axis * sin(angle / 2)), scalar first.

    Raises
    ------
    InvalidInput
        If the axis has not unit length, or the angle is not finite.
    """
    x, y, z = unit_vector("turned_about: axis", axis)
    if not is_finite(angle):
        raise InvalidInput("turned_about: angle", "must be a finite number", angle, "Give it in [rad].")
    s = math.sin(0.5 * angle)
    return math.cos(0.5 * angle), x * s, y * s, z * s
