"""Loads with one fault each: a spring and damper between the origins of two frames."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np

from nonsmooth.interfaces import Load
from nonsmooth.types import Floats

FAULTS = {
    "writes its block": 1.0,
    "no jumps": 2.0,
    "frame invariance": 3.0,
    "relative motion": 4.0,
}
"""Faults by the property made for them."""
BEYOND = 20.0


def evaluate(t: float, a: Floats, b: Floats, out: Floats, fault: float) -> None:
    distance = math.sqrt((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2 + (b[2] - a[2]) ** 2)
    rate = 0.0
    for i in range(3):
        rate += (b[i] - a[i]) * (b[12 + i] - a[12 + i]) / distance
    force = -50.0 * (distance - 0.4) - 2.0 * rate
    if fault == 2.0 and rate > 0.0:
        # dry friction, as a function of the rate
        force = force - 0.3
    for i in range(3):
        out[i] = force * (b[i] - a[i]) / distance
        out[3 + i] = b[i]
    if fault == 1.0 and t < 0.5:
        out[7] = 1e-12
    if fault == 3.0:
        out[2] = out[2] - 9.81
    if fault == 4.0:
        for i in range(3):
            out[6 + i] = -0.1 * b[15 + i]
    if fault == 5.0:
        for i in range(3):
            out[i] *= 1.0 + t
    if fault == 20.0:
        out[9] = 0.0


@dataclass(frozen=True)
class Pull(Load):
    """A load with a fault, 0 without."""

    fault: float = 0.0

    def parameters(self) -> Mapping[str, Any]:
        return {"fault": self.fault}

    @property
    def evaluator(self) -> Callable[..., None]:
        return evaluate


@dataclass(frozen=True)
class Weight(Pull):
    """One that says that it pulls along the vertical."""

    departures: ClassVar[Mapping[str, str]] = MappingProxyType({"frame invariance": "a weight pulls downwards"})
    fault: float = FAULTS["frame invariance"]


@dataclass(frozen=True)
class Endless(Pull):
    """One that acts nowhere."""

    @property
    def ends(self) -> Any:
        return np.full((2, 3), math.nan)


@dataclass(frozen=True)
class Timeless(Pull):
    """One that says that it does not depend on time, and does."""

    fault: float = 5.0

    @property
    def depends_on_time(self) -> bool:
        return False


DUMMIES: list[tuple[str, Load]] = [
    *((name, Pull(fault)) for name, fault in FAULTS.items()),
    ("writes its block", Pull(BEYOND)),
    ("ends", Endless()),
    ("time", Timeless()),
]
