"""Conformance checks of friction laws: sustained contact, impacts, and the limit without friction.

Each claim states a property in its docstring. It returns or raises a message if the property fails, else "" or None.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from typing import Any

import numpy as np

from nonsmooth.interfaces import AnisotropicFrictionLaw, FrictionLaw, StatefulFrictionLaw
from nonsmooth.problems.contact import solve_contact
from nonsmooth.problems.impact import solve_impact
from nonsmooth.testing.anisotropic import anisotropic_rows
from nonsmooth.testing.claims import FEWEST, Claims, claim, rows
from nonsmooth.testing.coefficient import (
    COEFFICIENT,
    DRAWS,
    FORCE,
    HEADING,
    SPEED,
    TURN,
    along,
    coefficient_function,
    fresh,
    limit_row,
    mu,
    vanishing_names,
)
from nonsmooth.testing.component import variants
from nonsmooth.testing.functions import all_rows
from nonsmooth.testing.inputs import number
from nonsmooth.testing.outcome import Row
from nonsmooth.testing.property import Property, properties
from nonsmooth.testing.reference import ImpactProblem, ReferenceImpact, point, problem_of
from nonsmooth.testing.stateful import STATES, initial_state, rates_function

_PUSH = number("push", 0.0, 3.0)
_SLIGHT = 1e-6
"""Approach speed of a slight impact, relative to the slip speed: so small that the slip hardly changes."""
_FRICTION = Claims(fewest=FEWEST)


def check_friction_law(law: FrictionLaw, *, coefficients: Sequence[str] | None = None) -> list[Property]:
    """Return the properties that a friction law must have, each with its check of this law.

    An anisotropic law must have other properties than an isotropic one. A law with inner states must have the
    properties of an isotropic law at its initial states, and further properties that concern the states.

    Parameters
    ----------
    law : FrictionLaw
        The law, with parameters.
    coefficients : sequence of str, optional
        Names of parameters with which friction vanishes; by default all dimensionless ones with zero as lower bound.
    """
    return properties(law, _rows, coefficients=coefficients)


def _rows(law: FrictionLaw, coefficients: Sequence[str] | None) -> list[Row]:
    vanishing = vanishing_names(law) if coefficients is None else tuple(coefficients)
    if isinstance(law, AnisotropicFrictionLaw):
        return anisotropic_rows(law, vanishing)
    table = functools.partial(rows, components=lambda: variants(law), count=DRAWS)
    found = [*table([*COEFFICIENT, *_FRICTION]), limit_row(law, vanishing, _vanishes)]
    if not isinstance(law, StatefulFrictionLaw):
        return all_rows(law, lambda: [coefficient_function(one) for one in variants(law)], found)
    # `rates_function` comes first: it raises an error if the initial states are invalid. So the coefficient is not
    # called with invalid states
    functions = rates_function, coefficient_function
    return all_rows(
        law,
        lambda: [function(one) for one in variants(law) for function in functions],
        [*found, *table(STATES)],
        table([initial_state]),
    )


def _contact(law: FrictionLaw, force: Sequence[float], slip: Sequence[float]) -> tuple[float, Any]:
    p = point((0.0, 0.0, 0.0))
    result = solve_contact(p.mass, p.normal, p.tangential, force, [fresh(law)], slip=[slip])
    return float(result.normal_force[0]), result.tangential_force[0]


def _impact(law: FrictionLaw, p: ImpactProblem) -> Any:
    laws = [ReferenceImpact()] * p.n, [fresh(law)] * p.n
    return solve_impact(p.mass, p.normal, p.tangential, p.velocity, *laws)


@_FRICTION.claim(SPEED, HEADING, FORCE, _PUSH)
def _sustained_contact(law: FrictionLaw, speed: float, heading: float, weight: float, push: float) -> str:
    """The law accepts the friction forces that the engine finds for contacts that stick, begin to slide or slide."""
    pushed = along(push * weight * (mu(law, 0.0) + 1e-3), heading)
    for slip in ((0.0, 0.0), along(speed, heading)):
        normal, (t1, t2) = _contact(law, [*pushed, -weight], slip)
        if not law.is_fulfilled(slip, normal, (float(t1), float(t2)), 1e-8 * weight):
            return f"is_fulfilled refuses the force ({t1:g}, {t2:g}) N at slip ({slip[0]:g}, {slip[1]:g}) m/s"
    return ""


@_FRICTION.claim(problem_of(2))
def _dissipation(law: FrictionLaw, p: ImpactProblem) -> str:
    """Friction adds no energy in an impact."""
    if not np.any(p.normal.T @ p.velocity < 0.0):
        return ""
    least = float(np.min(_impact(law, p).friction_loss))
    return f"friction gives {-least:g} J to the impact" if least < -1e-8 else ""


@_FRICTION.claim(SPEED, HEADING)
def _force_and_impact_level(law: FrictionLaw, speed: float, heading: float) -> str:
    """In a slight impact, which hardly changes the slip, the ratio of friction to normal impulse is that of sliding."""
    slip = along(speed, heading)
    normal, traction = _contact(law, [0.0, 0.0, -1.0], slip)
    # friction changes the slip by about the coefficient times the approach speed. So the approach speed is lower for a
    # large coefficient, and the slip hardly changes
    size = max(1.0, mu(law, speed))
    result = _impact(law, point((*slip, -_SLIGHT / size * speed)))
    t1, t2 = (float(x) / float(result.normal_impulse[0]) for x in result.tangential_impulse[0])
    force = traction / normal
    if np.max(np.abs(np.array([t1, t2]) - force)) > 1e-4 * size:
        return f"impulses have the ratio ({t1:g}, {t2:g}), forces ({force[0]:g}, {force[1]:g})"
    return (
        "" if law.is_fulfilled(slip, 1.0, (t1, t2), 1e-4 * size) else "is_fulfilled refuses the impulses of an impact"
    )


@_FRICTION.claim(SPEED, HEADING, TURN)
def _frame_invariance(law: FrictionLaw, speed: float, heading: float, turn: float) -> str:
    """If the tangents are turned, the law accepts the same forces, and velocities after an impact are the same."""
    bound = mu(law, speed)
    for share in (-1.0, 0.5):
        one, other = (
            bool(law.is_fulfilled(along(speed, angle), 1.0, along(share * bound, angle), 1e-9))
            for angle in (heading, heading + turn)
        )
        if one is not other:
            return f"is_fulfilled says {one}, and {other} after a turn of slip and force by {turn:g} rad"
    p = point((*along(speed, heading), -1.0))
    a, b = _impact(law, p).velocity, _impact(law, p.turned(turn)).velocity
    return "" if np.allclose(a, b, rtol=0.0, atol=1e-6 * speed) else f"the velocities after are {a} and {b}"


@claim(SPEED, HEADING)
def _vanishes(law: FrictionLaw, speed: float, heading: float) -> str:
    """If the coefficients are zero, friction is zero in an impact and in sliding."""
    slip = along(speed, heading)
    impulse = _impact(law, point((*slip, -1.0))).tangential_impulse[0]
    _, force = _contact(law, [0.0, 0.0, -1.0], slip)
    left = max(float(np.hypot(*impulse)), float(np.hypot(*force)))
    return f"{left:g} of the normal force is left" if left > 1e-9 else ""
