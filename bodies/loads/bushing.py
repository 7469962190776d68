"""Bushing: a spring and damper in all directions between two points."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import final

from nonsmooth.interfaces import Load
from nonsmooth.parameters import Value, parameter
from nonsmooth.types import Floats
from nonsmooth.vectors import vector

Point = tuple[float, float, float]


def _evaluate(
    t: float, a: Floats, b: Floats, out: Floats, first: Floats, second: Floats, stiffness: float, damping: float
) -> None:
    for i in range(3):
        out[3 + i] = b[i] + b[3 + 3 * i] * second[0] + b[4 + 3 * i] * second[1] + b[5 + 3 * i] * second[2]
        out[6 + i] = 0.0
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        x_a = a[3 + 3 * i] * first[0] + a[4 + 3 * i] * first[1] + a[5 + 3 * i] * first[2]
        # both points move as the one where the force acts, so that equal and opposite forces do no work on a rotation
        v_a = a[12 + i] + a[15 + j] * (out[3 + k] - a[k]) - a[15 + k] * (out[3 + j] - a[j])
        v_b = b[12 + i] + b[15 + j] * (out[3 + k] - b[k]) - b[15 + k] * (out[3 + j] - b[j])
        out[i] = -stiffness * (out[3 + i] - a[i] - x_a) - damping * (v_b - v_a)


@final
@dataclass(frozen=True)
class Bushing(Load):
    """F = -k d - c v of the vector d from one point to the other and its rate v as the first body sees it.

    Attributes
    ----------
    first, second : tuple of float
        Where it is attached, in the frame of the first and of the second body [m], shape [3].
    """

    stiffness: float = parameter(doc="stiffness k", unit="N/m", minimum=0.0)
    damping: float = parameter(0.0, doc="damping c", unit="N s/m", minimum=0.0)
    first: Point = (0.0, 0.0, 0.0)
    second: Point = (0.0, 0.0, 0.0)

    def _check(self) -> None:
        self.parameters()

    def parameters(self) -> Mapping[str, Value]:
        """Return constants and points."""
        return {
            **self.numbers(),
            "first": vector("Bushing.first", self.first, 3, "m"),
            "second": vector("Bushing.second", self.second, 3, "m"),
        }

    @property
    def evaluator(self) -> Callable[..., None]:
        """Force, point and moment."""
        return _evaluate
