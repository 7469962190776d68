"""Ball joint: a point of one body stays on a point of the other."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import final

import numpy as np

from bodies.joints.rows import point_row
from nonsmooth.interfaces import Joint
from nonsmooth.interfaces.solid import Vector
from nonsmooth.parameters import Value
from nonsmooth.types import Floats
from nonsmooth.vectors import vector

Point = tuple[float, float, float]


def _evaluate(
    a: Floats, b: Floats, out: Floats, first: Floats, second: Floats, x_axis: Floats, y_axis: Floats, z_axis: Floats
) -> None:
    point_row(a, b, out, 0, first, second, x_axis)
    point_row(a, b, out, 1, first, second, y_axis)
    point_row(a, b, out, 2, first, second, z_axis)


@final
@dataclass(frozen=True)
class BallJoint(Joint):
    """Two points coincide; the bodies turn freely about them.

    Attributes
    ----------
    first, second : tuple of float
        The point in the frame of the first and of the second body [m], shape [3].
    """

    first: Point = (0.0, 0.0, 0.0)
    second: Point = (0.0, 0.0, 0.0)

    def _check(self) -> None:
        vector("BallJoint.first", self.first, 3, "m")
        vector("BallJoint.second", self.second, 3, "m")

    def parameters(self) -> Mapping[str, Value]:
        """Return the points, and the axes of the first frame along which they must not part."""
        return {
            "first": vector("BallJoint.first", self.first, 3, "m"),
            "second": vector("BallJoint.second", self.second, 3, "m"),
            "x_axis": (1.0, 0.0, 0.0),
            "y_axis": (0.0, 1.0, 0.0),
            "z_axis": (0.0, 0.0, 1.0),
        }

    @property
    def n_rows(self) -> int:
        """Three translations."""
        return 3

    @property
    def evaluator(self) -> Callable[..., None]:
        """The rows."""
        return _evaluate

    @property
    def ends(self) -> Vector:
        """The two points [m], shape [2, 3]."""
        return np.array([self.first, self.second], dtype=float)
