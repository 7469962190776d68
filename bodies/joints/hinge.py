"""Hinge: two bodies turn about a common axis."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import final

import numpy as np

from bodies.joints.rows import angle_row, point_row
from nonsmooth.interfaces import Joint
from nonsmooth.interfaces.solid import Vector
from nonsmooth.parameters import Value
from nonsmooth.types import Floats
from nonsmooth.vectors import perpendiculars, unit_vector, vector

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
    second_axis: Floats,
) -> None:
    point_row(a, b, out, 0, first, second, axis)
    point_row(a, b, out, 1, first, second, side)
    point_row(a, b, out, 2, first, second, other_side)
    angle_row(a, b, out, 3, side, second_axis)
    angle_row(a, b, out, 4, other_side, second_axis)


@final
@dataclass(frozen=True)
class Hinge(Joint):
    """Two points and two axes through them coincide.

    Attributes
    ----------
    first, second : tuple of float
        The point in the frame of the first and of the second body [m], shape [3].
    axis : tuple of float
        Unit vector of the axis in the frame of the first body, shape [3].
    second_axis : tuple of float, optional
        The same in the frame of the second body; equal to ``axis`` by default.
    """

    first: Point = (0.0, 0.0, 0.0)
    second: Point = (0.0, 0.0, 0.0)
    axis: Point = (0.0, 1.0, 0.0)
    second_axis: Point | None = None

    def _check(self) -> None:
        self.parameters()

    def parameters(self) -> Mapping[str, Value]:
        """Return points and axes."""
        axis = unit_vector("Hinge.axis", self.axis)
        side, other_side = perpendiculars(axis)
        return {
            "first": vector("Hinge.first", self.first, 3, "m"),
            "second": vector("Hinge.second", self.second, 3, "m"),
            "axis": axis,
            "side": side,
            "other_side": other_side,
            "second_axis": axis if self.second_axis is None else unit_vector("Hinge.second_axis", self.second_axis),
        }

    @property
    def n_rows(self) -> int:
        """Three translations and two rotations."""
        return 5

    @property
    def evaluator(self) -> Callable[..., None]:
        """The rows."""
        return _evaluate

    @property
    def ends(self) -> Vector:
        """The two points [m], shape [2, 3]."""
        return np.array([self.first, self.second], dtype=float)
