"""Slider: one body moves along an axis of the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

from nonsmooth.vectors import direction, perpendiculars, unit_vector

from ..values import turned_back
from .rows import JointRow, Point, RowsJoint, on_planes, parallel_axes


@final
@dataclass(frozen=True)
class Slider(RowsJoint):
    """A point of the second body stays on an axis of the first, and nothing turns.

    Attributes
    ----------
    first, second : tuple of float
        A point of the axis in the frame of the first body, and the point on it in the frame of the second body [m],
        shape [3].
    axis : tuple of float
        Unit vector of the axis in the frame of the first body, shape [3].
    orientation : tuple of float
        Unit quaternion (scalar first) of the second frame as seen from the first, shape [4].
    """

    axis: Point = (1.0, 0.0, 0.0)
    orientation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)

    @property
    def rows(self) -> Sequence[JointRow]:
        """Rows that prevent all rotations and the two translations across the axis."""
        axis = direction("Slider.axis", self.axis)
        sides = perpendiculars(axis)
        quaternion = unit_vector("Slider.orientation", self.orientation, 4)
        axes = (axis, *sides)
        turns = parallel_axes(axes, [turned_back(quaternion, one) for one in axes])
        return *turns, *on_planes(self.first, self.second, sides)
