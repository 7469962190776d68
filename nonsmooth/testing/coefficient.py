"""Conformance checks of the friction coefficient, which all laws with a coefficient share.

The bound of the friction force consists of two half ellipses, one forward and one backward along an axis. Its
semi-axes, relative to the coefficient times the normal force, are the three ratios: forward, backward and across. For
an isotropic law the bound is a disc: all three ratios are 1, and any axis will do.

Each claim states a property in its docstring. It returns or raises a message if the property fails, else "" or None.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from nonsmooth.interfaces import AnisotropicFrictionLaw, FrictionLaw, StatefulFrictionLaw
from nonsmooth.testing.claims import Claim, Claims, wrong_verdict
from nonsmooth.testing.component import numbers_of, remade
from nonsmooth.testing.functions import CheckedFunction, plain_caller, scalar_function
from nonsmooth.testing.inputs import number
from nonsmooth.testing.outcome import NotChecked, Row

Pair = tuple[float, float]
"""Components of a tangential vector along the axis of the friction bound, and across it."""
SPEED = number("slip_speed", 1e-4, 1e2, 1.0, is_log=True)
HEADING = number("heading", -3.1, 3.1)
"""Direction of a slip or a force [rad], from the axis of the friction bound."""
FORCE = number("normal_force", 1e-2, 1e3, 1.0, is_log=True)
SHARE = number("share", 0.0, 0.99)
"""Size of a friction force, relative to the bound in its direction."""
TURN = number("turn", -3.1, 3.1, 1.0)
DRAWS = 10
_ANY_SPEED = number("slip_speed", 1e-9, 1e3, 1.0, is_log=True)
_SPEEDS = (0.0, 1e-300, *np.geomspace(1e-12, 1e3, 16).tolist())
COEFFICIENT = Claims()
"""Claims about every friction law with a coefficient."""


@final
@dataclass(frozen=True)
class _Fresh(FrictionLaw):
    """A law with inner states fixed at their initial values, so that it acts as a law without states."""

    law: StatefulFrictionLaw

    def parameters(self) -> dict[str, Any]:
        return {**self.law.parameters(), "state": tuple(self.law.initial_state)}

    @property
    def coefficient(self) -> Callable[..., float]:
        return self.law.coefficient

    def is_fulfilled(self, slip: Pair, normal_force: float, tangential_force: Pair, tolerance: float) -> bool:
        return self.law.is_fulfilled(slip, normal_force, tangential_force, tolerance)


def fresh(law: FrictionLaw) -> FrictionLaw:
    """Return a law without inner states unchanged, and a law with inner states as one that never changes its states."""
    return _Fresh(law) if isinstance(law, StatefulFrictionLaw) else law


def offered(law: FrictionLaw) -> Mapping[str, Any]:
    """Return the values that the coefficient may take by name: parameters, and inner states at their initial values."""
    return fresh(law).parameters()


def coefficient_function(law: FrictionLaw) -> CheckedFunction:
    """Return the coefficient as a function to check, with slip speeds [m/s] as inputs."""
    return scalar_function(law, "coefficient", _SPEEDS, offered(law))


def mu(law: FrictionLaw, speed: float) -> float:
    """Return the friction coefficient at a slip speed [m/s], with inner states at their initial values."""
    return float(plain_caller(law.coefficient, "scalar", offered(law))(speed))


def along(size: float, heading: float) -> Pair:
    """Return the tangential vector with a length and a heading [rad]."""
    return size * math.cos(heading), size * math.sin(heading)


def times(share: float, vector: Pair) -> Pair:
    """Return a vector multiplied by the number ``share``."""
    return share * vector[0], share * vector[1]


def ratios_of(law: FrictionLaw) -> tuple[float, float, float]:
    """Return the semi-axes of the friction bound forward, backward and across, relative to mu times the normal force.

    They are 1 for an isotropic law.
    """
    return law.ratios if isinstance(law, AnisotropicFrictionLaw) else (1.0, 1.0, 1.0)


def force_under_slip(law: FrictionLaw, slip: Pair) -> Pair:
    """Return the friction force [N] at a slip velocity [m/s] and a normal force of 1 N.

    It is the force on the friction bound that dissipates most.
    """
    forward, backward, across = ratios_of(law)
    first = forward if slip[0] > 0.0 else backward
    counted = first * slip[0], across * slip[1]
    size = math.hypot(*counted)
    factor = -mu(law, size) / size
    return factor * first * counted[0], factor * across * counted[1]


def force_on_bound(law: FrictionLaw, coefficient: float, heading: float) -> Pair:
    """Return the force on the friction bound in a direction ``heading`` [rad], for a normal force of 1 N [N]."""
    forward, backward, across = ratios_of(law)
    c, s = along(1.0, heading)
    # a backward force opposes forward slip
    size = coefficient / math.hypot(c / (forward if c < 0.0 else backward), s / across)
    return size * c, size * s


def vanishing_names(law: FrictionLaw) -> tuple[str, ...]:
    """Return the names of the parameters without which friction is zero: dimensionless, with zero as lower bound."""
    found = numbers_of(law).items()
    return tuple(name for name, (value, rule) in found if rule.unit == "1" and max(rule.minimum, rule.above) == 0.0)


def verdict(law: FrictionLaw, slip: Pair, load: float, force: Pair, expected: bool) -> str:
    """Return a message if the law's verdict on a force [N] is not as expected; "" if it is."""
    return wrong_verdict(law.is_fulfilled(slip, load, force, 1e-9 * load), expected)


@COEFFICIENT.claim(_ANY_SPEED, n_inputs=60)
def _not_negative(law: FrictionLaw, speed: float) -> str:
    """The coefficient is never negative."""
    return f"coefficient({speed:g}) is {mu(law, speed):g}" if mu(law, speed) < 0.0 else ""


@COEFFICIENT.claim()
def _static_limit(law: FrictionLaw) -> str:
    """The coefficient at rest is at least the limit of the coefficient for slip speeds that tend to zero."""
    rest, slow, slower = mu(law, 0.0), mu(law, 1e-12), mu(law, 1e-300)
    if slower > rest * (1.0 + 1e-12) + 1e-12:
        return f"coefficient(0) is {rest:g}, below {slower:g} of incipient slip"
    if abs(slow - slower) > 1e-6 * (1.0 + abs(slow)):
        return f"coefficient(1e-12) is {slow:g} and coefficient(1e-300) {slower:g}: slow slip has no limit"
    return ""


@COEFFICIENT.claim(SPEED, HEADING, FORCE)
def _certificate_under_slip(law: FrictionLaw, speed: float, heading: float, load: float) -> str:
    """Under slip, the law accepts the force on the bound against the slip, and refuses other forces."""
    slip = along(speed, heading)
    force = times(load, force_under_slip(law, slip))
    wrong = (-1.0, 0.5, 1.5, 0.0) if math.hypot(*force) > 1e-6 * load else ()
    for share in (1.0, *wrong):
        if word := verdict(law, slip, load, times(share, force), share == 1.0):
            return f"{word} {share:g} of the force ({force[0]:g}, {force[1]:g}) N of the law"
    return ""


@COEFFICIENT.claim(HEADING, FORCE, SHARE)
def _certificate_at_rest(law: FrictionLaw, heading: float, load: float, share: float) -> str:
    """At rest, the law accepts a friction force within the static bound, and refuses a force above the bound."""
    # the accepted force is the part ``share`` of the bound in the direction ``heading``; the refused one is above it
    bound = times(load, force_on_bound(law, mu(law, 0.0), heading))
    size = math.hypot(*bound)
    outside = along(1.01 * size + 1e-3 * load, heading)
    for force, expected in ((times(share, bound), True), (outside, False)):
        if word := verdict(law, (0.0, 0.0), load, force, expected):
            return f"{word} {math.hypot(*force):g} N at rest, where {size:g} N is the bound"
    return ""


def limit_row(law: FrictionLaw, names: tuple[str, ...], vanishes: Claim) -> Row:
    """Return the property that friction is zero if the parameters ``names`` are zero, tried by ``vanishes``."""

    def check() -> None:
        if not names:
            raise NotChecked(f"{type(law).__name__}: no parameter is a coefficient that may be zero")
        low = {name: max(0.0, numbers_of(law)[name][1].above + 1e-12) for name in names}
        vanishes.examine([remade(law, **low)], DRAWS)

    says = f"With {', '.join(names) or 'coefficients'} at zero nothing is left of friction"
    return Row("limit mu -> 0", says, check)
