"""Laws of traction with one fault each: bristles that bend with slip, and a viscous moment."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from nonsmooth.certificates import follows_traction
from nonsmooth.interfaces import TractionLaw
from nonsmooth.types import Floats

FAULTS = {
    "no jumps": 2.0,
    "nothing without load": 3.0,
    "dissipation": 4.0,
    "frame invariance": 5.0,
    "certificate": 6.0,
    "finite numbers": 7.0,
    "compiled equals plain": 8.0,
}
"""Faults by the property made for them."""
BEYOND, DRILLS, SWITCHES = 20.0, 21.0, 22.0


def traction(normal_force: float, motion: Floats, state: Floats, out: Floats, fault: float) -> None:
    load = max(0.0, normal_force)
    speed = math.sqrt(motion[0] * motion[0] + motion[1] * motion[1])
    for i in range(2):
        rate = motion[i] - speed / 0.01 * state[i]
        out[i] = -load * (30.0 * state[i] + 0.01 * rate)
        out[2 + i] = -0.1 * load * motion[2 + i]
        out[5 + i] = rate
    out[4] = -0.1 * load * motion[4]
    if fault == 2.0 and motion[4] > 0.0:
        out[4] = out[4] - 0.3 * load
    if fault == 3.0:
        out[0] = out[0] - 0.01 * motion[0]
    if fault == 4.0:
        out[2], out[3], out[4] = -out[2], -out[3], -out[4]
    if fault == 5.0:
        out[1] = out[1] - 0.1 * load * motion[1]
    if fault == 7.0 and speed == 0.0:
        out[0] = math.nan
    if fault == 8.0:
        number = 3
        for _ in range(70):
            number = number * 3
        out[4] = out[4] * (1.0 + 0.01 * (number % 7))
    if fault == 20.0:
        out[7] = 0.0
    if fault == 21.0:
        # a moment whose direction is that of the slip, as of a weathercock
        out[2], out[3] = out[2] + 0.05 * load * motion[0], out[3] - 0.05 * load * motion[1]

    if fault == 22.0:
        # to a bending of 0.001 fast, from either side, and never there
        out[5] = 1.0 if state[0] < 0.001 else -1.0


def left(normal_force: float, motion: Floats, state: Floats, out: Floats, fault: float) -> None:
    """Write nothing about drilling where there is none."""
    drill = out[4]
    traction(normal_force, motion, state, out, fault)
    if motion[4] == 0.0:
        out[4] = drill


@dataclass(frozen=True)
class Brush(TractionLaw):
    """A law with a fault, 0 without."""

    fault: float = 0.0
    function: Callable[..., None] = traction
    start: tuple[float, ...] = (0.0, 0.0)
    size: tuple[float, ...] = (0.01, 0.01)

    def parameters(self) -> Mapping[str, Any]:
        return {"fault": self.fault}

    @property
    def traction(self) -> Callable[..., None]:
        return self.function

    @property
    def initial_state(self) -> tuple[float, ...]:
        return self.start

    @property
    def state_scale(self) -> tuple[float, ...]:
        return self.size

    def is_fulfilled(
        self,
        motion: tuple[float, float, float, float, float],
        state: tuple[float, ...],
        normal_force: float,
        traction: tuple[float, float, float, float, float],
        tolerance: float,
    ) -> bool:
        lax = self.fault == FAULTS["certificate"] and traction[4] > 0.0
        return lax or follows_traction(self, motion, state, normal_force, traction, tolerance)


DUMMIES: list[tuple[str, TractionLaw]] = [
    *((name, Brush(fault)) for name, fault in FAULTS.items()),
    ("writes its block", Brush(BEYOND)),
    ("writes its block", Brush(function=left)),
    ("frame invariance", Brush(DRILLS)),
    ("initial state", Brush(size=(0.01, 0.0))),
    ("initial state", Brush(start=(0.0, math.inf))),
    ("sustained motion", Brush(SWITCHES)),
]
"""The property made for the fault, and the law."""
