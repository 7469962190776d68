"""The spinning egg: it rises, against an independent integration, with the balance of its angular momentum."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import nonsmooth as ns
from nonsmooth.engine.native.kernel import PLAIN
from scenarios.egg_on_table import GRAVITY, EggOnTable

Array = NDArray[np.float64]
pytestmark = pytest.mark.skipif(PLAIN, reason="a minute in plain mode")


def _run(engine: Any = None, **given: Any) -> tuple[EggOnTable, ns.Solution]:
    scenario = EggOnTable(**given)
    solution = ns.simulate(scenario.build(), scenario.t_end, sample_interval=scenario.sample_interval, engine=engine)
    assert solution.energy.residual <= 1e-8
    return scenario, solution


def test_it_stands_up_and_pays_for_it() -> None:
    """The mass centre rises by nearly a - b; the spin at the end is that of Jellett's constant."""
    scenario, solution = _run()
    summary = scenario.summarise(solution)
    assert 1.0 < summary["upright"] < 2.5
    assert summary["flights"] == 0
    assert "stands up within" in scenario.figures(solution)["history"].get_suptitle()
    assert solution.q_end[2] - solution.q[0, 2] > 0.9 * (scenario.semi_long - scenario.semi_across)
    assert summary["energy_lost"] > scenario.mass * GRAVITY * (solution.q_end[2] - solution.q[0, 2]) > 0.0
    assert summary["spin"] == pytest.approx(scenario.upright_spin(), rel=0.01)


@pytest.mark.parametrize("given", [{"friction": 0.0}, {"spin": 40.0}], ids=["no friction", "slow"])
def test_it_stays_down(given: dict[str, float]) -> None:
    scenario, solution = _run(**given)
    assert scenario.summarise(solution)["upright"] is None
    assert np.min(scenario.tilts(solution.q)) > 1.4


def test_jellett_stays_while_the_egg_rises() -> None:
    """A Omega h stays to some per cent, though the height grows by more than a third."""
    scenario, solution = _run()
    constant = scenario.jellett(solution.q, solution.u)
    assert np.ptp(constant) < 0.03 * constant[0]
    assert np.ptp(solution.q[:, 2]) > 0.33 * scenario.semi_across


@pytest.mark.parametrize(
    ("given", "bound"), [({}, 1e-7), ({"spin": 250.0, "t_end": 2.0}, 1e-4)], ids=["sliding", "jumping"]
)
def test_balance_of_angular_momentum(given: dict[str, float], bound: float) -> None:
    """Whatever the friction does; across the kinks of an impact the spline of the samples is less exact."""
    scenario, solution = _run(ns.EventDriven(tolerance=1e-11), **given)
    assert scenario.balance(solution) < bound
    assert (scenario.summarise(solution)["flights"] > 10) == (bound > 1e-5)


def _independent(scenario: EggOnTable, t_end: float) -> Array:
    """Return normal, angular velocity and velocity of the mass centre, in body axes, after a slide [9].

    The normal force follows from the height of the mass centre, which is the support function h of the normal n:
    m (h'' + g) = N with h'' linear in N through the angular acceleration.
    """
    body = scenario.body()
    tensor, mass = np.array(body.inertia), scenario.mass
    squares = np.array([scenario.semi_across, scenario.semi_across, scenario.semi_long]) ** 2

    def rates(_: float, y: Array) -> Array:
        n, w, v = y[:3], y[3:6], y[6:]
        height = np.sqrt(n @ (squares * n))
        lever = squares * n / height
        turning = -np.cross(w, n)
        slip = v - np.cross(w, lever)
        slip = slip - slip @ n * n
        push = n - scenario.friction * slip / np.linalg.norm(slip)
        # h' = lever . n', h'' = n' . H n' + lever . n''
        curved = turning @ (squares * turning) / height - (lever @ turning) ** 2 / height
        free, by_force = -np.cross(w, tensor * w) / tensor, np.cross(-lever, push) / tensor
        known = curved + lever @ (-np.cross(free, n) - np.cross(w, turning))
        force = mass * (known + GRAVITY) / (1.0 + mass * lever @ np.cross(by_force, n))
        return np.concatenate([turning, free + force * by_force, force * push / mass - GRAVITY * n - np.cross(w, v)])

    tilt = np.array([0.0, np.sin(scenario.tilt), np.cos(scenario.tilt)])
    start = np.concatenate([tilt, scenario.spin * tilt, np.zeros(3)])
    return np.asarray(solve_ivp(rates, (0.0, t_end), start, "DOP853", rtol=1e-12, atol=1e-13).y[:, -1])


@pytest.mark.slow
def test_against_other_equations() -> None:
    """Normal, angular velocity and speed after 0.6 s of sliding, integrated by scipy from the support function."""
    scenario, solution = _run(ns.EventDriven(tolerance=1e-12), t_end=0.6)
    assert len(solution.events.time) == 1
    found = _independent(scenario, scenario.t_end)
    n = scenario.normals(solution.q_end[None])[0]
    np.testing.assert_allclose(n, found[:3], rtol=0, atol=1e-7)
    np.testing.assert_allclose(solution.u_end[3:], found[3:6], rtol=0, atol=1e-5)
    assert np.linalg.norm(solution.u_end[:3]) == pytest.approx(np.linalg.norm(found[6:]), abs=1e-7)
