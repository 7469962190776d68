"""Newton's cradle against an independent compliant model, in its limits, and with wrong input."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import nonsmooth as ns
from scenarios.newtons_cradle import NewtonsCradle

EXACT = ns.EventDriven(impact_tolerance=1e-11)


def _velocities(scenario: NewtonsCradle, engine: ns.EventDriven = EXACT) -> Any:
    solution = ns.simulate(scenario.build(), scenario.t_end, engine=engine)
    assert solution.counters.impacts == 1
    return scenario.velocities(solution)


def _on_springs(scenario: NewtonsCradle) -> Any:
    """Return the velocities after the same strike on elastic springs k x^eta, in real time by scipy, in own units."""
    n, strikers = int(scenario.n_balls), int(scenario.n_strikers)
    masses = np.where(np.arange(n) < strikers, scenario.mass_ratio, 1.0)
    stiffness = scenario.stiffness_ratio ** np.arange(n - 1)

    def slope(t: float, y: Any) -> Any:
        force = stiffness * np.maximum(y[: n - 1] - y[1:n], 0.0) ** scenario.exponent
        push = np.concatenate([[0.0], force]) - np.concatenate([force, [0.0]])
        return np.concatenate([y[n:], push / masses])

    start = np.concatenate([np.zeros(n), np.where(np.arange(n) < strikers, scenario.speed, 0.0)])
    done = solve_ivp(slope, (0.0, 40.0 * n), start, method="DOP853", rtol=1e-12, atol=1e-13, max_step=0.05)
    assert np.all(np.diff(done.y[:n, -1]) >= -1e-12)
    return done.y[n:, -1]


CASES: list[dict[str, Any]] = [
    *({"n_balls": n, "exponent": eta} for n, eta in itertools.product((3, 5, 10), (1.0, 1.5))),
    {"n_strikers": 2},
    {"n_balls": 6, "n_strikers": 3, "exponent": 1.0},
    {"n_balls": 3, "mass_ratio": 0.5},
    {"n_balls": 4, "stiffness_ratio": 2.0},
]


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES, ids=str)
def test_against_springs_in_real_time(case: dict[str, Any]) -> None:
    """The multiple impact is the limit of springs, whatever their scale: the same velocities to 1e-8."""
    scenario = NewtonsCradle(**case)
    np.testing.assert_allclose(_velocities(scenario), _on_springs(scenario), rtol=0, atol=1e-8)


def _with_losses(scenario: NewtonsCradle) -> Any:
    """Return the velocities after the strike on springs that give back e^2 of their energy, in real time by scipy.

    A deformation x falls by the gap rate, and by the rate over e^2 while the spring expands.
    """
    n, strikers = int(scenario.n_balls), int(scenario.n_strikers)
    stiffness = scenario.stiffness_ratio ** np.arange(n - 1)
    masses = np.where(np.arange(n) < strikers, scenario.mass_ratio, 1.0)

    def slope(t: float, y: Any) -> Any:
        x, rate = y[: n - 1], np.diff(y[n - 1 :])
        force = stiffness * np.maximum(x, 0.0) ** scenario.exponent
        push = np.concatenate([[0.0], force]) - np.concatenate([force, [0.0]])
        deformation = np.where(rate < 0.0, -rate, -rate / scenario.restitution**2)
        return np.concatenate([np.where((x > 0.0) | (rate < 0.0), deformation, 0.0), push / masses])

    y = np.concatenate([np.zeros(n - 1), np.where(np.arange(n) < strikers, scenario.speed, 0.0)])
    t = 0.0
    while np.any(y[: n - 1] > 1e-12) or np.any(np.diff(y[n - 1 :]) < -1e-12):
        done = solve_ivp(slope, (t, t + 20.0), y, method="DOP853", rtol=1e-12, atol=1e-14, max_step=0.01)
        t, y = t + 20.0, done.y[:, -1]
        assert t < 1e4
    return y[n - 1 :]


@pytest.mark.slow
@pytest.mark.parametrize("restitution", [0.5, 0.9])
@pytest.mark.parametrize("exponent", [1.0, 1.5])
@pytest.mark.parametrize(
    "case",
    [
        {"n_balls": 3},
        {"n_balls": 5},
        {"n_balls": 10},
        {"n_balls": 4, "stiffness_ratio": 2.0, "mass_ratio": 0.5},
    ],
    ids=str,
)
def test_against_springs_with_losses(case: dict[str, Any], exponent: float, restitution: float) -> None:
    """Several coefficients of restitution, against an integration of the compliant model in real time: 1e-9."""
    scenario = NewtonsCradle(**case, exponent=exponent, restitution=restitution)
    np.testing.assert_allclose(_velocities(scenario), _with_losses(scenario), rtol=0, atol=1e-9)


@pytest.mark.parametrize(("ratio", "expected"), [(1e-6, (0.0, 0.0, 1.0)), (1e6, (-1 / 3, 2 / 3, 2 / 3))])
@pytest.mark.filterwarnings("ignore::nonsmooth.parameters.UnusualValue")
def test_limits_of_the_stiffness_ratio(ratio: float, expected: Any) -> None:
    """Ever softer contacts behind: one collision after the other.  Ever stiffer: the struck balls move as one."""
    after = _velocities(NewtonsCradle(n_balls=3, stiffness_ratio=ratio, exponent=1.0))
    np.testing.assert_allclose(after, expected, rtol=0, atol=2e-3)


@pytest.mark.parametrize("restitution", [0.0, 0.5, 0.9])
def test_losses(restitution: float) -> None:
    """Momentum stays, energy does not, and no ball overtakes another."""
    scenario = NewtonsCradle(restitution=restitution)
    solution = ns.simulate(scenario.build(), scenario.t_end)
    after = scenario.velocities(solution)
    assert float(np.sum(after)) == pytest.approx(1.0, abs=1e-12)
    assert np.all(np.diff(after) >= -1e-9)
    summary = scenario.summarise(solution)
    assert summary["energy_kept"] == pytest.approx(float(np.sum(after**2)), rel=1e-9)
    assert summary["energy_kept"] < 1.0
    assert summary["relative_velocity"] == after.tolist()


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"n_balls": 2.5}, ("NewtonsCradle.n_balls", "an integer", "2.5")),
        ({"n_strikers": 5}, ("NewtonsCradle.n_strikers", "less than the number of balls 5", "5")),
        ({"n_balls": 1}, ("NewtonsCradle.n_balls", ">= 2", "it is 1.")),
        ({"mass_ratio": -1.0}, ("NewtonsCradle.mass_ratio", "> 0", "-1.0")),
        ({"speed": float("nan")}, ("NewtonsCradle.speed", "finite", "nan")),
    ],
)
def test_wrong_input(wrong: dict[str, Any], words: tuple[str, ...]) -> None:
    """The message names the parameter, the rule and the value."""
    with pytest.raises(ns.InvalidInput) as caught:
        NewtonsCradle(**wrong)
    for word in words:
        assert word in str(caught.value)
