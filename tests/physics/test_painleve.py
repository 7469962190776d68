"""Painleve's paradox with a tilted sliding dumbbell: an impact without collision, and the run goes on."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import nonsmooth as ns
from bodies import Dumbbell
from nonsmooth.engine.memory.modes import Cause
from tests.engine.plain_cases import jamming

BODY = Dumbbell(rod_mass_fraction=0.9)
GRAVITY = 9.81
TILT = math.radians(45.0)


def _critical(tilt: float) -> float:
    """Friction at which g_nn - mu g_nt vanishes for ball 1 sliding ahead of the mass centre."""
    half, across = BODY.centre_distance / 2.0, BODY.inertia[1] / BODY.total_mass
    x, z = half * math.cos(tilt), half * math.sin(tilt) + BODY.radius
    return (across + x * x) / (x * z)


def _run(
    build: Any,
    friction: float,
    slip: float,
    t_end: float = 5e-3,
    rate: float = 0.0,
    restitution: float = 0.3,
    **options: Any,
) -> ns.Solution:
    body = Dumbbell(rod_mass_fraction=0.9)
    system = build.over(body, friction=friction, restitution=restitution)
    # rod along y: (x1, y1, z1, theta, beta, gamma); ball 1 slides towards -y
    start = build.paper_start(body, (0, 0, body.radius, 0.0, TILT, 0.0), (0, slip, 0, 0, rate, 0))
    system.place(body, **start)
    return ns.simulate(system, t_end, engine=ns.EventDriven(**{"tolerance": 1e-10, **options}))


@pytest.mark.parametrize("side", [-1e-3, 1e-3])
def test_both_sides_of_the_critical_friction(build: Any, side: float) -> None:
    """Below it the contact slides on, above it no force exists: an impact without collision at once.

    Below it the tilt grows until the coefficient vanishes, 74 us after the start: the run ends before that.
    """
    solution = _run(build, _critical(TILT) * (1.0 + side), -1.0, t_end=5e-3 if side > 0.0 else 5e-5)
    assert solution.status == "done"
    first = solution.events.cause[0]
    assert (first == Cause.PAINLEVE) == (side > 0.0)
    if side > 0.0:
        event = int(np.flatnonzero(solution.events.cause == Cause.PAINLEVE)[0])
        assert solution.events.causes()[event] == "impact without collision"
        assert solution.events.contact[event] == 0
        assert solution.events.impulse[event, 0, 0] > 0.0
        # it stops the slip, loses energy, and leaves the contact at least not approaching
        assert solution.events.friction_loss[event] > 0.0
    else:
        assert solution.events.words("after")[0] == "{01,00,01}"
    energy = solution.energy
    assert energy.kinetic_end + energy.potential_end < energy.kinetic_start + energy.potential_start
    assert energy.residual <= 1e-8


def _stopped_by_springs(friction: float, stiffness: float) -> tuple[float, float]:
    """Return the mass centre's velocity [m/s] when the slip stops, the plate being a spring [N/m]; planar, by scipy."""
    half, r, mass, inertia = BODY.centre_distance / 2.0, BODY.radius, BODY.total_mass, BODY.inertia[1]

    def arm(beta: float) -> tuple[float, float]:
        return -half * math.cos(beta), -half * math.sin(beta) - r

    def slope(t: float, s: Any) -> list[float]:
        y, z = arm(s[1])
        force = stiffness * max(0.0, -(s[0] + z))
        # the slip is towards -y, so that friction pushes towards +y
        turning = (y * force - z * friction * force) / inertia
        return [s[3], s[4], friction * force / mass, force / mass - GRAVITY, turning]

    def slip(t: float, s: Any) -> float:
        return float(s[2] - s[4] * arm(s[1])[1])

    slip.terminal = True  # type: ignore[attr-defined]
    # at rest on the springs
    y, z = arm(TILT)
    sunk = GRAVITY / (1.0 / mass + y * (y - friction * z) / inertia) / stiffness
    start = [-z - sunk, TILT, -1.0, 0.0, 0.0]
    done = solve_ivp(slope, (0.0, 1e-3), start, method="DOP853", events=slip, rtol=1e-8, atol=1e-14)
    assert len(done.t_events[0]) == 1
    return float(done.y[2, -1]), float(done.y[3, -1])


def test_sliding_into_the_singularity_jams(build: Any) -> None:
    """Where the normal force grows without bound the slip stops at once, as it does on ever stiffer springs."""
    friction = _critical(TILT) * 0.999
    solution = _run(build, friction, -1.0)
    events = solution.events
    event = int(np.flatnonzero(events.cause == Cause.JAM)[0])
    assert 5e-5 < events.time[event] < 1e-4
    assert events.causes()[event] == "jamming of a slip"
    normal, *tangential = events.impulse[event, 0]
    # at the singularity, sticking needs no less than the kinetic bound
    np.testing.assert_allclose(math.hypot(*tangential), friction * normal, rtol=1e-3)
    assert events.friction_loss[event] > 0.0
    assert abs(events.restitution_loss[event]) <= 1e-9 * events.friction_loss[event]
    assert solution.energy.residual <= 1e-8
    stiffnesses = [1e9, 1e12, 1e15]
    errors = [np.hypot(*(events.u_after[event, 1:3] - _stopped_by_springs(friction, k))) for k in stiffnesses]
    assert errors[0] > 3.0 * errors[1] > 9.0 * errors[2]
    assert errors[2] < 1e-4


def test_a_slip_jams_however_late_it_begins() -> None:
    """Three years after time zero, where doubles are 15 ns apart, the slip jams as it does at the start."""
    model, late = ns.assemble(jamming(0.999)), 1e8
    early, later = (model.run(t + 5e-4, start=dataclasses.replace(model.start, time=t)) for t in (0.0, late))
    times = [run.events.time[run.events.cause == Cause.JAM][0] for run in (early, later)]
    assert times[1] - late == pytest.approx(times[0], rel=0.02)


def test_the_other_way_there_is_no_paradox(build: Any) -> None:
    """Ball 1 trailing: friction lifts the normal load, whatever mu."""
    solution = _run(build, 1.5 * _critical(TILT), 1.0)
    assert solution.events.count(Cause.PAINLEVE) == 0
    assert solution.status == "done"
    assert solution.energy.residual <= 1e-8


def test_falling_into_the_paradox(build: Any) -> None:
    """Started below the critical tilt and turning up into it: the run passes the singularity and ends."""
    friction = _critical(TILT) * 1.02
    solution = _run(build, friction, -3.0, 0.05, rate=-20.0)
    assert solution.status == "done"
    assert solution.energy.residual <= 1e-8
    after = _run(build, friction, -3.0, 0.05, rate=20.0)
    assert after.status == "done"
    assert after.energy.residual <= 1e-8


def test_dissipation_over_many_starts(build: Any) -> None:
    """Whatever happens, no energy comes out of an impact without collision."""
    for factor in (1.01, 1.2, 1.5):
        for slip in (-0.05, -0.5, -4.0):
            solution = _run(build, _critical(TILT) * factor, slip)
            events = solution.events
            hit = events.cause == Cause.PAINLEVE
            assert np.any(hit)
            assert np.all(events.restitution_loss[hit] >= -1e-12)
            assert np.all(events.friction_loss[hit] >= -1e-12)
            assert solution.energy.residual <= 1e-8


def test_policies(build: Any) -> None:
    """Refused by name, where no force exists and where the slip jams; compliant: as the law does without loss."""
    friction = _critical(TILT)
    for factor, t in ((1.001, 0.0), (0.999, 7e-5)):
        with pytest.raises(ns.RunFailed, match="sliding has no contact force") as caught:
            _run(build, factor * friction, -1.0, painleve="refuse")
        solution: Any = caught.value.solution
        assert solution.t_end == pytest.approx(t, abs=1e-5)
    compliant = _run(build, 1.5 * friction, -1.0, t_end=1e-6, painleve="compliant").events
    lossless = _run(build, 1.5 * friction, -1.0, t_end=1e-6, restitution=1.0).events
    lossy = _run(build, 1.5 * friction, -1.0, t_end=1e-6).events
    np.testing.assert_allclose(compliant.u_after[0], lossless.u_after[0], rtol=1e-9, atol=1e-12)
    assert compliant.u_after[0, 2] > lossy.u_after[0, 2]
    assert compliant.causes()[0] == "impact without collision"
    with pytest.raises(ns.UnknownName, match="painleve"):
        ns.EventDriven(painleve="spring")


def test_the_jam_does_not_depend_on_the_tolerance(build: Any) -> None:
    """Sliding into the singularity where force and coefficient vanish together must not pass through it."""
    friction = _critical(TILT) * 0.98
    times = []
    for tolerance in (1e-8, 1e-9, 1e-11):
        events = _run(build, friction, -30.0, tolerance=tolerance).events
        times.append(float(events.time[events.cause == Cause.JAM][0]))
    np.testing.assert_allclose(times, times[-1], rtol=0, atol=1e-10)


@pytest.mark.parametrize("solver", ["auto", "gauss_seidel", "newton"])
def test_what_a_solver_tries_does_not_change_later_impacts(build: Any, solver: str) -> None:
    """The ball is thrown up by its turning where sliding would have no force; it comes down to an impact of its law.

    The policy "compliant" is for impacts without collision alone: this one loses energy to restitution.
    """
    friction = 1.2 * _critical(TILT)
    solution = _run(build, friction, -1.0, t_end=0.2, rate=100.0, painleve="compliant", solver=solver)
    events = solution.events
    assert Cause.PAINLEVE not in events.cause
    first = int(np.flatnonzero(events.cause == Cause.IMPACT)[0])
    assert events.restitution_loss[first] > 0.0
    other = _run(build, friction, -1.0, t_end=0.2, rate=100.0, solver="enumeration")
    assert events.restitution_loss[first] == pytest.approx(other.events.restitution_loss[first], rel=1e-9)
