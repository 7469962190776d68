"""Bernoulli's problem in closed form, against springs in real time, and in its limits."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import nonsmooth as ns
from scenarios.disc_ball import DiscBall
from scenarios.disc_ball.closed_forms import one_after_the_other, symmetric

EXACT = ns.EventDriven(impact_tolerance=1e-11)


def _run(scenario: DiscBall) -> ns.Solution:
    return ns.simulate(scenario.build(), scenario.t_end, sample_interval=scenario.sample_interval, engine=EXACT)


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
@pytest.mark.parametrize(("mass_ratio", "radius_ratio"), [(1.0, 1.0), (8.0, 2.0), (0.2, 0.5)])
def test_symmetric_strike(restitution: float, mass_ratio: float, radius_ratio: float) -> None:
    """One impact, both balls along their lines of centres, as the balance of one impulse says; exponent or not."""
    for exponent in (1.0, 1.5):
        scenario = DiscBall(mass_ratio, radius_ratio, restitution=restitution, exponent=exponent)
        solution = _run(scenario)
        assert solution.counters.impacts == 1
        disc, ball = symmetric(mass_ratio, radius_ratio, restitution)
        along = ball * np.array([math.sin(scenario.half_angle), math.cos(scenario.half_angle)])
        expected = np.array([[0.0, disc], [-along[0], along[1]], [along[0], along[1]]])
        np.testing.assert_allclose(scenario.velocities(solution), expected, rtol=0, atol=1e-9)


def test_equal_elastic_balls() -> None:
    """The disc comes back with a fifth of its speed, the balls leave with 2 sqrt(3)/5 of it."""
    disc, ball = symmetric(1.0, 1.0, 1.0)
    assert disc == pytest.approx(-0.2, abs=1e-15)
    assert ball == pytest.approx(2.0 * math.sqrt(3.0) / 5.0, abs=1e-15)


def _on_springs(scenario: DiscBall) -> Any:
    """Return the velocities of the same strike on springs at fixed directions, in real time by scipy, in own units."""
    alpha, e2 = scenario.half_angle, scenario.restitution**2
    normals = np.array([[-math.sin(alpha), math.cos(alpha)], [math.sin(alpha), math.cos(alpha)]])
    stiffness = np.array([1.0, scenario.stiffness_ratio])

    def slope(t: float, y: Any) -> Any:
        x, disc, balls = y[:2], y[2:4], y[4:].reshape(2, 2)
        rates = np.sum(normals * (balls - disc), axis=1)
        force = stiffness * np.maximum(x, 0.0) ** scenario.exponent
        grows = np.where(rates > 0.0, -rates / e2, -rates)
        grows[(x <= 0.0) & (rates > 0.0)] = 0.0
        return np.concatenate([grows, -(force @ normals) / scenario.mass_ratio, (force[:, None] * normals).ravel()])

    start = np.concatenate([np.zeros(2), scenario.direction, np.zeros(4)])
    done = solve_ivp(slope, (0.0, 15.0), start, method="DOP853", rtol=1e-12, atol=1e-13, max_step=0.02)
    assert np.all(done.y[:2, -1] <= 1e-12)
    return done.y[2:, -1].reshape(3, 2)


CASES: list[dict[str, float]] = [
    {"stiffness_ratio": 3.0},
    {"stiffness_ratio": 3.0, "exponent": 1.0},
    {"incidence": 0.4},
    {"incidence": -0.2, "stiffness_ratio": 0.5, "mass_ratio": 2.0, "radius_ratio": 1.5},
    {"incidence": 0.3, "stiffness_ratio": 2.0, "restitution": 0.7},
]


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES, ids=str)
def test_against_springs_in_real_time(case: dict[str, float]) -> None:
    """Without symmetry there is no closed form; the springs say the same to 1e-8."""
    scenario = DiscBall(**case)
    solution = _run(scenario)
    assert solution.counters.impacts == 1
    np.testing.assert_allclose(scenario.velocities(solution), _on_springs(scenario), rtol=0, atol=1e-8)


@pytest.mark.parametrize(("ratio", "first"), [(1e-6, 0), (1e6, 1)])
@pytest.mark.parametrize("restitution", [0.6, 1.0])
def test_limits_of_the_stiffness_ratio(ratio: float, first: int, restitution: float) -> None:
    """The ball at the far stiffer contact is struck first, the other after it."""
    scenario = DiscBall(stiffness_ratio=ratio, restitution=restitution, exponent=1.0)
    expected = one_after_the_other(1.0, 1.0, restitution, scenario.direction, first)
    np.testing.assert_allclose(scenario.velocities(_run(scenario)), expected, rtol=0, atol=2e-3)


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("restitution", [0.6, 1.0])
def test_limits_of_the_offset(side: float, restitution: float) -> None:
    """From either side, a vanishing offset gives collisions one after the other, not the one at once."""
    errors = []
    for offset in (1e-5, 1e-7):
        scenario = DiscBall(offset=side * offset, restitution=restitution)
        expected = one_after_the_other(1.0, 1.0, restitution, scenario.direction, int(side > 0.0))
        errors.append(np.max(np.abs(scenario.velocities(_run(scenario)) - expected)))
    assert errors[0] < 2e-3
    assert errors[1] < 0.02 * errors[0]
    assert np.max(np.abs(scenario.velocities(_run(scenario)) - scenario.velocities(_run(DiscBall())))) > 0.1


@pytest.mark.parametrize("case", [*CASES, {"offset": 4e-3}, {"offset": -4e-3, "restitution": 0.5}], ids=str)
def test_momentum_and_energy(case: dict[str, float]) -> None:
    """Momentum stays, energy stays if e = 1 and falls if not, and no body runs into another."""
    scenario = DiscBall(**case)
    solution = _run(scenario)
    masses = np.array([scenario.mass_ratio, 1.0, 1.0])
    velocities = scenario.velocities(solution)
    np.testing.assert_allclose(masses @ velocities, scenario.mass_ratio * scenario.direction, rtol=0, atol=1e-12)
    kept = float(masses @ np.sum(velocities**2, axis=1)) / scenario.mass_ratio
    assert scenario.summarise(solution)["energy_kept"] == pytest.approx(kept, rel=1e-12)
    assert kept == pytest.approx(1.0, abs=1e-9) if scenario.restitution == 1.0 else kept < 0.99
    places = scenario.positions(solution)
    for i, j in itertools.combinations(range(3), 2):
        gaps = np.hypot(*(places[:, i] - places[:, j]).T) - scenario.radii[i] - scenario.radii[j]
        assert np.min(gaps) >= -1e-12


def test_wrong_input() -> None:
    """A disc that comes too far from the side cannot touch both balls at once."""
    with pytest.raises(ns.InvalidInput) as caught:
        DiscBall(incidence=0.9, radius_ratio=0.5)
    for word in ("DiscBall.incidence", "below 0.8411", "0.9"):
        assert word in str(caught.value)
