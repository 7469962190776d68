"""Spring and damper along the line between two points."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import final

from nonsmooth.interfaces import Load
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
        j, k = (i + 1) % 3, (i + 2) % 3
        out[i] = a[i] + a[3 + 3 * i] * first[0] + a[4 + 3 * i] * first[1] + a[5 + 3 * i] * first[2]
        out[3 + i] = b[i] + b[3 + 3 * i] * second[0] + b[4 + 3 * i] * second[1] + b[5 + 3 * i] * second[2]
        out[6 + i] = 0.0
        square += (out[3 + i] - out[i]) ** 2
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        v_a = a[12 + i] + a[15 + j] * (out[k] - a[k]) - a[15 + k] * (out[j] - a[j])
        v_b = b[12 + i] + b[15 + j] * (out[3 + k] - b[k]) - b[15 + k] * (out[3 + j] - b[j])
        stretch += (out[3 + i] - out[i]) * (v_b - v_a)
    distance = math.sqrt(square)
    force = stiffness * (distance - length) + damping * stretch / distance
    for i in range(3):
        out[i] = -force * (out[3 + i] - out[i]) / distance


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
    def evaluator(self) -> Callable[..., None]:
        """Force, point and moment."""
        return _evaluate
