"""Motions with one fault each, and shapes and guards."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from nonsmooth.interfaces import ConvexPart, Guard, Look, Motion, Shape
from nonsmooth.interfaces.convex_solid import ConvexSolid
from nonsmooth.types import Floats

FAULTS = {
    "writes its block": 1.0,
    "rotation": 2.0,
    "velocity": 3.0,
    "acceleration": 4.0,
    "no jumps": 5.0,
    "time scale": 6.0,
    "positive time scale": 7.0,
}
"""Faults by the property made for them."""
BEYOND, SKEW, SPIN, SPIN_UP, LATE, STILL = 20.0, 21.0, 22.0, 23.0, 24.0, 25.0


def evaluate(t: float, q: Floats, u: Floats, out: Floats, fault: float) -> None:
    """Swing along x and rock about y."""
    c, s = math.cos(0.3 * math.sin(t)), math.sin(0.3 * math.sin(t))
    out[0], out[12], out[18] = math.sin(t), math.cos(t), -math.sin(t)
    out[3], out[5], out[7], out[9], out[11] = c, s, 1.0, -s, c
    out[16], out[22] = 0.3 * math.cos(t), -0.3 * math.sin(t)
    if fault == 1.0 and t < 1.0:
        out[20] = 1e-12
    if fault == 2.0:
        out[3], out[6], out[9] = -out[3], -out[6], -out[9]
    if fault == 3.0:
        out[12], out[18] = 1.1 * out[12], 1.1 * out[18]
    if fault == 4.0:
        out[18] = -out[18]
    if fault == 5.0 and t > 1.0:
        out[1] = 0.1
    if fault == 5.0 and t <= 1.0:
        out[1] = 0.0
    if fault == 20.0:
        out[24] = 0.0
    if fault == 21.0:
        out[7] = 1.01
    if fault == 22.0:
        out[16], out[22] = -out[16], -out[22]
    if fault == 23.0:
        out[22] = 0.0


@dataclass(frozen=True)
class Swing(Motion):
    """A motion with a fault, 0 without."""

    fault: float = 0.0

    def parameters(self) -> Mapping[str, Any]:
        return {"fault": self.fault}

    @property
    def evaluator(self) -> Callable[..., None]:
        return evaluate

    @property
    def time_scale(self) -> float:
        scales = {FAULTS["time scale"]: 20.0, FAULTS["positive time scale"]: -1.0, STILL: math.inf}
        return scales.get(self.fault, 2.0 * math.pi)


MOTIONS: list[tuple[str, Motion]] = [
    *((name, Swing(fault)) for name, fault in FAULTS.items()),
    ("writes its block", Swing(BEYOND)),
    ("rotation", Swing(SKEW)),
    ("velocity", Swing(SPIN)),
    ("acceleration", Swing(SPIN_UP)),
    ("time scale", Swing(STILL)),
]


@dataclass(frozen=True)
class Blob(Shape):
    """A shape of any length and extent."""

    far: float = 1.0
    holds: float = 2.0

    @property
    def length(self) -> float:
        return self.far

    @property
    def extent(self) -> float:
        return self.holds


@dataclass(frozen=True)
class Ball(Shape):
    """A ball of radius 1, wrong as its points are: as far along a direction as ``farthest`` says."""

    farthest: Callable[[Any], Any]
    highest: float = math.inf

    @property
    def length(self) -> float:
        return 1.0

    @property
    def ceiling(self) -> float:
        return self.highest

    @property
    def solid(self) -> ConvexSolid:
        return ConvexSolid(self.farthest)


@dataclass(frozen=True)
class Parted(Ball):
    """A ball with these parts."""

    parts_: tuple[ConvexPart, ...] = ()

    @property
    def parts(self) -> tuple[ConvexPart, ...]:
        return self.parts_


@dataclass(frozen=True)
class Seen(Blob):
    """A shape that is seen as it says."""

    seen: Any = None

    @property
    def look(self) -> Look:
        return self.seen  # type: ignore[no-any-return]


def _round(n: Any) -> Any:
    return n / np.linalg.norm(n)


def _dented(n: Any) -> Any:
    return (1.0 - 0.3 * float(n[2] > 0.9 * np.linalg.norm(n))) * n / np.linalg.norm(n)


SHAPES: list[tuple[str, Shape]] = [
    ("length", Blob(-1.0)),
    ("length", Blob(math.inf)),
    ("extent", Blob(1.0, 0.5)),
    ("ceiling", Ball(lambda n: n / np.linalg.norm(n), 0.9)),
    ("ceiling", Ball(lambda n: n / np.linalg.norm(n), math.nan)),
    ("look", Seen(seen="a ball")),
    ("look", Seen(seen=Look(np.full((1, 3), math.nan)))),
    ("look", Seen(seen=Look(np.zeros((2, 3)), sheet=True))),
    ("look", Seen(seen=Look(np.zeros((3, 3)), triangles=np.array([[0, 1, 3]])))),
    ("parts", Parted(_round, parts_=(ConvexPart(ball=1.01),))),
    ("solid", Ball(_dented)),
    ("solid", Ball(lambda n: n)),
    ("solid", Ball(lambda n: np.full(3, math.nan))),
    ("solid", Ball(lambda n: 2.0 * n / np.linalg.norm(n))),
]


def value(t: float, q: Floats, u: Floats, step: float) -> float:
    height = q[2] + 0.1 * u[2] - 0.1 * t
    return height + step if height > 0.0 else height


@dataclass(frozen=True)
class Threshold(Guard):
    """A guard that jumps where it should end, by ``step``."""

    step: float = 0.0

    def parameters(self) -> Mapping[str, Any]:
        return {"step": self.step}

    @property
    def value(self) -> Callable[..., float]:
        return value

    @property
    def ends_run(self) -> bool:
        return True


GUARDS: list[tuple[str, Guard]] = [("no jumps", Threshold(0.2))]
