"""Joints with one fault each: a ball joint between two points."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from bodies import BallJoint
from bodies.joints.rows import distance_row
from bodies.vectors import vector_at
from nonsmooth.compiled import compiled
from nonsmooth.interfaces import Joint
from nonsmooth.types import Floats

_SOUND = BallJoint((0.1, 0.2, -0.1), (-0.2, 0.0, 0.1))
_sound: Any = compiled(_SOUND.evaluator)
FAULTS = {
    "writes its block": 1.0,
    "rate": 2.0,
    "bias": 3.0,
    "frame invariance": 4.0,
    "can be closed": 5.0,
    "independent rows": 6.0,
    "number of rows": 7.0,
}
"""Faults by the property made for them."""
BEYOND, NOTHING = 20.0, 21.0


def evaluate(a: Floats, b: Floats, out: Floats, fault: float, n_rows: float, rows: Floats, repeated: Floats) -> None:
    if fault == 5.0:
        # a rod of negative length
        distance_row(a, b, out, vector_at(rows, 1), vector_at(rows, 4), -1.0)
        return
    before = out[4]
    if fault == 6.0:
        _sound(a, b, out, n_rows, repeated)
    else:
        _sound(a, b, out, n_rows, rows)
    if fault == 1.0:
        out[4] = 1e-12 if out[0] > 0.0 else before
    if fault == 2.0:
        out[0] = 1.1 * out[0]
    if fault == 3.0:
        out[27] = out[27] + 0.1
    if fault == 4.0:
        # along the x axis of the world
        out[0], out[13] = b[0] - a[0], b[18] - a[18]
        out[1], out[2], out[3] = 1.0, 0.0, 0.0
        for i in range(3):
            out[7 + i], out[10 + i] = a[i], b[i]
    if fault == 20.0:
        out[42] = 0.0
    if fault == 21.0:
        for i in range(14):
            out[28 + i] = 0.0


@dataclass(frozen=True)
class Point(Joint):
    """A joint with a fault in its rows, 0 without."""

    fault: float = 0.0

    def parameters(self) -> Mapping[str, Any]:
        sound = _SOUND.parameters()
        rows: Any = sound["rows"]
        # two rows, and the first one again
        third = len(rows) // 3
        return {"fault": self.fault, **sound, "repeated": (*rows[: 2 * third], *rows[:third])}

    @property
    def n_rows(self) -> int:
        return {FAULTS["number of rows"]: 7, FAULTS["can be closed"]: 1}.get(self.fault, 3)

    @property
    def evaluator(self) -> Callable[..., None]:
        return evaluate


@dataclass(frozen=True)
class Endless(Point):
    """One that holds at a single point."""

    @property
    def ends(self) -> Any:
        return np.zeros(3)


DUMMIES: list[tuple[str, Joint]] = [
    *((name, Point(fault)) for name, fault in FAULTS.items()),
    ("writes its block", Point(BEYOND)),
    ("independent rows", Point(NOTHING)),
    ("ends", Endless()),
]
