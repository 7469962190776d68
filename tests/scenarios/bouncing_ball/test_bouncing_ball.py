"""The bouncing ball against closed forms, and against a map of impacts computed by scipy."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import nonsmooth as ns
from scenarios.bouncing_ball import figures
from scenarios.bouncing_ball.orbits import existence, repetition, stability
from scenarios.bouncing_ball.scenario import GRAVITY, BouncingBall


def _run(**start: Any) -> tuple[BouncingBall, ns.Solution]:
    scenario = BouncingBall(**start)
    return scenario, ns.simulate(scenario.build(), scenario.t_end, sample_interval=scenario.sample_interval)


def _near(gamma: float, e: float, n: int, flights: int = 400, error: float = 1e-3) -> Any:
    """Return the flights of a run that starts near the orbit, at 25 Hz."""
    speed = (1.0 + error) * GRAVITY * n / 50.0
    scenario, solution = _run(gamma=gamma, restitution=e, orbit=float(n), speed=speed, t_end=flights * n / 25.0)
    assert solution.energy.residual <= 1e-8
    return scenario.flights(solution)


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize(("e", "n"), [(0.5, 1), (0.8, 1), (0.8, 2), (0.9, 3)])
def test_orbits_between_their_bounds(e: float, n: int) -> None:
    """Inside, close to either bound and halfway, a disturbance dies out and flights take n periods."""
    low, high = existence(e, n), stability(e, n)
    for gamma in (low + 0.02 * (high - low), 0.5 * (low + high), high - 0.02 * (high - low)):
        flights = _near(gamma, e, n)
        assert len(flights) >= 398
        assert np.max(np.abs(flights[-20:] - n)) < 3e-4 * n


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize(("e", "n"), [(0.5, 1), (0.8, 1), (0.8, 2), (0.9, 3)])
def test_orbits_end_at_their_bounds(e: float, n: int) -> None:
    """A little above the upper bound two flights repeat, a little below the lower one the orbit is lost."""
    low, high = existence(e, n), stability(e, n)
    above = _near(high + 0.01 * (high - low), e, n, flights=1500)
    assert repetition(above, 1e-4) == 2
    np.testing.assert_allclose(above[-10:-1] + above[-9:], 2.0 * n, rtol=0, atol=1e-6)
    assert abs(above[-1] - n) > 1e-3
    below = _near(low - 0.01 * (high - low), e, n, error=0.0)
    assert len(below) == 0 or np.max(np.abs(below[-5:] - n)) > 0.1


def _by_map(scenario: BouncingBall, count: int) -> Any:
    """Return the first impact times [s] from flights whose ends brentq finds in closed form."""
    omega, e = 2.0 * math.pi * scenario.frequency, scenario.restitution
    t, z, v = 0.0, scenario.amplitude * math.sin(scenario.phase), scenario.resolved()["speed"]
    times = []
    for _ in range(count):

        def gap(s: float, t: float = t, z: float = z, v: float = v) -> float:
            table = scenario.amplitude * math.sin(omega * (t + s) + scenario.phase)
            return z + v * s - 0.5 * GRAVITY * s * s - table

        grid = np.linspace(0.0, 10.0 * scenario.period, 20001)[1:]
        values = np.array([gap(s) for s in grid])
        k = int(np.flatnonzero((values[:-1] > 0.0) & (values[1:] <= 0.0))[0])
        s = brentq(gap, grid[k], grid[k + 1], xtol=1e-16, rtol=1e-14)
        t, v = t + s, v - GRAVITY * s
        angle = omega * t + scenario.phase
        z, table = scenario.amplitude * math.sin(angle), scenario.amplitude * omega * math.cos(angle)
        v = table + e * (table - v)
        times.append(t)
    return np.array(times)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "count"),
    [
        ({"gamma": 0.9, "speed": 0.19}, 25),
        ({"gamma": 0.9, "orbit": 2.0, "speed": 0.38}, 25),
        ({"gamma": 1.12, "speed": 0.19}, 25),
        ({"gamma": 2.5, "speed": 0.25}, 12),
    ],
)
def test_impact_times_against_a_map(start: dict[str, Any], count: int) -> None:
    """On orbits, beyond the doubling, and in chaos as long as it lets errors stay small."""
    scenario, solution = _run(t_end=3.0, **start)
    np.testing.assert_allclose(scenario.impact_times(solution)[:count], _by_map(scenario, count), rtol=0, atol=1e-9)


@pytest.mark.parametrize("e", [0.3, 0.7, 0.9])
def test_drop_on_a_table_at_rest(e: float) -> None:
    """At rest at (1 + e)/(1 - e) v0/g; the contact time cuts off what is left of the accumulation."""
    height, contact_time = 0.05, 1e-7
    rest = (1.0 + e) / (1.0 - e) * math.sqrt(2.0 * height / GRAVITY)
    scenario, solution = _run(gamma=0.0, height=height, restitution=e, contact_time=contact_time, t_end=rest + 0.1)
    summary = scenario.summarise(solution)
    # the last bounce is slower than g T_c, and those cut off take no more than 2 T_c (1 + e + ...)
    assert rest - 2.1 * contact_time / (1.0 - e) < summary["first_rest"] <= rest + 1e-12
    assert summary["resting_share"] == pytest.approx(0.1 / (rest + 0.1), abs=1e-5)
    assert solution.energy.residual <= 1e-9


def test_sweep_follows_the_orbit_and_its_doubling() -> None:
    """The diagram has one value below the bound, that of the formula, and two above it."""
    e = 0.6
    low, high = existence(e, 1), stability(e, 1)
    gammas = np.linspace(1.01 * low, 1.03 * high, 24)
    found = figures.sweep(BouncingBall(restitution=e), gammas, settle=250, keep=50, run=ns.run_scenario)
    for gamma in gammas:
        phases = found[1][found[0] == gamma]
        assert len(phases) >= 45
        if gamma < 0.98 * high:
            np.testing.assert_allclose(phases, math.acos(low / gamma) / (2.0 * math.pi), rtol=0, atol=1e-6)
        if gamma > 1.01 * high:
            assert np.ptp(phases) > 0.02
            np.testing.assert_allclose(phases[2:], phases[:-2], rtol=0, atol=1e-5)


def test_summary_knows_the_orbit() -> None:
    """One flight repeats on the orbit, two beyond the doubling, none in chaos."""
    for gamma, expected in ((0.8, 1), (1.12, 2), (2.5, None)):
        scenario, solution = _run(gamma=gamma, speed=0.1963, t_end=20.0)
        assert scenario.summarise(solution)["repeats_after"] == expected


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"orbit": 1.5}, ("BouncingBall.orbit", "an integer", "1.5")),
        ({"gamma": 0.0}, ("BouncingBall.height", "table at rest")),
        ({"height": 0.1, "speed": 1.0}, ("BouncingBall.speed", "left out", "1.0")),
        ({"restitution": 1.2}, ("BouncingBall.restitution", "<= 1", "1.2")),
    ],
)
def test_wrong_input(wrong: dict[str, Any], words: tuple[str, ...]) -> None:
    """The message names the parameter, the rule and the value."""
    with pytest.raises(ns.InvalidInput) as caught:
        BouncingBall(**wrong)
    for word in words:
        assert word in str(caught.value)
