"""Euler's disk: steady rolling, the equations of rolling by scipy, settling, slip, the energy account."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import nonsmooth as ns
from scenarios.rolling_disc import RollingDisc, steady

Floats = NDArray[np.float64]
FINE = ns.EventDriven(tolerance=1e-12)
GRAVITY = 9.81
UP = np.array([0.0, 0.0, 1.0])


def _roll(scenario: RollingDisc, times: Floats) -> tuple[Floats, Floats]:
    """Return axis and angular velocity in world axes of a disc that rolls without slip, shapes [n, 3], by scipy.

    Rolling makes the centre's velocity -omega x r, r from the centre to the lowest point; balance of angular momentum
    about the centre with the contact force m (dv/dt + g) is linear in the angular acceleration.
    """
    m, a = scenario.mass, scenario.radius
    flat, polar = m * a**2 / 4.0, m * a**2 / 2.0

    def slope(t: float, y: Floats) -> Floats:
        e, w = y[:3], y[3:]
        turned = np.cross(w, e)
        down, rate = e[2] * e - UP, turned[2] * e + e[2] * turned
        sine = math.sqrt(down @ down)
        r = a * down / sine
        r_rate = a * (rate / sine - down * (down @ rate) / sine**3)
        tensor = flat * (np.eye(3) - np.outer(e, e)) + polar * np.outer(e, e)
        drag = 0.25 * math.pi * scenario.viscosity * (a / sine) ** 3
        moment = -np.cross(w, tensor @ w) - m * np.cross(r, np.cross(w, r_rate)) + m * GRAVITY * np.cross(r, UP)
        about_contact = tensor + m * (r @ r * np.eye(3) - np.outer(r, r))
        return np.concatenate([turned, np.linalg.solve(about_contact, moment - drag * w)])

    s, c = math.sin(scenario.tilt), math.cos(scenario.tilt)
    rate = scenario.pace * float(steady.precession(scenario.tilt, a)) * s
    start = [s, 0.0, c, -rate * c, 0.0, rate * s]
    done = solve_ivp(slope, (0.0, times[-1]), start, "DOP853", t_eval=times, rtol=1e-12, atol=1e-13)
    return done.y[:3].T, done.y[3:].T


@pytest.mark.fast_cases(7)
@pytest.mark.parametrize("tilt", [0.03, 0.3, 0.8, 1.3])
@pytest.mark.parametrize("friction", [0.3, 0.0])
def test_steady_rolling(tilt: float, friction: float) -> None:
    """Omega^2 sin(alpha) = 4 g / a keeps tilt, rate and centre over ten turns, with friction and without."""
    scenario = RollingDisc(tilt=tilt, friction=friction, viscosity=0.0)
    rate = math.sqrt(4.0 * GRAVITY / (scenario.radius * math.sin(tilt)))
    solution = ns.simulate(scenario.build(), 20.0 * math.pi / rate, engine=FINE)
    np.testing.assert_allclose(scenario.tilts(solution), tilt, rtol=1e-8)
    np.testing.assert_allclose(scenario.precession(solution), rate, rtol=1e-8)
    assert np.max(np.abs(solution.q[:, :2])) <= 1e-8 * scenario.radius
    turned = scenario.contact_points(solution.q, solution.u)[-1]
    np.testing.assert_allclose(turned, [scenario.radius * math.cos(tilt), 0.0], rtol=0, atol=1e-6 * scenario.radius)


@pytest.mark.parametrize("pace", [0.9, 1.1])
def test_another_rate_is_not_steady(pace: float) -> None:
    """At another rate the disc nods and its centre moves: the relation is no accident of the start."""
    scenario = RollingDisc(tilt=0.5, pace=pace, viscosity=0.0, friction=1.0)
    solution = ns.simulate(scenario.build(), 0.5)
    assert np.ptp(scenario.tilts(solution)) > 0.01
    assert np.max(np.abs(solution.q[:, :2])) > 0.01 * scenario.radius


@pytest.mark.slow
@pytest.mark.parametrize(("pace", "viscosity"), [(0.8, 0.0), (1.2, 0.0), (1.0, 0.05), (0.8, 0.05)])
def test_rolling_by_scipy(pace: float, viscosity: float) -> None:
    """Tilt, precession and rolling velocity follow the equations of a disc that cannot slip."""
    scenario = RollingDisc(tilt=0.5, pace=pace, viscosity=viscosity, friction=2.0, end_tilt=0.05)
    solution = ns.simulate(scenario.build(), 0.6, engine=FINE)
    assert set(solution.events.causes()) == {"start"}
    times = solution.t[::50]
    axis, spin = _roll(scenario, times)
    ours, rate = (values[::50] for values in scenario.axis(solution.q, solution.u))
    np.testing.assert_allclose(ours, axis, rtol=0, atol=1e-8)
    scale = float(steady.precession(0.5, scenario.radius))
    np.testing.assert_allclose(rate, np.cross(spin, axis), rtol=0, atol=1e-8 * scale)


def _time_over_theory(**given: float) -> float:
    """Return the time to half the tilt over that of slow settling, less one."""
    scenario = RollingDisc(end_tilt=0.5 * given["tilt"], **given)
    solution = ns.simulate(scenario.build(), scenario.t_end, engine=ns.EventDriven(tolerance=1e-11))
    assert solution.message == "a guard of the scenario ended the run"
    flat = steady.time_to_flat(scenario.tilt, scenario.radius, scenario.mass, scenario.viscosity)
    exact = flat * (1.0 - (math.sin(scenario.end_tilt) / math.sin(scenario.tilt)) ** 3)
    return solution.t_end / exact - 1.0


def test_settling_on_a_smooth_table() -> None:
    """Without friction sin^3(alpha) falls linearly, up to an error that the viscosity bounds."""
    viscosities = np.array([0.2, 0.1, 0.05, 0.01, 0.0025])
    errors = [_time_over_theory(tilt=0.3, friction=0.0, viscosity=eta) for eta in viscosities.tolist()]
    assert errors[0] > 0.05
    assert np.all(np.abs(errors) < 0.3 * viscosities)


def test_settling_of_a_rolling_disc() -> None:
    """A disc that rolls must turn about its own axis as it comes down: it takes longer, by a share of order alpha^2."""
    errors = [_time_over_theory(tilt=tilt, friction=1.0, viscosity=0.6 * tilt**3) for tilt in (0.2, 0.1, 0.05)]
    assert 0.0 < errors[2] < 0.005
    np.testing.assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 2.0, atol=0.2)


def test_precession_rises_as_it_settles() -> None:
    """The quasi-steady relation holds all the way down, and the rate rises."""
    scenario = RollingDisc(viscosity=2e-4, t_end=9.5)
    solution = ns.run_scenario(scenario)
    tilts, rates = scenario.tilts(solution), scenario.precession(solution)
    assert tilts[-1] < 0.021 < 0.099 < tilts[0]
    assert scenario.summarise(solution)["tilt"] == pytest.approx(scenario.end_tilt, abs=1e-9)
    assert rates[-1] > 2.2 * rates[0] > 0.0
    np.testing.assert_allclose(rates / steady.precession(tilts, scenario.radius), 1.0, atol=0.01)


@pytest.mark.parametrize("tilt", [0.05, 0.2])
def test_power_of_the_air(tilt: float) -> None:
    """In steady rolling the air takes pi viscosity g a^2 / sin^2(alpha), Moffatt's power for small tilts."""
    scenario = RollingDisc(tilt=tilt, viscosity=1e-5)
    time = 1e-3
    solution = ns.simulate(scenario.build(), time, engine=FINE)
    power = math.pi * scenario.viscosity * GRAVITY * scenario.radius**2 / math.sin(tilt) ** 2
    assert -solution.energy.load_work / time == pytest.approx(power, rel=1e-4)


def test_slip_ends_in_rolling() -> None:
    """A spin about the own axis slides, friction takes energy until the disc rolls, and nothing does after that."""
    scenario = RollingDisc(tilt=0.5, spin=10.0, viscosity=0.0)
    longer, shorter = (ns.simulate(scenario.build(), t, engine=FINE) for t in (0.6, 0.3))
    assert longer.events.causes() == ["start", "slip to stick"]
    caught = longer.events.time[1]
    assert 0.0 < caught < 0.2
    losses = [run.energy.friction_loss for run in (longer, shorter)]
    assert losses[0] > 0.1 * longer.energy.kinetic_start
    assert losses[0] == pytest.approx(losses[1], rel=1e-12)
    assert longer.energy.change == pytest.approx(-losses[0], rel=1e-9)
    axis, rate = scenario.axis(longer.q, longer.u)
    spin = np.cross(axis, rate) + longer.u[:, 5, None] * axis
    arm = np.append(scenario.contact_points(longer.q, longer.u), np.zeros((len(axis), 1)), axis=1) - longer.q[:, :3]
    slip = np.linalg.norm(longer.u[:, :3] + np.cross(spin, arm), axis=1)
    assert slip[0] == pytest.approx(10.0 * scenario.radius)
    assert np.max(slip[longer.t > caught]) <= 1e-7


@pytest.mark.parametrize("given", [{"pace": 0.8, "viscosity": 0.0}, {"pace": 0.8, "viscosity": 0.02}, {"spin": 20.0}])
def test_energy_account_converges(given: dict[str, Any]) -> None:
    """What the account does not explain falls at least as the tolerance, from 1e-6 to 1e-12."""
    scenario = RollingDisc(tilt=0.5, **given)
    residuals = []
    for tolerance in (1e-6, 1e-8, 1e-10, 1e-12):
        run = ns.simulate(scenario.build(), 0.3, engine=ns.EventDriven(tolerance=tolerance))
        residuals.append(run.energy.residual)
    slope = np.polyfit([-6.0, -8.0, -10.0, -12.0], np.log10(residuals), 1)[0]
    assert slope > 0.8
    assert residuals[-1] < 1e-10


def test_wrong_input() -> None:
    """A disc that stands upright, lies flat or ends above its start is refused."""
    for name, value in (("tilt", 1.6), ("tilt", 0.0), ("radius", -1.0), ("end_tilt", 0.2), ("viscosity", -1.0)):
        with pytest.raises(ns.InvalidInput, match=rf"RollingDisc\.{name}"):
            RollingDisc(**{name: value})


def test_coordinates_summary_and_end_agree() -> None:
    scenario = RollingDisc(tilt=0.3, viscosity=0.01, t_end=0.4)
    solution = ns.run_scenario(scenario)
    coordinates, summary = scenario.coordinates(solution), scenario.summarise(solution)
    assert [coordinates[name][-1] for name in "xyz"] == pytest.approx(scenario.final(solution)["q"][:3])
    assert coordinates["z"][-1] == pytest.approx(scenario.radius * math.sin(summary["tilt"]), abs=1e-9)
    assert summary["air_loss"] > 0.0


def test_a_long_path_is_its_last_turns() -> None:
    """All of it would be a grey disc; three turns of steady rolling are a circle that is gone round three times."""
    scenario = RollingDisc(viscosity=0.0, t_end=2.0)
    solution = ns.run_scenario(scenario)
    (axis,) = scenario.figures(solution)["paths"].axes
    x, y = np.asarray(axis.lines[0].get_data())
    assert "last 3 turns" in str(axis.lines[0].get_label())
    np.testing.assert_allclose(np.hypot(x, y), 1e3 * scenario.radius * math.cos(scenario.tilt), rtol=1e-6)
    angles = np.unwrap(np.arctan2(y, x))
    assert abs(angles[-1] - angles[0]) == pytest.approx(6.0 * math.pi, rel=1e-6)
