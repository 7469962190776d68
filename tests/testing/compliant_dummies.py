"""Compliant normal laws with one fault each, and what no law of that kind could do."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from nonsmooth.interfaces import CompliantNormalLaw
from nonsmooth.parameters import parameter


def sound(indentation: float, rate: float, closing_rate: float, stiffness: float) -> float:
    return stiffness * indentation * max(0.0, 1.0 + 0.1 * rate)


def pulling(indentation: float, rate: float, closing_rate: float, stiffness: float) -> float:
    return stiffness * indentation


def absent(indentation: float, rate: float, closing_rate: float, stifness: float) -> float:
    return stifness * indentation


def endless(indentation: float, rate: float, closing_rate: float, stiffness: float) -> float:
    while indentation > 0.05:
        stiffness = stiffness * 1.0
    return stiffness * indentation


def nan(indentation: float, rate: float, closing_rate: float, stiffness: float) -> float:
    return math.nan if closing_rate == 0.0 else stiffness * indentation


def overflowing(indentation: float, rate: float, closing_rate: float, stiffness: float) -> float:
    number = 3
    for _ in range(70):
        number = number * 3
    return stiffness * indentation * (1.0 + 0.01 * (number % 7))


def preloaded(indentation: float, rate: float, closing_rate: float, stiffness: float) -> float:
    return stiffness * (indentation + 1e-9)


def softening(indentation: float, rate: float, closing_rate: float, stiffness: float) -> float:
    depth = 3.0 / stiffness
    return stiffness * indentation if indentation < depth else 3.0 - 0.1 * stiffness * min(indentation - depth, depth)


def repelling(indentation: float, rate: float, closing_rate: float, stiffness: float) -> float:
    return stiffness * abs(indentation)


def sucking(indentation: float, rate: float, closing_rate: float, stiffness: float) -> float:
    force = stiffness * indentation
    return force if force > 0.5 else -0.1 * force


def turned_round(indentation: float, rate: float, closing_rate: float, stiffness: float) -> float:
    return -stiffness * indentation


def unguarded(indentation: float, rate: float, closing_rate: float, stiffness: float) -> Any:
    return stiffness * indentation**1.5


def driving(indentation: float, rate: float, closing_rate: float, stiffness: float) -> float:
    return stiffness * indentation * max(0.0, 1.0 - 0.1 * rate)


def chattering(indentation: float, rate: float, closing_rate: float, stiffness: float) -> float:
    force = stiffness * indentation
    return force * (1.0 + 2.0 * math.copysign(1.0, rate)) if rate != 0.0 else force


def right(told: float, force: float, tolerance: float) -> bool:
    return abs(told - force) <= tolerance


def lax(told: float, force: float, tolerance: float) -> bool:
    return told <= force + tolerance


def strict(told: float, force: float, tolerance: float) -> bool:
    return abs(told - force) <= tolerance and force < 2.0


@dataclass(frozen=True)
class Compliant(CompliantNormalLaw):
    """A law put together from a function, a reach and a certificate."""

    stiffness: float = parameter(1e4, doc="stiffness", unit="N/m", above=0.0)
    function: Callable[..., float] = sound
    gap: float = 0.0
    certificate: Callable[[float, float, float], bool] = right

    @property
    def force(self) -> Callable[..., float]:
        return self.function

    @property
    def reach(self) -> float:
        return self.gap

    def is_fulfilled(
        self, indentation: float, rate: float, closing_rate: float, force: float, tolerance: float
    ) -> bool:
        own = self.function(indentation, rate, closing_rate, self.stiffness)
        return self.certificate(force, own, tolerance)


DUMMIES: list[tuple[str, CompliantNormalLaw]] = [
    ("known parameters", Compliant(function=absent)),
    ("time budget", Compliant(function=endless)),
    ("finite numbers", Compliant(function=nan)),
    ("finite numbers", Compliant(function=unguarded)),
    ("compiled equals plain", Compliant(function=overflowing)),
    ("reach", Compliant(gap=-1e-6)),
    ("nothing at zero", Compliant(function=preloaded)),
    ("rises", Compliant(function=softening)),
    ("pulls within its reach", Compliant(function=repelling, gap=1e-4)),
    ("pulls within its reach", Compliant(function=sucking)),
    ("pulls within its reach", Compliant(function=turned_round)),
    ("dissipation", Compliant(function=driving)),
    ("certificate", Compliant(certificate=lax)),
    ("certificate", Compliant(certificate=strict)),
    ("impact", Compliant(function=chattering)),
]
"""The property made for the fault, and the law."""
