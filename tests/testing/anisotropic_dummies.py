"""Anisotropic friction laws with one fault each."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from nonsmooth.certificates import lies_in_half_ellipses
from nonsmooth.interfaces import AnisotropicFrictionLaw
from nonsmooth.parameters import parameter
from tests.testing import friction_dummies
from tests.testing.friction_dummies import Pair, sound

Ratios = tuple[float, float, float]
Verdict = Callable[[Any, Pair, float, Pair, float], bool]


def negative_between(speed: float, level: float) -> float:
    return -level if 22.0 < speed < 45.0 else level


def lax_under_slip(law: Any, slip: Pair, normal: float, force: Pair, tolerance: float) -> bool:
    return math.hypot(*slip) > tolerance or lies_in_half_ellipses(law, slip, normal, force, tolerance)


def lax_at_rest(law: Any, slip: Pair, normal: float, force: Pair, tolerance: float) -> bool:
    return math.hypot(*slip) <= tolerance or lies_in_half_ellipses(law, slip, normal, force, tolerance)


def a_line_of_forces(law: Any, slip: Pair, normal: float, force: Pair, tolerance: float) -> bool:
    """Accept what the law has, and what opposes the slip or takes out nothing, on the bound."""
    if lies_in_half_ellipses(law, slip, normal, force, tolerance):
        return True
    power = force[0] * slip[0] + force[1] * slip[1]
    return (
        math.hypot(*slip) > tolerance and abs(power) <= 0.3 * math.hypot(*slip) * normal and math.hypot(*force) > 0.05
    )


def of_a_smaller_bound(law: Any, slip: Pair, normal: float, force: Pair, tolerance: float) -> bool:
    rests = math.hypot(*slip) <= tolerance
    return lies_in_half_ellipses(law, slip, 0.5 * normal if rests else normal, force, tolerance)


_count = itertools.count()


@dataclass(frozen=True)
class Skewed(AnisotropicFrictionLaw):
    """A law put together from a coefficient, ratios, an axis and a certificate."""

    level: float = parameter(0.3, doc="largest coefficient", minimum=0.0, maximum=2.0)
    function: Callable[..., float] = sound
    parts: Any = (1.0, 0.4, 0.7)
    direction: Any = (0.0, 0.6, 0.8)
    side: Any = "second"
    verdict: Verdict = lies_in_half_ellipses

    @property
    def coefficient(self) -> Callable[..., float]:
        return self.function

    @property
    def ratios(self) -> Ratios:
        return tuple(self.parts)

    @property
    def axis(self) -> tuple[float, float, float]:
        return tuple(self.direction)

    @property
    def body(self) -> Any:
        return self.side

    def is_fulfilled(self, slip: Pair, normal_force: float, tangential_force: Pair, tolerance: float) -> bool:
        return self.verdict(self, slip, normal_force, tangential_force, tolerance)


@dataclass(frozen=True)
class Wandering(Skewed):
    """One whose axis is another each time it is asked for."""

    @property
    def axis(self) -> tuple[float, float, float]:
        angle = 0.3 * next(_count)
        return math.cos(angle), math.sin(angle), 0.0


DUMMIES: list[tuple[str, AnisotropicFrictionLaw]] = [
    ("finite numbers", Skewed(function=friction_dummies.nan)),
    ("ratios", Skewed(parts=(0.5, 0.4, 0.8))),
    ("ratios", Skewed(parts=(1.0, -0.4, 0.8))),
    ("axis and body", Skewed(side="both")),
    ("axis and body", Skewed(direction=(0.0, 0.0, 0.0))),
    ("not negative", Skewed(function=friction_dummies.negative)),
    ("static limit", Skewed(function=friction_dummies.slippery_at_rest)),
    ("certificate under slip", Skewed(verdict=lax_under_slip)),
    ("certificate at rest", Skewed(verdict=lax_at_rest)),
    ("maximum dissipation", Skewed(verdict=a_line_of_forces)),
    ("sustained contact", Skewed(verdict=of_a_smaller_bound)),
    ("dissipation", Skewed(function=negative_between)),
    ("force and impact level", Skewed(function=friction_dummies.rippled)),
    ("frame invariance", Wandering()),
    ("limit mu -> 0", Skewed(function=friction_dummies.lasting)),
]
"""The property made for the fault, and the law."""
