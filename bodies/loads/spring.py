"""Spring and damper along the line between two points."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.engine.memory.blocks import LOAD_MOMENT, LOAD_POINT, ROTATION, SPIN, VELOCITY
from nonsmooth.interfaces import Load
from nonsmooth.interfaces.solid import Vector
from nonsmooth.parameters import Value, parameter
from nonsmooth.types import Floats
from nonsmooth.vectors import vector

Point = tuple[float, float, float]


def _evaluate(
    t: float,
    a: Floats,
    b: Floats,
    out: Floats,
    first: Floats,
    second: Floats,
    stiffness: float,
    damping: float,
    length: float,
) -> None:
    square = stretch = 0.0
    for i in range(3):
        r = ROTATION + 3 * i
        j, k = (i + 1) % 3, (i + 2) % 3
        out[i] = a[i] + a[r] * first[0] + a[r + 1] * first[1] + a[r + 2] * first[2]
        out[LOAD_POINT + i] = b[i] + b[r] * second[0] + b[r + 1] * second[1] + b[r + 2] * second[2]
        out[LOAD_MOMENT + i] = 0.0
        square += (out[LOAD_POINT + i] - out[i]) ** 2
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        v_a = a[VELOCITY + i] + a[SPIN + j] * (out[k] - a[k]) - a[SPIN + k] * (out[j] - a[j])
        v_b = b[VELOCITY + i] + b[SPIN + j] * (out[LOAD_POINT + k] - b[k]) - b[SPIN + k] * (out[LOAD_POINT + j] - b[j])
        stretch += (out[LOAD_POINT + i] - out[i]) * (v_b - v_a)
    distance = math.sqrt(square)
    force = stiffness * (distance - length) + damping * stretch / distance
    for i in range(3):
        out[i] = -force * (out[LOAD_POINT + i] - out[i]) / distance


@final
@dataclass(frozen=True)
class Spring(Load):
    """F = -k (d - d0) - c d' along the line between two points at distance d, which must not vanish.

    Attributes
    ----------
    first, second : tuple of float
        Where it is attached, in the frame of the first and of the second body [m], shape [3].
    """

    stiffness: float = parameter(doc="stiffness k", unit="N/m", minimum=0.0)
    length: float = parameter(doc="natural length d0", unit="m", minimum=0.0, usual=(1e-4, 1e3))
    damping: float = parameter(0.0, doc="damping c", unit="N s/m", minimum=0.0)
    first: Point = (0.0, 0.0, 0.0)
    second: Point = (0.0, 0.0, 0.0)

    def _check(self) -> None:
        self.parameters()

    def parameters(self) -> Mapping[str, Value]:
        """Return constants and points."""
        return {
            **self.numbers(),
            "first": vector("Spring.first", self.first, 3, "m"),
            "second": vector("Spring.second", self.second, 3, "m"),
        }

    @property
    def depends_on_time(self) -> bool:
        """No."""
        return False

    @property
    def evaluator(self) -> Callable[..., None]:
        """Force, point and moment."""
        return _evaluate

    @property
    def ends(self) -> Vector:
        """The two points [m], shape [2, 3]."""
        return np.array([self.first, self.second], dtype=float)
