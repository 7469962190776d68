"""Painleve's rod: both sides of the threshold, and every end of its sliding against independent computations."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

import nonsmooth as ns
from nonsmooth.engine.memory.modes import Cause
from scenarios.sliding_rod.paradox import RodContact
from scenarios.sliding_rod.scenario import GRAVITY, SlidingRod

EXACT = ns.EventDriven(tolerance=1e-11)


def _run(**start: Any) -> tuple[SlidingRod, ns.Solution]:
    scenario = SlidingRod(**start)
    solution = ns.run_scenario(scenario, EXACT)
    assert solution.energy.residual <= 1e-8
    return scenario, solution


def _struck(**start: Any) -> bool:
    """Tell whether the rod finds no force at its start, within the first microsecond."""
    _, solution = _run(t_end=1e-6, **start)
    return solution.events.count(Cause.PAINLEVE) > 0


@pytest.mark.parametrize("tilt", [0.5, 0.9, math.atan(2.0), 1.3])
@pytest.mark.parametrize("end_radius", [1e-5, 5e-3])
@pytest.mark.filterwarnings("ignore::nonsmooth.parameters.UnusualValue")
def test_both_sides_of_the_threshold(tilt: float, end_radius: float) -> None:
    """A thousandth below the critical friction the rod slides on, a thousandth above no force exists."""
    critical = RodContact(0.1, 0.1, end_radius).critical_friction(tilt)
    for side in (-1e-3, 1e-3):
        assert _struck(tilt=tilt, end_radius=end_radius, friction=critical * (1.0 + side)) == (side > 0.0)


@pytest.mark.slow
def test_threshold_of_a_sharp_rod() -> None:
    """With ever smaller ends the least critical friction goes to 4/3, at tan(angle) = 2, linearly in the radius."""
    exact = 4.0 / 3.0
    short = []
    for end_radius in (1e-3, 1e-4, 1e-5):
        low, high = 1.2, 1.4
        while high - low > 1e-9:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if _struck(friction=middle, end_radius=end_radius) else (middle, high)
        short.append(exact - high)
        # h = s sin(angle) + r in the place of s sin(angle)
        below = 0.1 * math.sin(math.atan(2.0))
        assert high == pytest.approx(exact * below / (below + end_radius), abs=2e-9)
    assert short[0] / short[1] == pytest.approx(10.0, rel=0.02)
    assert short[1] / short[2] == pytest.approx(10.0, rel=0.002)
    least = minimize_scalar(RodContact(0.1, 0.1, 0.0).critical_friction, bounds=(0.2, 1.5), options={"xatol": 1e-10})
    assert least.fun == pytest.approx(exact, abs=1e-12)
    assert math.tan(least.x) == pytest.approx(2.0, abs=1e-6)


def test_trailing_end_has_no_paradox() -> None:
    """Sliding backwards, friction lifts the load off the end, whatever the coefficient."""
    _, solution = _run(friction=2.0, speed=-1.0, t_end=0.05)
    assert solution.events.count(Cause.PAINLEVE, Cause.JAM) == 0
    assert solution.events.words("after")[0] == "{01,00,01}"


def _pivoting_rate(scenario: SlidingRod, tilt: float, u: Any) -> float:
    """Return the rate at which the rod turns about its end once that has stopped: its moment about it stays."""
    ahead, below = scenario.rod.arm(tilt)
    moment = scenario.rod.inertia * u[4] + scenario.mass * (below * u[0] + ahead * u[2])
    return float(moment / (scenario.rod.inertia + scenario.mass * (ahead**2 + below**2)))


@pytest.mark.parametrize("friction", [1.34, 1.6, 2.0])
@pytest.mark.parametrize("speed", [0.1, 3.0])
def test_impact_without_collision(friction: float, speed: float) -> None:
    """It stops the end at once; with e = 0 the rod then turns about it, and no energy is made."""
    scenario, solution = _run(friction=friction, speed=speed, t_end=1e-4)
    events = solution.events
    assert events.causes()[0] == "impact without collision"
    assert events.u_after[0, 4] == pytest.approx(_pivoting_rate(scenario, scenario.tilt, events.u_before[0]), rel=1e-7)
    assert abs(scenario.slips(events.q, events.u_after)[0]) <= 1e-9 * speed
    assert events.impulse[0, 0, 0] > 0.0
    assert events.friction_loss[0] > 0.0
    assert scenario.summarise(solution)["impact_without_collision"] == 0.0


def _sliding(scenario: SlidingRod, t_end: float, stiffness: float | None = None) -> Any:
    """Integrate forward slip by scipy until it stops or the end lifts off: rigid, or on a spring [N/m]."""
    rod, mu = scenario.rod, scenario.friction

    def force(y: Any) -> float:
        if stiffness is not None:
            return stiffness * max(0.0, -float(y[3]))
        return -rod.free_acceleration(y[0], y[1], GRAVITY) / rod.reduced_coefficient(y[0], mu)

    def slope(t: float, y: Any) -> list[float]:
        """Return the rates of angle, its rate, velocity along x, gap, gap rate."""
        ahead, below = rod.arm(y[0])
        normal = force(y)
        turn = normal * (mu * below - ahead) / rod.inertia
        gap = rod.reduced_coefficient(y[0], mu) * normal + rod.free_acceleration(y[0], y[1], GRAVITY)
        return [y[1], turn, -mu * normal / rod.mass, y[4], gap]

    def slip(t: float, y: Any) -> float:
        return float(y[2] - y[1] * rod.arm(y[0])[1])

    def lift(t: float, y: Any) -> float:
        return -rod.free_acceleration(y[0], y[1], GRAVITY) if stiffness is None else 1e-6 - y[3]

    slip.terminal = lift.terminal = True  # type: ignore[attr-defined]
    start = [scenario.tilt, scenario.rate, scenario.speed + scenario.rate * rod.arm(scenario.tilt)[1], 0.0, 0.0]
    if stiffness is None:
        return solve_ivp(slope, (0.0, t_end), start, method="DOP853", events=(slip, lift), rtol=1e-12, atol=1e-13)
    free = rod.free_acceleration(scenario.tilt, scenario.rate, GRAVITY)
    start[3] = free / rod.reduced_coefficient(scenario.tilt, mu) / stiffness
    return solve_ivp(slope, (0.0, t_end), start, method="LSODA", events=(slip, lift), rtol=1e-9, atol=1e-15)


def test_lift_off_against_an_independent_integration() -> None:
    """Below the paradox the rod turns faster until its end leaves the ground: the same time and state to 1e-8."""
    scenario, solution = _run(friction=1.2, tilt=1.0, rate=8.0, speed=5.0, t_end=0.04)
    events = solution.events
    assert events.causes()[1] == "lift-off"
    done = _sliding(scenario, 0.04)
    assert len(done.t_events[1]) == 1
    assert events.time[1] == pytest.approx(done.t[-1], abs=1e-8)
    phi = scenario.tilts(events.q)[1]
    assert phi == pytest.approx(done.y[0, -1], abs=1e-8)
    assert events.u_after[1, 4] == pytest.approx(done.y[1, -1], rel=1e-8)
    assert abs(scenario.rod.free_acceleration(float(phi), float(events.u_after[1, 4]), GRAVITY)) < 1e-5
    assert scenario.summarise(solution)["lift_off"] == events.time[1]


def test_slip_to_stick_against_an_independent_integration() -> None:
    """Just below the threshold the force is large, and the slip stops soon: the same time to 1e-8."""
    scenario, solution = _run(friction=1.3, t_end=0.01)
    events = solution.events
    assert events.cause[1] == Cause.SLIP_TO_STICK
    done = _sliding(scenario, 0.01)
    assert len(done.t_events[0]) == 1
    assert events.time[1] == pytest.approx(done.t[-1], abs=1e-8)


@pytest.mark.slow
def test_jamming_against_springs() -> None:
    """Where sliding runs into the paradox the end stops at once, as it does on ever stiffer springs."""
    scenario, solution = _run(friction=2.0, tilt=0.5, rate=5.0, speed=3.0, t_end=0.03)
    events = solution.events
    assert events.cause[1] == Cause.JAM
    phi, rate = float(scenario.tilts(events.q)[1]), float(events.u_after[1, 4])
    # coefficient and free acceleration vanish together there, with the slip still fast (Genot and Brogliato 1999)
    assert scenario.rod.critical_friction(phi) == pytest.approx(2.0, abs=1e-5)
    assert scenario.slips(events.q, events.u_before)[1] > 0.5
    assert -0.05 < scenario.rod.free_acceleration(phi, float(events.u_before[1, 4]), GRAVITY) < 0.0
    assert rate == pytest.approx(_pivoting_rate(scenario, phi, events.u_before[1]), rel=1e-6)
    assert events.friction_loss[1] > 0.0
    errors = []
    for stiffness in (1e6, 1e8, 1e10):
        done = _sliding(scenario, 0.03, stiffness)
        assert len(done.t_events[0]) == 1
        errors.append([abs(done.t[-1] - events.time[1]), abs(done.y[0, -1] - phi), abs(done.y[1, -1] - rate)])
    errors_ = np.array(errors)
    assert np.all(errors_[1:] < 0.4 * errors_[:-1])
    np.testing.assert_array_less(errors_[-1], [2e-4, 3e-3, 2e-2])
    assert scenario.summarise(solution)["jam"] == events.time[1]


def test_the_other_end_lands() -> None:
    """A rod that pivots on one end comes down on the other; both then lie on the ground."""
    scenario, solution = _run(friction=0.5, tilt=0.6, rate=-2.0, speed=0.5, t_end=0.5)
    assert solution.events.count(Cause.IMPACT) > 0
    assert abs(scenario.final(solution)["q"][2]) < 1e-9
    assert scenario.final(solution)["q"][1] == pytest.approx(scenario.end_radius, abs=1e-9)
    assert solution.events.count(Cause.LIFT_OFF, Cause.PAINLEVE, Cause.JAM) == 0


@pytest.mark.parametrize("tilt", [0.0, -0.3, 2.0])
def test_wrong_input(tilt: float) -> None:
    """The message names the parameter, the rule and the value."""
    with pytest.raises(ns.InvalidInput) as caught:
        SlidingRod(tilt=tilt)
    for word in ("SlidingRod.tilt", "must be", str(tilt)):
        assert word in str(caught.value)
