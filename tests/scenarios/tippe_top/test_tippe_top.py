"""The tippe top: it turns over, against an independent integration, with Jellett's quantity and the energy kept."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import nonsmooth as ns
from scenarios.tippe_top.friction import SpinningCoulomb
from scenarios.tippe_top.scenario import GRAVITY, TippeTop

EXACT = ns.EventDriven(tolerance=1e-11)


def _run(engine: ns.EventDriven | None = None, **start: Any) -> tuple[TippeTop, ns.Solution]:
    scenario = TippeTop(**start)
    solution = ns.run_scenario(scenario, engine)
    assert solution.energy.residual <= 1e-8
    return scenario, solution


def test_it_turns_over() -> None:
    """The source's top rises onto its stem; the spin about its axis changes sign, and energy is accounted for."""
    scenario, solution = _run()
    summary = scenario.summarise(solution)
    assert summary["inverted"]
    assert math.degrees(summary["tilt"]) > 179.9
    assert 1.0 < summary["stem_down"] < 3.0
    assert summary["body_up"] >= summary["stem_down"]
    assert summary["spin_axis"] < -50.0
    assert summary["spin_vertical"] == pytest.approx(-summary["spin_axis"], rel=1e-3)
    # it stands higher than it began, on the stem, and paid for it with its spin
    assert solution.q_end[2] == pytest.approx(scenario.stem_offset + scenario.stem_radius, abs=1e-6)
    assert summary["energy_lost"] > scenario.mass * GRAVITY * (solution.q_end[2] - solution.q[0, 2]) > 0.0
    assert solution.energy.residual < 1e-9


def test_jellett_stays_while_the_body_touches() -> None:
    """L . (r_1 e_z - a_1 axis) is constant up to the stem's first contact, though the axis turns, and not after it."""
    scenario, solution = _run(EXACT)
    jellett = scenario.jellett(solution.q, solution.u)
    before = solution.t < scenario.summarise(solution)["stem_down"]
    tilt = scenario.tilts(solution.q)[before]
    assert np.ptp(tilt) > 2.0
    assert np.ptp(jellett[before]) <= 1e-10 * abs(jellett[0])
    assert abs(jellett[-1] - jellett[0]) > 0.1 * abs(jellett[0])


def _independent(scenario: TippeTop, t_end: float) -> Any:
    """Integrate axis, angular momentum and velocity of the top on its large sphere by scipy, until the stem touches."""
    m, i1, i3 = scenario.mass, scenario.across, scenario.along
    a1, r1, a2, r2 = scenario.body_offset, scenario.body_radius, scenario.stem_offset, scenario.stem_radius
    law = scenario.friction_law()
    up = np.array([0.0, 0.0, 1.0])

    def turning(axis: Any, momentum: Any) -> Any:
        return momentum / i1 + (1.0 / i3 - 1.0 / i1) * (momentum @ axis) * axis

    def slip(y: Any) -> Any:
        axis, momentum, velocity = y[:3], y[3:6], y[6:8]
        omega = turning(axis, momentum)
        # the height follows from the contact: z = r_1 - a_1 axis_z
        full = np.array([*velocity, -a1 * np.cross(omega, axis)[2]])
        return (full + np.cross(omega, a1 * axis - r1 * up))[:2]

    def slope(t: float, y: Any) -> Any:
        axis, momentum = y[:3], y[3:6]
        omega, v = turning(axis, momentum), slip(y)
        speed = math.hypot(*v)
        friction = np.array([*(-law.coefficient(speed, **law.parameters()) * v / speed), 0.0])
        per_newton = np.cross(a1 * axis - r1 * up, up + friction)

        def vertical(normal: float) -> float:
            """Return z'' of the mass centre under this normal force, from the axis' second derivative."""
            moment = normal * per_newton
            rate = np.cross(omega, axis)
            spin = (1.0 / i3 - 1.0 / i1) * ((moment @ axis + momentum @ rate) * axis + (momentum @ axis) * rate)
            return float(-a1 * (np.cross(moment / i1 + spin, axis) + np.cross(omega, rate))[2])

        free, slant = vertical(0.0), vertical(1.0) - vertical(0.0)
        normal = (GRAVITY + free) / (1.0 / m - slant)
        return np.concatenate([np.cross(omega, axis), normal * per_newton, normal * friction[:2] / m])

    def stem(t: float, y: Any) -> float:
        return float((r1 - a1 * y[2]) + a2 * y[2] - r2)

    stem.terminal = True  # type: ignore[attr-defined]
    axis = np.array([0.0, -math.sin(scenario.tilt), math.cos(scenario.tilt)])
    start = np.concatenate([axis, i3 * scenario.spin * axis, np.zeros(2)])
    return solve_ivp(slope, (0.0, t_end), start, method="DOP853", events=stem, rtol=1e-10, atol=1e-13)


@pytest.mark.slow
def test_against_an_independent_integration() -> None:
    """Axis, momentum and time of the stem's first contact agree to 1e-6 with other coordinates and another solver."""
    scenario, solution = _run(EXACT, t_end=2.0)
    done = _independent(scenario, 2.0)
    down = scenario.summarise(solution)["stem_down"]
    assert down == pytest.approx(float(done.t_events[0][0]), abs=1e-6)
    event = int(np.flatnonzero(solution.events.time == down)[0])
    q, u = solution.events.q[event : event + 1], solution.events.u_before[event : event + 1]
    np.testing.assert_allclose(scenario.axes(q)[0], done.y[:3, -1], rtol=0, atol=1e-5)
    scale = scenario.along * scenario.spin
    np.testing.assert_allclose(scenario.momentum(q, u)[0] / scale, done.y[3:6, -1] / scale, rtol=0, atol=1e-5)


def test_friction_at_a_point_does_not_turn_it() -> None:
    """The sphere stops slipping within 40 ms; then it rolls, loses nothing more, and stays within its first tilt."""
    scenario, solution = _run(EXACT, contact_radius=0.0)
    assert solution.events.causes() == ["start", "slip to stick"]
    assert solution.events.time[1] < 0.04
    summary = scenario.summarise(solution)
    assert not summary["inverted"]
    assert np.max(scenario.tilts(solution.q)) <= scenario.tilt + 1e-9
    rolling = solution.t > solution.events.time[1]
    assert np.max(scenario.slips(solution.q, solution.u)[rolling, 0]) < 1e-8
    spin = solution.u[rolling]
    kinetic = 0.5 * scenario.mass * np.sum(spin[:, :3] ** 2, axis=1) + 0.5 * (
        scenario.across * np.sum(spin[:, 3:5] ** 2, axis=1) + scenario.along * spin[:, 5] ** 2
    )
    energy = kinetic + scenario.mass * GRAVITY * solution.q[rolling, 2]
    assert np.ptp(energy) <= 1e-9 * energy[0]


@pytest.mark.slow
def test_a_smaller_disc_takes_longer() -> None:
    """Towards friction at a point the time to turn over grows without bound, as one over the radius."""
    times = []
    for radius in (20e-6, 10e-6, 5e-6):
        scenario, solution = _run(contact_radius=radius, t_end=4.0)
        times.append(scenario.summarise(solution)["stem_down"])
    assert times[0] < times[1] < times[2]
    # a part that does not depend on the radius, and one that goes with its inverse
    slopes = np.diff(times) / np.diff([1 / 20.0, 1 / 10.0, 1 / 5.0])
    assert slopes[1] == pytest.approx(slopes[0], rel=0.05)


@pytest.mark.parametrize(("spin", "turns"), [(20.0, False), (180.0, True)])
def test_a_slow_top_stays_upright(spin: float, turns: bool) -> None:
    """Either way round, the fast top turns over and the slow one does not."""
    for sense in (-1.0, 1.0):
        scenario, solution = _run(spin=sense * spin, t_end=4.0)
        assert (np.max(scenario.tilts(solution.q)) > 3.0) == turns
        assert (np.max(scenario.tilts(solution.q)) < 0.2) == (not turns)


def test_mirrored_spin_mirrors_the_motion() -> None:
    """The other sense of spin gives the same tilt at all times."""
    tilts = []
    for sense in (-1.0, 1.0):
        scenario, solution = _run(EXACT, spin=sense * 180.0, t_end=1.0)
        tilts.append(scenario.tilts(solution.q))
    np.testing.assert_allclose(tilts[0], tilts[1], rtol=0, atol=1e-8)


def test_without_friction_nothing_turns() -> None:
    """The vertical momentum and the spin about the axis stay, and the mass centre over its place."""
    scenario, solution = _run(EXACT, friction=0.0, t_end=1.0)
    momentum = scenario.momentum(solution.q, solution.u)
    assert np.ptp(momentum[:, 2]) <= 1e-9 * momentum[0, 2]
    assert np.ptp(solution.u[:, 5]) <= 1e-9 * scenario.spin
    assert np.max(np.abs(solution.q[:, :2])) < 1e-12


def test_the_friction_law() -> None:
    """Its slope at rest is that of a Hertzian disc, integrated over the disc by rings; its limit is mu."""
    mu, radius, omega = 0.3, 0.5e-3, 180.0
    law = SpinningCoulomb(mu, 8.0 / (3.0 * math.pi) * radius * omega)
    angles = np.linspace(0.0, 2.0 * math.pi, 400, endpoint=False)
    nodes, weights = np.polynomial.legendre.leggauss(200)
    # r = R sin(s) takes the pressure's root at the edge away
    s = math.pi / 4.0 * (nodes + 1.0)
    r = radius * np.sin(s)[:, None]
    pressure = 1.5 * np.cos(s) ** 2 * np.sin(s) * math.pi / 4.0 * weights
    for speed, tolerance in ((1e-4, 2e-3), (100.0, 2e-3)):
        vx, vy = speed - omega * r * np.sin(angles), omega * r * np.cos(angles)
        force = mu * float(np.sum(2.0 * pressure[:, None] * vx / np.hypot(vx, vy)) / len(angles))
        coefficient = law.coefficient(speed, **law.parameters())
        assert coefficient == pytest.approx(force, rel=tolerance)
        assert law.is_fulfilled((speed, 0.0), 2.0, (-2.0 * coefficient, 0.0), 1e-12)
        assert not law.is_fulfilled((speed, 0.0), 2.0, (-2.0 * mu * 1.01, 0.0), 1e-12)


def test_wrong_input() -> None:
    """It must start on its body."""
    with pytest.raises(ns.InvalidInput) as caught:
        TippeTop(tilt=2.6)
    for word in ("TippeTop.tilt", "large sphere", "2.6"):
        assert word in str(caught.value)
