"""Distance joint: a massless rod between two points."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import final

import numpy as np

from bodies.joints.rows import distance_row
from nonsmooth.interfaces import Joint
from nonsmooth.interfaces.solid import Vector
from nonsmooth.parameters import Value, parameter
from nonsmooth.types import Floats
from nonsmooth.vectors import vector

Point = tuple[float, float, float]


def _evaluate(a: Floats, b: Floats, out: Floats, first: Floats, second: Floats, length: float) -> None:
    distance_row(a, b, out, first, second, length)


@final
@dataclass(frozen=True)
class Distance(Joint):
    """Two points keep their distance.

    Attributes
    ----------
    first, second : tuple of float
        The point in the frame of the first and of the second body [m], shape [3].
    """

    first: Point = (0.0, 0.0, 0.0)
    second: Point = (0.0, 0.0, 0.0)
    length: float = parameter(1.0, doc="distance of the points", unit="m", above=0.0, usual=(1e-4, 1e3))

    def _check(self) -> None:
        self.parameters()

    def parameters(self) -> Mapping[str, Value]:
        """Return points and length."""
        return {
            **self.numbers(),
            "first": vector("Distance.first", self.first, 3, "m"),
            "second": vector("Distance.second", self.second, 3, "m"),
        }

    @property
    def n_rows(self) -> int:
        """One translation."""
        return 1

    @property
    def evaluator(self) -> Callable[..., None]:
        """The rows."""
        return _evaluate

    @property
    def ends(self) -> Vector:
        """The two points [m], shape [2, 3]."""
        return np.array([self.first, self.second], dtype=float)
