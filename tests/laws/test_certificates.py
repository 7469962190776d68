"""Certificates tell from the outside whether a law is obeyed, in any axes and in any state."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from laws import (
    Bristle,
    Coulomb,
    MoreauImpact,
    NewtonImpact,
    PlasticImpact,
    PoissonImpact,
    RateAndState,
    Stribeck,
    StrongeImpact,
    Viscous,
)
from nonsmooth.interfaces import FrictionLaw, ImpactMap
from nonsmooth.parameters import UnusualValue
from tests.laws.impact_problems import LAWS, apply, draw

MAPS = {name: law for name, law in LAWS.items() if isinstance(law, ImpactMap)}
SEEDS = st.integers(0, 10**6)
SLIDING: list[FrictionLaw] = [
    Coulomb(0.3),
    Stribeck(0.3, 2.0, 0.1),
    Viscous(0.2, 0.1),
    RateAndState(0.3, 0.01, 0.015, 1e-3, 1e-4),
]


def _drawn(seed: int, n: int) -> tuple[Any, Any, Any]:
    """Return a Delassus matrix, rates before and coefficients."""
    problem = draw(seed, n)
    columns = problem.columns
    return columns.T @ np.linalg.solve(problem.mass, columns), problem.rates.ravel(), problem.friction


@pytest.mark.parametrize("name", MAPS)
@settings(max_examples=15)
@given(seed=SEEDS, n=st.integers(1, 3))
def test_the_impulses_of_a_map_obey_it_and_others_do_not(name: str, seed: int, n: int) -> None:
    law = MAPS[name]
    delassus, before, friction = _drawn(seed, n)
    impulses = apply([law] * n, delassus, before, friction).ravel()
    assert law.is_fulfilled(delassus, before, impulses, friction, 1e-8)
    across = impulses * np.tile([0.0, 1.0, 1.0], n)
    for wrong in (1.01 * impulses, 0.99 * impulses, impulses - 0.1 * across, impulses + 0.1 * across, 0.0 * impulses):
        assert not law.is_fulfilled(delassus, before, wrong, friction, 1e-5)
    assert not law.is_fulfilled(delassus, before, np.full(3 * n, math.nan), friction, 1e-5)


@pytest.mark.parametrize("name", MAPS)
@settings(max_examples=15)
@given(seed=SEEDS)
def test_the_impulses_of_one_map_do_not_obey_another(name: str, seed: int) -> None:
    """Of a coefficient that is another one, and of another rule."""
    law = MAPS[name]
    delassus, before, friction = _drawn(seed, 2)
    impulses = apply([law] * 2, delassus, before, friction).ravel()
    others: list[ImpactMap] = [NewtonImpact(0.3), PoissonImpact(0.3), MoreauImpact(0.3, 0.9)]
    if name != "plastic":
        others.append(PlasticImpact())
    for other in others:
        theirs = apply([other] * 2, delassus, before, friction).ravel()
        apart = float(np.max(np.abs(delassus @ (theirs - impulses))))
        assert apart < 1e-3 or not other.is_fulfilled(delassus, before, impulses, friction, 1e-6)


@pytest.mark.parametrize(("e", "mu"), [(0.0, 0.0), (0.4, 0.1), (1.0, 0.3)])
def test_maps_of_a_ball_by_hand(e: float, mu: float) -> None:
    """A point of unit mass that slides to the end: P_N = (1 + e) v_N, P_T = -mu P_N against the slip."""
    delassus, before = np.eye(3), np.array([-2.0, 3.0, 4.0])
    push = (1.0 + e) * 2.0
    impulses = push * np.array([1.0, -0.6 * mu, -0.8 * mu])
    friction = np.array([mu])
    for law in (NewtonImpact(e), PoissonImpact(e), MoreauImpact(e), StrongeImpact(e)):
        assert law.is_fulfilled(delassus, before, impulses, friction, 1e-9)
        assert not law.is_fulfilled(delassus, before, impulses * [1.001, 1.0, 1.0], friction, 1e-4)
        assert not law.is_fulfilled(delassus, before, impulses + np.array([0.0, 0.001, 0.0]), friction, 1e-4)


@pytest.mark.parametrize("law", [NewtonImpact(0.5), MoreauImpact(0.5, 0.5)], ids=lambda law: type(law).__name__)
def test_a_body_on_a_rail_rebounds_as_the_law_says(law: ImpactMap) -> None:
    """It moves along the normal alone: P_N = (1 + e) v_N, and a larger impulse or a smaller one does not obey."""
    delassus, before, friction = np.diag([1.0, 0.0, 0.0]), np.array([-2.0, 0.0, 0.0]), np.array([0.3])
    for push, expected in ((3.0, True), (3.3, False), (2.7, False)):
        assert law.is_fulfilled(delassus, before, np.array([push, 0.0, 0.0]), friction, 1e-6) is expected


def test_a_gain_that_the_law_makes_obeys_it() -> None:
    """Kane's example: a rod that slides on its lower end gains energy by Newton's rule and Coulomb's friction."""
    angle, mu = math.radians(20.0), np.array([0.7])
    arm = 0.5 * np.array([math.cos(angle), math.sin(angle)])
    columns = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    columns[2] = [-arm[0], arm[1], 0.0]
    mass = np.diag([1.0, 1.0, 1.0 / 12.0])
    # the third column is out of the plane: nothing couples it
    delassus = columns.T @ np.linalg.solve(mass, columns)
    delassus[2, 2] = 1.0
    law = NewtonImpact(1.0)
    for slip in np.linspace(-2.0, 2.0, 41):
        before = np.array([-1.0, slip, 0.0])
        impulses = apply([law], delassus, before, mu).ravel()
        assert law.is_fulfilled(delassus, before, impulses, mu, 1e-8)
        if impulses @ (2.0 * before + delassus @ impulses) / 2.0 > 1e-3:
            return
    pytest.fail("no slip gains energy")


@pytest.mark.parametrize("law", SLIDING, ids=lambda law: type(law).__name__)
@given(heading=st.floats(-3.1, 3.1), off=st.floats(-3.1, 3.1))
def test_the_verdict_does_not_depend_on_the_axes(law: FrictionLaw, heading: float, off: float) -> None:
    """A force that misses the one of the law by 0.9 and by 1.1 of the tolerance, whatever the directions."""
    slip = (math.cos(heading), math.sin(heading))
    load, tolerance = 2.0, 1e-3
    mu = law.coefficient(1.0, **_offered(law))
    for size, expected in ((0.9, True), (1.1, False)):
        force = tuple(
            -mu * load * v + size * tolerance * w for v, w in zip(slip, (math.cos(off), math.sin(off)), strict=True)
        )
        assert law.is_fulfilled(slip, load, (force[0], force[1]), tolerance) is expected


def _offered(law: FrictionLaw) -> dict[str, Any]:
    return {**law.parameters(), **({"state": law.initial_state} if isinstance(law, RateAndState) else {})}


@given(age=st.floats(1e-3, 1e3), speed=st.floats(1e-6, 10.0))
def test_rate_and_state_at_an_age(age: float, speed: float) -> None:
    """Under slip and at rest the coefficient is that of the age, mu_0 + a ln(1 + v / v_0) + b ln(1 + v_0 age / L)."""
    law = RateAndState(0.3, 0.01, 0.05, 1e-3, 1e-4)
    aged = 0.3 + 0.05 * math.log(1.0 + 10.0 * age)
    sliding = aged + 0.01 * math.log(1.0 + speed / 1e-3)
    assert law.is_fulfilled((speed, 0.0), 2.0, (-2.0 * sliding, 0.0), 1e-9, (age,))
    assert not law.is_fulfilled((speed, 0.0), 2.0, (-2.0 * sliding, 0.0), 1e-9)
    assert law.is_fulfilled((0.0, 0.0), 2.0, (0.0, 1.9999 * aged), 1e-9, (age,))
    assert not law.is_fulfilled((0.0, 0.0), 2.0, (0.0, 2.001 * aged), 1e-9, (age,))


def _least_power(law: Bristle, fastest: float = 1e3) -> float:
    """Return the least power per load [m/s] that bristles bent within reach take out, beside what they store."""
    least = math.inf
    for speed in np.geomspace(1e-3, fastest, 60):
        for bent in np.linspace(-1.0, 1.0, 21):
            state, out = [bent * law.static_friction / law.stiffness, 0.0], [0.0] * 7
            law.traction(1.0, [speed, 0.0, 0.0, 0.0, 0.0], state, out, **dataclasses.asdict(law))
            least = min(least, -out[0] * speed - law.stiffness * state[0] * out[5])
    return least


def test_bristles_are_passive_with_enough_viscosity_only() -> None:
    """Both sides of s_2 = s_1 (mu_s - mu) / mu; below it the class says so."""
    assert _least_power(Bristle(0.2, 0.3, damping=10.0, viscosity=5.0)) >= 0.0
    assert _least_power(Bristle(0.3, 0.3, damping=10.0)) >= 0.0
    with pytest.warns(UnusualValue, match=r"Bristle\.viscosity = 4\.9 .*less than .* = 5: .*faster than 4\.5 m/s"):
        thin = Bristle(0.2, 0.3, damping=10.0, viscosity=4.9)
    assert _least_power(thin, 4.499) > 0.0
    assert _least_power(thin, 4.501) < 0.0
