"""Restitution coefficient of a single contact by an impact law, for time-stepping engines and for users."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.binding.compile import parameter_names
from nonsmooth.checks import is_finite
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import FrictionLaw, ImpactLaw, ImpactMap, ImpactProcess
from nonsmooth.problems.impact import solve_impact


def restitution(law: ImpactLaw, speed: float) -> float:
    """Ratio of separation speed to approach speed in an impact of one contact, without slip and friction.

    Every impact law, also a law in terms of energies or impulses, has this coefficient if no other contact takes part.
    The coefficient does not depend on the mass.

    Parameters
    ----------
    law : ImpactLaw
        The law.
    speed : float
        Approach speed [m/s].

    Raises
    ------
    InvalidInput
        If the speed is not positive and finite, or the law is neither a process nor a map, or gives no such ratio.
    RunFailed
        If a process does not end.
    """
    if not (is_finite(speed) and speed > 0.0):
        raise InvalidInput("restitution: speed", "must be positive and finite", speed, "Give it in [m/s].")
    if isinstance(law, ImpactProcess):
        after = float(solve_impact([[1.0]], [[1.0]], np.zeros((1, 1, 2)), [-speed], [law], [_Smooth()]).velocity[0])
    elif isinstance(law, ImpactMap):
        after = _mapped(law, speed)
    else:
        raise InvalidInput(
            "restitution: law",
            "must be an ImpactProcess or an ImpactMap",
            type(law).__name__,
            "See `nonsmooth list laws`.",
        )
    ratio = after / speed
    if not (math.isfinite(ratio) and ratio >= -_ROUND_OFF):
        raise InvalidInput(
            f"restitution of {type(law).__name__}",
            "must be a number that is not negative",
            ratio,
            "Its impact of one contact without friction leaves it approaching; mend the law.",
        )
    return max(ratio, 0.0)


_ROUND_OFF = 1e-9


def _mapped(law: ImpactMap, speed: float) -> float:
    given = {"friction": 0.0, **law.numbers()}
    own = {name: np.array([float(given[name])]) for name in parameter_names(law.impulses, "map")}
    out = np.zeros(3)
    law.impulses(1, np.eye(3).ravel(), np.array([-speed, 0.0, 0.0]), out, **own)
    return float(out[0]) - speed


def _no_friction(speed: float) -> float:
    return 0.0


@final
@dataclass(frozen=True)
class _Smooth(FrictionLaw):
    """Friction law of a contact without friction."""

    @property
    def coefficient(self) -> Callable[..., float]:
        """Function of the slip speed that returns zero."""
        return _no_friction

    def is_fulfilled(
        self,
        slip: tuple[float, float],
        normal_force: float,
        tangential_force: tuple[float, float],
        tolerance: float,
    ) -> bool:
        """True if the tangential force is zero within the tolerance [N], because there is no friction."""
        return math.hypot(*tangential_force) <= tolerance
