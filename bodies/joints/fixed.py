"""Fixed joint: two bodies become one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import final

import numpy as np

from bodies.joints.rows import angle_row, point_row
from bodies.values import turned_back
from nonsmooth.interfaces import Joint
from nonsmooth.interfaces.solid import Vector
from nonsmooth.parameters import Value
from nonsmooth.types import Floats
from nonsmooth.vectors import unit_vector, vector

Point = tuple[float, float, float]


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    first: Floats,
    second: Floats,
    axis: Floats,
    side: Floats,
    other_side: Floats,
    axis_seen: Floats,
    side_seen: Floats,
    other_seen: Floats,
) -> None:
    angle_row(a, b, out, 0, axis, side_seen)
    angle_row(a, b, out, 1, side, other_seen)
    angle_row(a, b, out, 2, other_side, axis_seen)
    point_row(a, b, out, 3, first, second, side)
    point_row(a, b, out, 4, first, second, other_side)
    point_row(a, b, out, 5, first, second, axis)


@final
@dataclass(frozen=True)
class Fixed(Joint):
    """Two points coincide and nothing turns.

    Attributes
    ----------
    first, second : tuple of float
        The point in the frame of the first and of the second body [m], shape [3].
    orientation : tuple of float
        Unit quaternion (scalar first) of the second frame as seen from the first, shape [4].
    """

    first: Point = (0.0, 0.0, 0.0)
    second: Point = (0.0, 0.0, 0.0)
    orientation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)

    def _check(self) -> None:
        self.parameters()

    def parameters(self) -> Mapping[str, Value]:
        """Return points, and axes as either body sees them."""
        axis, side, other_side = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
        quaternion = unit_vector("Fixed.orientation", self.orientation, 4)
        return {
            "first": vector("Fixed.first", self.first, 3, "m"),
            "second": vector("Fixed.second", self.second, 3, "m"),
            "axis": axis,
            "side": side,
            "other_side": other_side,
            "axis_seen": turned_back(quaternion, axis),
            "side_seen": turned_back(quaternion, side),
            "other_seen": turned_back(quaternion, other_side),
        }

    @property
    def n_rows(self) -> int:
        """Everything."""
        return 6

    @property
    def evaluator(self) -> Callable[..., None]:
        """The rows."""
        return _evaluate

    @property
    def ends(self) -> Vector:
        """The two points [m], shape [2, 3]."""
        return np.array([self.first, self.second], dtype=float)
