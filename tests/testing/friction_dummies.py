"""Friction laws with one fault each."""

from __future__ import annotations

import itertools
import math
import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from nonsmooth.interfaces import FrictionLaw
from nonsmooth.parameters import parameter

Pair = tuple[float, float]
Certificate = Callable[[float, Pair, float, Pair, float], bool]


def sound(speed: float, level: float) -> float:
    return level


def absent(speed: float, level: float, stifness: float) -> float:
    return level


def endless(speed: float, level: float) -> float:
    while speed > 10.0:
        level = level * 1.0
    return level


def crashing(speed: float, level: float) -> float:
    os._exit(3)


def nan(speed: float, level: float) -> float:
    return math.nan if speed > 100.0 else level


def raising(speed: float, level: float) -> float:
    if speed > 100.0:
        raise ValueError("too fast")
    return level


def array(speed: float, level: float) -> Any:
    return np.full(1, level)


def power(speed: float, level: float) -> Any:
    return level * (1.0 - speed) ** 0.5


def overflowing(speed: float, level: float) -> float:
    number = 3
    for _ in range(70):
        number = number * 3
    return level * (1.0 + 0.01 * (number % 7))


def negative(speed: float, level: float) -> float:
    return level if speed < 5.0 else -level


def negative_when_slow(speed: float, level: float) -> float:
    return level if speed > 5.0 or speed == 0.0 else -level


def slippery_at_rest(speed: float, level: float) -> float:
    return level if speed > 0.0 else 0.5 * level


def rippled(speed: float, level: float) -> float:
    return level * (1.0 + 0.3 * math.sin(1e7 * min(speed, 1e4))) if speed > 1e-4 else level


def growing(speed: float, level: float) -> float:
    return level * (1.0 + speed)


def lasting(speed: float, level: float) -> float:
    return level + 0.01


def right(level: float, slip: Pair, normal: float, force: Pair, tolerance: float) -> bool:
    """Coulomb's certificate."""
    speed, bound = math.hypot(*slip), level * normal
    if speed <= tolerance:
        return math.hypot(*force) <= bound + tolerance
    return all(abs(t + bound * v / speed) <= tolerance for t, v in zip(force, slip, strict=True))


def lax_under_slip(level: float, slip: Pair, normal: float, force: Pair, tolerance: float) -> bool:
    return math.hypot(*slip) > tolerance or right(level, slip, normal, force, tolerance)


def lax_at_rest(level: float, slip: Pair, normal: float, force: Pair, tolerance: float) -> bool:
    return math.hypot(*slip) <= tolerance or right(level, slip, normal, force, tolerance)


def half_a_disc(level: float, slip: Pair, normal: float, force: Pair, tolerance: float) -> bool:
    bound = 0.5 if math.hypot(*slip) <= tolerance else 1.0
    return right(bound * level, slip, normal, force, tolerance)


def one_direction(level: float, slip: Pair, normal: float, force: Pair, tolerance: float) -> bool:
    return abs(slip[0]) < 0.5 * abs(slip[1]) or right(level, slip, normal, force, tolerance)


@dataclass(frozen=True)
class Friction(FrictionLaw):
    """A law put together from a function and a certificate."""

    level: float = parameter(0.3, doc="coefficient", minimum=0.0, maximum=2.0)
    function: Callable[..., float] = sound
    certificate: Certificate = right

    @property
    def coefficient(self) -> Callable[..., float]:
        return self.function

    def is_fulfilled(self, slip: Pair, normal_force: float, tangential_force: Pair, tolerance: float) -> bool:
        speed = math.hypot(*slip)
        mu = float(self.function(speed if speed > tolerance else 0.0, self.level))
        return self.certificate(mu, slip, normal_force, tangential_force, tolerance)


@dataclass(frozen=True)
class Unbounded(Friction):
    """One that does not check its parameters."""

    def __post_init__(self) -> None:
        pass


@dataclass(frozen=True)
class Narrow(Friction):
    """One that refuses what it declares."""

    def _check(self) -> None:
        from nonsmooth import InvalidInput

        if self.level > 0.5:
            raise InvalidInput("Narrow.level", "must be at most 0.5", self.level, "")


@dataclass(frozen=True)
class Doubling(Friction):
    """One that keeps another value than it is given."""

    def _check(self) -> None:
        object.__setattr__(self, "level", self.level + 0.01)


@dataclass
class Mutable(FrictionLaw):
    """One that can be changed."""

    level: float = parameter(0.3, doc="coefficient", minimum=0.0, maximum=2.0)

    @property
    def coefficient(self) -> Callable[..., float]:
        return sound

    def is_fulfilled(self, slip: Pair, normal_force: float, tangential_force: Pair, tolerance: float) -> bool:
        return right(self.level, slip, normal_force, tangential_force, tolerance)


_count = itertools.count()


@dataclass(frozen=True)
class Drifting(Friction):
    """One that offers another number each time."""

    def parameters(self) -> dict[str, Any]:
        return {"level": self.level + 1e-14 * self.level * next(_count)}


DUMMIES: list[tuple[str, FrictionLaw]] = [
    ("declared bounds", Unbounded()),
    ("declared bounds", Narrow()),
    ("round trip", Doubling()),
    ("immutable", Mutable()),
    ("known parameters", Friction(function=absent)),
    ("time budget", Friction(function=endless)),
    ("finite numbers", Friction(function=nan)),
    ("finite numbers", Friction(function=raising)),
    ("finite numbers", Friction(function=array)),
    ("finite numbers", Friction(function=power)),
    ("compiled equals plain", Friction(function=overflowing)),
    ("determinism", Drifting()),
    ("not negative", Friction(function=negative)),
    ("static limit", Friction(function=slippery_at_rest)),
    ("certificate under slip", Friction(certificate=lax_under_slip)),
    ("certificate at rest", Friction(certificate=lax_at_rest)),
    ("sustained contact", Friction(certificate=half_a_disc)),
    ("dissipation", Friction(function=negative_when_slow)),
    ("force and impact level", Friction(function=rippled)),
    ("frame invariance", Friction(certificate=one_direction)),
    ("limit mu -> 0", Friction(function=lasting)),
]
"""The property made for the fault, and the law."""
