"""Properties of friction laws."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from nonsmooth.interfaces import AnisotropicFrictionLaw, FrictionLaw, StatefulFrictionLaw
from nonsmooth.problems.contact import solve_contact
from nonsmooth.problems.impact import solve_impact
from nonsmooth.testing.anisotropic import anisotropic_properties
from nonsmooth.testing.coefficient import (
    FORCE,
    HEADING,
    SHARE,
    SPEED,
    along,
    coefficient_function,
    coefficient_rows,
    fresh,
    limit_row,
    mu,
    vanishing_names,
)
from nonsmooth.testing.component import component_rows, variants
from nonsmooth.testing.draws import Case, Variable
from nonsmooth.testing.examine import FEWEST, Trial, examine
from nonsmooth.testing.functions import Function, Functions
from nonsmooth.testing.property import Property, Row, properties
from nonsmooth.testing.reference import Spring, point, problem, problem_space
from nonsmooth.testing.stateful import rates_function, start_row, state_rows

_DRAWS = 10
_SLIGHT = 1e-6
"""Approach in units of the slip speed that leaves the slip as it is."""


def check_friction_law(law: FrictionLaw, *, coefficients: Sequence[str] | None = None) -> list[Property]:
    """Return the properties of a friction law.

    One that is anisotropic has properties of its own.  One with inner states has those of any other while they are the
    initial ones, and some more.

    Parameters
    ----------
    law : FrictionLaw
        The law, with parameters.
    coefficients : sequence of str, optional
        Parameters with which friction vanishes; by default those that are pure numbers and may be zero, or next to it.
    """
    vanishing = vanishing_names(law) if coefficients is None else tuple(coefficients)
    if isinstance(law, AnisotropicFrictionLaw):
        return anisotropic_properties(law, vanishing)
    functions = Functions(lambda: [made for one in variants(law) for made in _functions(one)])

    def row(name: str, says: str, trial: Trial, *space: Variable) -> Row:
        return name, says, lambda: examine(name, variants(law), space, trial, _DRAWS, fewest=FEWEST)

    rows = [
        *coefficient_rows(law),
        row(
            "certificate under slip",
            "a force on the edge of the disc against the slip obeys it, one along the slip or off the edge does not",
            _certificate_slip,
            SPEED,
            HEADING,
            FORCE,
        ),
        row(
            "certificate at rest",
            "a force within the static disc obeys it, one outside does not",
            _certificate_rest,
            HEADING,
            FORCE,
            SHARE,
        ),
        row(
            "sustained contact",
            "forces that the engine finds for contacts that stick, start to slide or slide obey it",
            _sustained,
            SPEED,
            HEADING,
            FORCE,
            Variable("push", 0.0, 3.0),
        ),
        row("dissipation", "friction takes energy out of impacts", _dissipates, *problem_space(2)),
        row(
            "force and impact level",
            "an impact too slight to change the slip has the direction and ratio of impulses that the force has",
            _levels,
            SPEED,
            HEADING,
        ),
        row(
            "frame invariance",
            "turning the tangents changes neither its verdicts nor an impact",
            _turned,
            SPEED,
            HEADING,
            Variable("turn", -3.1, 3.1, 1.0),
        ),
        limit_row(law, vanishing, _vanishes),
    ]
    first = component_rows(law)
    if isinstance(law, StatefulFrictionLaw):
        first.append(start_row(law))
        rows += state_rows(law)
    return properties(law, [*first, *functions.rows(), *functions.guarded(rows)])


def _functions(law: FrictionLaw) -> list[Function]:
    # the rates first, which refuse states that are not in order
    return [*([rates_function(law)] if isinstance(law, StatefulFrictionLaw) else []), coefficient_function(law)]


def _certificate_slip(law: FrictionLaw, case: Case) -> str:
    speed, heading, force = case["slip_speed"], case["heading"], case["normal_force"]
    bound = mu(law, speed) * force
    slip, tolerance = along(speed, heading), 1e-9 * force
    tried = [(-1.0, True)] + [(share, False) for share in (1.0, -0.5, -1.5, 0.0)] * (bound > 1e-6 * force)
    for share, expected in tried:
        t1, t2 = along(share * bound, heading)
        if bool(law.is_fulfilled(slip, force, (t1, t2), tolerance)) is not expected:
            word = "refuses" if expected else "accepts"
            return f"is_fulfilled {word} {share:g} of the bound {bound:g} N along the slip"
    return ""


def _certificate_rest(law: FrictionLaw, case: Case) -> str:
    heading, force = case["heading"], case["normal_force"]
    bound = mu(law, 0.0) * force
    for size, expected in ((case["share"] * bound, True), (1.01 * bound + 1e-3 * force, False)):
        t1, t2 = along(size, heading)
        if bool(law.is_fulfilled((0.0, 0.0), force, (t1, t2), 1e-9 * force)) is not expected:
            word = "refuses" if expected else "accepts"
            return f"is_fulfilled {word} {size:g} N at rest, where {bound:g} N is the bound"
    return ""


def _contact(law: FrictionLaw, force: Sequence[float], slip: Sequence[float]) -> tuple[float, Any]:
    p = point((0.0, 0.0, 0.0))
    result = solve_contact(p.mass, p.normal, p.tangential, force, [fresh(law)], slip=[slip])
    return float(result.normal_force[0]), result.tangential_force[0]


def _sustained(law: FrictionLaw, case: Case) -> str:
    weight = case["normal_force"]
    push = along(case["push"] * weight * (mu(law, 0.0) + 1e-3), case["heading"])
    for slip in ((0.0, 0.0), along(case["slip_speed"], case["heading"])):
        normal, (t1, t2) = _contact(law, [*push, -weight], slip)
        if not law.is_fulfilled(slip, normal, (float(t1), float(t2)), 1e-8 * weight):
            return f"is_fulfilled refuses the force ({t1:g}, {t2:g}) N at slip ({slip[0]:g}, {slip[1]:g}) m/s"
    return ""


def _impact(law: FrictionLaw, velocity: tuple[float, float, float], turn: float = 0.0) -> Any:
    p = point(velocity)
    c, s = math.cos(turn), math.sin(turn)
    tangential = p.tangential @ np.array([[c, -s], [s, c]])
    return solve_impact(p.mass, p.normal, tangential, p.velocity, [Spring()], [fresh(law)])


def _dissipates(law: FrictionLaw, case: Case) -> str:
    p = problem(case, 2)
    if not p.approaches:
        return ""
    result = solve_impact(p.mass, p.normal, p.tangential, p.velocity, [Spring()] * 2, [fresh(law)] * 2)
    least = float(np.min(result.friction_loss))
    return f"friction gives {-least:g} J to the impact" if least < -1e-8 else ""


def _levels(law: FrictionLaw, case: Case) -> str:
    speed, heading = case["slip_speed"], case["heading"]
    slip = along(speed, heading)
    normal, traction = _contact(law, [0.0, 0.0, -1.0], slip)
    result = _impact(law, (*slip, -_SLIGHT * speed))
    pushed, rubbed = float(result.normal_impulse[0]), result.tangential_impulse[0]
    t1, t2 = (float(x) / pushed for x in rubbed)
    if np.max(np.abs(rubbed / pushed - traction / normal)) > 1e-4:
        return f"impulses have the ratio ({t1:g}, {t2:g}), forces ({traction[0] / normal:g}, {traction[1] / normal:g})"
    return "" if law.is_fulfilled(slip, 1.0, (t1, t2), 1e-4) else "is_fulfilled refuses the impulses of an impact"


def _turned(law: FrictionLaw, case: Case) -> str:
    speed, heading, turn = case["slip_speed"], case["heading"], case["turn"]
    bound = mu(law, speed)
    for share in (-1.0, 0.5):
        one, other = (
            bool(law.is_fulfilled(along(speed, angle), 1.0, along(share * bound, angle), 1e-9))
            for angle in (heading, heading + turn)
        )
        if one is not other:
            return f"is_fulfilled says {one}, and {other} after a turn of slip and force by {turn:g} rad"
    velocity = (*along(speed, heading), -1.0)
    a, b = _impact(law, velocity).velocity, _impact(law, velocity, turn).velocity
    return "" if np.allclose(a, b, rtol=0.0, atol=1e-6 * speed) else f"the velocities after are {a} and {b}"


def _vanishes(law: FrictionLaw, case: Case) -> str:
    slip = along(case["slip_speed"], case["heading"])
    rubbed = float(np.hypot(*_impact(law, (*slip, -1.0)).tangential_impulse[0]))
    _, traction = _contact(law, [0.0, 0.0, -1.0], slip)
    left = max(rubbed, float(np.hypot(*traction)))
    return f"{left:g} of the normal force is left" if left > 1e-9 else ""
