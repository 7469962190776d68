"""The friction coefficient of a law, which all laws with one have, and what must hold of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from nonsmooth.interfaces import FrictionLaw, StatefulFrictionLaw
from nonsmooth.testing.callers import plain_caller
from nonsmooth.testing.component import numbers_of, remade, variants
from nonsmooth.testing.draws import Case, Variable
from nonsmooth.testing.examine import Trial, examine
from nonsmooth.testing.functions import Function, scalar_function
from nonsmooth.testing.property import NotChecked, Row

SPEED = Variable("slip_speed", 1e-4, 1e2, 1.0, log=True)
HEADING = Variable("heading", -3.1, 3.1)
FORCE = Variable("normal_force", 1e-2, 1e3, 1.0, log=True)
SHARE = Variable("share", 0.0, 0.99)
_SPEEDS = (0.0, 1e-300, *np.geomspace(1e-12, 1e3, 16).tolist())
_ANY_SPEED = Variable("slip_speed", 1e-9, 1e3, 1.0, log=True)
_DRAWS, _MANY = 10, 60


@final
@dataclass(frozen=True)
class _Fresh(FrictionLaw):
    """A law with inner states as it is when a contact has just closed: a law without."""

    law: StatefulFrictionLaw

    def parameters(self) -> dict[str, Any]:
        return {**self.law.parameters(), "state": tuple(self.law.initial_state)}

    @property
    def coefficient(self) -> Callable[..., float]:
        return self.law.coefficient

    def is_fulfilled(
        self, slip: tuple[float, float], normal_force: float, tangential_force: tuple[float, float], tolerance: float
    ) -> bool:
        return self.law.is_fulfilled(slip, normal_force, tangential_force, tolerance)


def fresh(law: FrictionLaw) -> FrictionLaw:
    """Return a law without inner states: itself, or what it is as long as they are the initial ones."""
    return _Fresh(law) if isinstance(law, StatefulFrictionLaw) else law


def offered(law: FrictionLaw) -> Mapping[str, Any]:
    """Return what the coefficient may ask for."""
    return fresh(law).parameters()


def coefficient_function(law: FrictionLaw) -> Function:
    """Return the coefficient with speeds to try."""
    return scalar_function(law, "coefficient", law.coefficient, _SPEEDS, offered(law))


def mu(law: FrictionLaw, speed: float) -> float:
    """Return the coefficient at a speed, of a fresh contact."""
    return float(plain_caller(law.coefficient, "scalar", offered(law))(speed))


def along(size: float, heading: float) -> tuple[float, float]:
    """Return the vector of a size and direction."""
    return size * math.cos(heading), size * math.sin(heading)


def vanishing_names(law: FrictionLaw) -> tuple[str, ...]:
    """Return the parameters with which friction vanishes: pure numbers that may be zero, or next to it."""
    found = numbers_of(law).items()
    return tuple(name for name, (value, rule) in found if rule.unit == "1" and max(rule.minimum, rule.above) == 0.0)


def coefficient_rows(law: FrictionLaw) -> list[Row]:
    """Return the properties of the coefficient alone."""
    return [
        (
            "not negative",
            "the coefficient is never negative",
            lambda: examine("not negative", variants(law), (_ANY_SPEED,), _not_negative, _MANY),
        ),
        (
            "static limit",
            "the coefficient at rest is not below that of incipient slip, to which those of slow slip tend",
            lambda: examine("static limit", variants(law), (), _static_limit, _DRAWS),
        ),
    ]


def limit_row(law: FrictionLaw, names: tuple[str, ...], vanishes: Trial) -> Row:
    """Return the property that nothing is left of friction with the parameters of these names next to zero."""

    def check() -> None:
        if not names:
            raise NotChecked(f"{type(law).__name__}: no parameter is a coefficient that may be zero")
        low = {name: max(0.0, numbers_of(law)[name][1].above + 1e-12) for name in names}
        examine("limit mu -> 0", [remade(law, **low)], (SPEED, HEADING), vanishes, _DRAWS)

    return "limit mu -> 0", f"with {', '.join(names) or 'coefficients'} at zero nothing is left of friction", check


def _not_negative(law: FrictionLaw, case: Case) -> str:
    speed = case["slip_speed"]
    return f"coefficient({speed:g}) is {mu(law, speed):g}" if mu(law, speed) < 0.0 else ""


def _static_limit(law: FrictionLaw, case: Case) -> str:
    rest, slow, slower = mu(law, 0.0), mu(law, 1e-12), mu(law, 1e-300)
    if slower > rest * (1.0 + 1e-12) + 1e-12:
        return f"coefficient(0) is {rest:g}, below {slower:g} of incipient slip"
    if abs(slow - slower) > 1e-6 * (1.0 + abs(slow)):
        return f"coefficient(1e-12) is {slow:g} and coefficient(1e-300) {slower:g}: slow slip has no limit"
    return ""
