"""Forces and impulses beyond their cones are seen, those on the border are not."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import BoxBody, Plate
from laws import (
    Anisotropic,
    Bristle,
    Coulomb,
    CoulombContensou,
    Directional,
    EnergeticImpact,
    Frictionless,
    RateAndState,
    Stribeck,
    Unilateral,
    Viscous,
)
from nonsmooth.interfaces.body import Vector
from tests.benchmarks.random_systems.case import Case, Start
from tests.benchmarks.random_systems.checks import findings
from tests.benchmarks.random_systems.cones import Reported, coefficient, strongest

LAWS: list[tuple[Any, float, float, float]] = [
    (Frictionless(), 0.0, 0.0, 0.0),
    (Coulomb(0.3), 0.3, 0.3, 0.3),
    (Coulomb(0.3, 0.4), 0.4, 0.3, 0.4),
    (Stribeck(0.4, 2.0, 0.2), 0.4, 0.2 + 0.2 / 3.0, 0.4),
    (Viscous(0.3, 0.1, 0.7), 0.3, 0.4, 0.7),
    (Viscous(0.3, 0.0, 0.7), 0.3, 0.3, 0.3),
    (Anisotropic(0.2, 0.5), 0.5, 0.5, 0.5),
    (Directional(0.2, 0.5, 0.3), 0.5, 0.5, 0.5),
    (RateAndState(0.3, 0.01, 0.01, 1e-3, 1e-4), math.inf, math.inf, math.inf),
    (Bristle(0.3, 0.4, stiffness=1e4), math.inf, math.inf, math.inf),
    (CoulombContensou(0.3), math.inf, math.inf, math.inf),
]


@pytest.mark.parametrize(("law", "at_rest", "at_1_m_per_s", "most"), LAWS)
def test_coefficients_of_laws(law: Any, at_rest: float, at_1_m_per_s: float, most: float) -> None:
    assert coefficient(law, 0.0) == pytest.approx(at_rest)
    assert coefficient(law, 1.0) == pytest.approx(at_1_m_per_s)
    assert strongest(law) == pytest.approx(most)


def _outside(normal: float, friction: float, bound: float, may_pull: bool = False, floor: float = 0.0) -> list[bool]:
    """Return whether the first of two forces pulls, and is beyond its cone; the other one is 1 N."""

    def pair(first: float, second: float) -> Vector:
        return np.array([first, second])

    none, marked = np.zeros(2, dtype=np.int64), np.zeros(2, dtype=bool)
    rows = Reported(np.zeros(2), none, pair(normal, 1.0), pair(friction, 0.0), pair(bound, 0.0), np.ones(2), marked)
    pulls, beyond = rows.outside(np.array([may_pull, False]), floor)
    assert pulls[1] <= 0.0
    assert beyond[1] <= 0.0
    return [bool(pulls[0] > 0.0), bool(beyond[0] > 0.0)]


def test_a_force_on_the_border_of_its_cone_is_inside_and_one_beyond_it_is_not() -> None:
    assert _outside(0.5, 0.15, 0.3) == [False, False]
    assert _outside(0.5, 0.15 + 0.9e-6, 0.3) == [False, False]
    assert _outside(0.5, 0.15 + 1.1e-6, 0.3) == [False, True]
    assert _outside(0.5, 0.15 + 1.1e-6, 0.3, floor=1e-6) == [False, False]
    assert _outside(0.0, 1e-3, 0.3) == [False, True]
    assert _outside(-0.9e-6, 0.0, 0.3) == [False, False]
    assert _outside(-1.1e-6, 0.0, 0.3) == [True, False]
    assert _outside(-0.1, 0.0, 0.3, may_pull=True) == [False, False]
    assert _outside(0.0, 9.0, math.inf) == [False, False]


def _sliding(friction: Coulomb) -> Case:
    """Return a box that comes down askew on a plate and slides along it."""
    laws = ns.ContactLaws(Unilateral(), friction, EnergeticImpact(0.2))
    start = Start("place", (("position", (0.0, 0.0, 0.0101)), ("velocity", (2.0, 0.0, -0.1))))
    return Case((Plate(), BoxBody(0.03, 0.03, 0.01)), (None, start), ((0, 1, laws),), (), 9.81, 0.04, 2e-3)


def test_a_run_is_judged_by_the_law_of_the_case() -> None:
    case = _sliding(Coulomb(0.3))
    solution = ns.simulate(case.build(), case.t_end, sample_interval=case.sample_interval)
    assert findings(case, solution) == []

    def kinds(friction: Coulomb) -> set[str]:
        (contact,) = case.contacts
        other = replace(case, contacts=((0, 1, replace(contact[2], friction=friction)),))
        return {text.split(":")[0] for text in findings(other, solution)}

    assert kinds(Coulomb(0.3 * (1.0 + 1e-5))) == set()
    assert kinds(Coulomb(0.3 * (1.0 - 1e-5))) == {"force-cone", "impulse-cone"}
    # what slips has the kinetic coefficient, and an impact at most the static one
    assert kinds(Coulomb(0.2, 0.3)) == {"force-cone"}
