"""The slider-crank with clearance against Newton-Euler equations with pins, integrated by scipy, and its impacts."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import nonsmooth as ns
from nonsmooth.engine.memory.modes import Cause
from scenarios.slider_crank import SliderCrank

GRAVITY = 9.81


def _run(scenario: SliderCrank, t_end: float | None = None, **options: Any) -> ns.Solution:
    return ns.simulate(
        scenario.build(),
        t_end or scenario.t_end,
        sample_interval=scenario.sample_interval,
        engine=ns.EventDriven(**options),
    )


def _pinned(scenario: SliderCrank) -> Any:
    """Return the free motion until a corner meets the guide: three bodies with mass centres, and their pin forces."""
    l_1, l_2 = scenario.crank_length, scenario.rod_length
    masses = (scenario.crank_mass, scenario.rod_mass, scenario.slider_mass)
    inertias = (scenario.crank_inertia, scenario.rod_inertia, scenario.slider_inertia)
    matrix = np.diag([x for m, j in zip(masses, inertias, strict=True) for x in (m, m, j)])
    load = np.array([x for m in masses for x in (0.0, -m * GRAVITY, 0.0)])

    def slope(t: float, y: Any) -> Any:
        angle, rate = y[:3], y[3:]
        e, n = np.array([np.cos(angle), np.sin(angle)]).T, np.array([-np.sin(angle), np.cos(angle)]).T
        # pins: ground to crank, crank to rod, rod to the slider's centre; each in x and z
        pins, right = np.zeros((6, 9)), np.zeros(6)
        halves = (0.5 * l_1, 0.5 * l_2, 0.0)
        for pin, (one, two) in enumerate(((None, 0), (0, 1), (1, 2))):
            for body, sign, side in ((one, 1.0, 1.0), (two, -1.0, -1.0)):
                if body is None:
                    continue
                rows, arm = slice(2 * pin, 2 * pin + 2), side * halves[body]
                pins[rows, 3 * body : 3 * body + 2] += sign * np.eye(2)
                pins[rows, 3 * body + 2] += sign * arm * n[body]
                right[rows] += sign * arm * e[body] * rate[body] ** 2
        system = np.block([[matrix, pins.T], [pins, np.zeros((6, 6))]])
        return np.concatenate([rate, np.linalg.solve(system, np.concatenate([load, right]))[[2, 5, 8]]])

    def room(t: float, y: Any) -> float:
        return float(scenario.clearance - l_1 * math.sin(y[0]) - l_2 * math.sin(y[1]))

    room.terminal = True  # type: ignore[attr-defined]
    start = [0.0, 0.0, 0.0, scenario.crank_rate, scenario.rod_rate, 0.0]
    return solve_ivp(slope, (0.0, 0.02), start, method="DOP853", rtol=1e-13, atol=1e-15, events=room)


@pytest.mark.slow
@pytest.mark.parametrize("law", ["newton", "energetic"])
def test_first_impact(law: str) -> None:
    """Its time is that of the free motion to 1e-9 s, its rates too, and both upper corners hit at once."""
    scenario = SliderCrank(law=law)
    free = _pinned(scenario)
    solution = _run(scenario, 3e-3, tolerance=1e-12)
    assert scenario.first_impact(solution) == pytest.approx(float(free.t_events[0][0]), abs=1e-9)
    event = int(np.flatnonzero(solution.events.cause == Cause.IMPACT)[0])
    np.testing.assert_allclose(solution.events.u_before[event], free.y_events[0][0][3:], rtol=0, atol=1e-6)
    hit = solution.events.impulse[event, :, 0] > 0.0
    assert hit.tolist() == [False] * 2 + [True] * 2
    # with the default tolerance too
    assert scenario.first_impact(_run(scenario, 3e-3)) == pytest.approx(float(free.t_events[0][0]), abs=1e-9)


@pytest.mark.parametrize("restitution", [0.0, 0.4, 1.0])
def test_newtons_restitution_of_the_degenerate_pair(restitution: float) -> None:
    """Two corners share one impulse, whatever its share: the slider's rate is reversed by e, and it stays level."""
    scenario = SliderCrank(restitution=restitution, friction=0.0)
    solution = _run(scenario, 3e-3)
    event = int(np.flatnonzero(solution.events.cause == Cause.IMPACT)[0])
    q = solution.events.q[event]
    row = np.array([scenario.crank_length * math.cos(q[0]), scenario.rod_length * math.cos(q[1]), 0.0])
    before, after = row @ solution.events.u_before[event], row @ solution.events.u_after[event]
    assert before > 0.5
    assert after == pytest.approx(-restitution * before, abs=1e-9)
    assert solution.events.u_after[event][2] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("law", ["newton", "energetic"])
def test_account_and_guide(law: str) -> None:
    """Over more than a turn no corner enters the guide, energy is lost only, and the account closes."""
    scenario = SliderCrank(law=law)
    solution = _run(scenario)
    assert solution.status == "done"
    assert solution.energy.residual < 1e-8
    assert solution.energy.restitution_loss > 0.0
    assert solution.energy.friction_loss > 0.0
    x, z = 0.5 * scenario.slider_length, 0.5 * scenario.slider_height
    for i in (-x, x):
        for j in (-z, z):
            corner = scenario.height(solution) + i * np.sin(solution.q[:, 2]) + j * np.cos(solution.q[:, 2])
            assert np.max(np.abs(corner)) < z + scenario.clearance + 1e-9
    assert scenario.summarise(solution)["turns"] > 1.0


def test_without_losses() -> None:
    """Elastic and frictionless: the crank keeps all of its energy over many impacts."""
    solution = _run(SliderCrank(restitution=1.0, friction=0.0, law="energetic"), 0.08)
    account = solution.energy
    assert solution.counters.impacts >= 3
    assert account.change == pytest.approx(0.0, abs=1e-7 * account.kinetic_start)


def test_wrong_input() -> None:
    """No clearance, no guide."""
    with pytest.raises(ns.InvalidInput, match=r"SliderCrank\.clearance must be > 0"):
        SliderCrank(clearance=0.0)
    with pytest.raises(ns.UnknownName, match=r"SliderCrank\.law"):
        SliderCrank(law="poisson")
