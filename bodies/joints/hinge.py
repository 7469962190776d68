"""Hinge: two bodies turn about a common axis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

from nonsmooth.vectors import direction, perpendiculars

from .rows import JointRow, Point, RowsJoint, on_planes, right_angle


@final
@dataclass(frozen=True)
class Hinge(RowsJoint):
    """Two points and two axes through them coincide.

    Attributes
    ----------
    first, second : tuple of float
        The point in the frame of the first and of the second body [m], shape [3].
    axis : tuple of float
        Unit vector of the axis in the frame of the first body, shape [3].
    second_axis : tuple of float, optional
        Unit vector of the axis in the frame of the second body, shape [3]; by default equal to ``axis``.
    """

    axis: Point = (0.0, 1.0, 0.0)
    second_axis: Point | None = None

    @property
    def rows(self) -> Sequence[JointRow]:
        """Three translations and two rotations."""
        axis = direction("Hinge.axis", self.axis)
        sides = perpendiculars(axis)
        other = axis if self.second_axis is None else direction("Hinge.second_axis", self.second_axis)
        turns = (right_angle(side, other) for side in sides)
        return *on_planes(self.first, self.second, (axis, *sides)), *turns
