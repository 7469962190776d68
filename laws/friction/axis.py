"""The axis of a body along which and across which friction differs."""

from __future__ import annotations

import math
from typing import Any

from nonsmooth.errors import InvalidInput
from nonsmooth.parameters import parameter


def axis_parameter() -> Any:
    """Declare a direction in the frame of a body, which is projected on the tangent plane.

    Where it stands along the normal, the axis of the body's frame that is least along it takes its place.
    """
    return parameter((1.0, 0.0, 0.0), doc="axis in the frame of the body, projected on the tangent plane", unit="")


def body_parameter() -> Any:
    """Declare which body of the contact the axis is fixed to."""
    return parameter("second", doc="body of the contact that has the axis", unit="", choices=("first", "second"))


def check_axis(thing: str, axis: tuple[float, float, float]) -> None:
    """Raise InvalidInput unless an axis is three finite numbers, not all zero."""
    if len(axis) != 3 or not all(math.isfinite(x) for x in axis) or math.hypot(*axis) == 0.0:
        raise InvalidInput(thing, "must be three finite numbers, not all zero", axis, "For example (1, 0, 0).")
