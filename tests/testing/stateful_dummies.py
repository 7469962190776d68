"""Friction laws with inner states, with one fault each."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from nonsmooth.certificates import opposes_slip
from nonsmooth.interfaces import StatefulFrictionLaw
from nonsmooth.parameters import parameter
from nonsmooth.types import Floats
from tests.testing.friction_dummies import Pair


def coefficient(speed: float, state: Floats, level: float) -> float:
    return level * (1.0 + 0.5 * state[0])


def rates(speed: float, state: Floats, out: Floats) -> None:
    """Let warmth come with slip and go with time."""
    out[0] = 100.0 * (speed / (1.0 + speed) - state[0])


def stateless(speed: float, level: float) -> float:
    return level


def nan_rates(speed: float, state: Floats, out: Floats) -> None:
    out[0] = math.nan if speed > 10.0 else -state[0]


def forgetful(speed: float, state: Floats, out: Floats) -> None:
    if speed > 1e-3:
        out[0] = speed - state[0]


def adding(speed: float, state: Floats, out: Floats) -> None:
    out[0] = out[0] + 100.0 * (speed / (1.0 + speed) - state[0])


def beyond(speed: float, state: Floats, out: Floats) -> None:
    out[0], out[1] = -state[0], 0.0


def clamping(speed: float, state: Floats, out: Floats) -> None:
    state[0] = max(state[0], 0.001)
    out[0] = 100.0 * (speed / (1.0 + speed) - state[0])


def switching(speed: float, state: Floats, out: Floats) -> None:
    """Go to a value fast, from either side, and never come to it."""
    out[0] = -100.0 if state[0] > 0.05 else 100.0


def cooling(speed: float, state: Floats, out: Floats) -> None:
    out[0] = -1.0 - state[0] * speed


def wrapping(speed: float, state: Floats, out: Floats) -> None:
    """Count with an integer that stays below 2^64 in compiled code only."""
    number, part = 3, 0.5
    for _ in range(62):
        number = number * 3
    while number < 2.0**64 and part > 0.0:
        part = 3.7 * part * (1.0 - part)
    out[0] = -state[0] * (part + 0.5)


@dataclass(frozen=True)
class Warm(StatefulFrictionLaw):
    """A law put together from a coefficient, rates, and where they start."""

    level: float = parameter(0.3, doc="coefficient when cold", minimum=0.0, maximum=2.0)
    function: Callable[..., float] = coefficient
    change: Callable[..., None] = rates
    start: tuple[float, ...] = (0.0,)
    size: tuple[float, ...] = (1.0,)
    remembers: bool = True

    @property
    def coefficient(self) -> Callable[..., float]:
        return self.function

    @property
    def rates(self) -> Callable[..., None]:
        return self.change

    @property
    def initial_state(self) -> tuple[float, ...]:
        return self.start

    @property
    def state_scale(self) -> tuple[float, ...]:
        return self.size

    def is_fulfilled(
        self,
        slip: Pair,
        normal_force: float,
        tangential_force: Pair,
        tolerance: float,
        state: tuple[float, ...] | None = None,
    ) -> bool:
        known = state if self.remembers else self.start
        return opposes_slip(self, slip, normal_force, tangential_force, tolerance, known)


DUMMIES: list[tuple[str, StatefulFrictionLaw]] = [
    ("finite numbers", Warm(change=nan_rates)),
    ("writes its block", Warm(change=beyond)),
    ("initial state", Warm(function=stateless)),
    ("initial state", Warm(size=(-1.0,))),
    ("writes its block", Warm(change=adding)),
    ("writes its block", Warm(change=clamping)),
    ("states that are reached", Warm(change=cooling)),
    ("sustained motion", Warm(change=switching)),
    ("certificate with states", Warm(remembers=False)),
]
"""The property made for the fault, and the law; faults that any friction law can have are among those of friction."""
