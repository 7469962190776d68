"""A ball that a slowly turning force drags along at the bound of friction: slip that creeps, its direction stiff.

Its slip s obeys s' = F / m - 7/2 mu g s / |s|, whose direction relaxes at 7/2 mu g / |s|, up to 1e9 times a second.
"""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import nonsmooth as ns
from bodies import Ball, EllipsoidBody, FunctionLoad, Plate
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.memory.modes import Cause
from tests.runs.continued import lost_by_stopping

MU, GRAVITY, RADIUS = 0.3, 9.81, 0.01
BOUND = 3.5 * MU * GRAVITY
"""The force per mass at which a ball begins to slip [m/s^2]."""
RATE, TURN = 10.0, 7.0
PART, SLIP = 1e-3, 5e-4
"""By what part the force passes its bound, in turn above and below, and the first slip [m/s]."""


def _turning(
    t: float, a: Any, b: Any, out: Any, level: float, part: float, rate: float, turn: float, ahead: float
) -> None:
    size = level * (1.0 + part * math.cos(rate * t))
    for i in range(9):
        out[i] = b[i - 3] if 3 <= i < 6 else 0.0
    out[0], out[1] = size * math.cos(turn * t + ahead), size * math.sin(turn * t + ahead)


def _model(tolerance: float, part: float, slip: float, ahead: float = 0.0, n_far: int = 0) -> tuple[ns.Model, Ball]:
    ground, ball, *far = Plate(), *(Ball(radius=RADIUS, density=1000.0) for _ in range(1 + n_far))
    system = ns.System([ground, ball, *far], GRAVITY)
    for one, other in itertools.combinations(system.bodies, 2):
        system.contact(one, other, normal=Unilateral(), friction=Coulomb(MU), impact=EnergeticImpact(0.5))
    for i, body in enumerate(far):
        system.place(body, position=(1.0 + 0.1 * i, 0.0, 1.0), velocity=(0.0, 20.0, 0.0))
    velocity = slip * math.cos(ahead), slip * math.sin(ahead), 0.0
    system.place(ball, position=(0.0, 0.0, RADIUS), velocity=velocity)
    constants = {"level": BOUND * ball.total_mass, "part": part, "rate": RATE, "turn": TURN, "ahead": ahead}
    system.load(FunctionLoad(_turning, constants), ground, ball)
    return ns.assemble(system, ns.EventDriven(tolerance=tolerance)), ball


def _by_scipy(part: float, start: Any, first: float, last: float, stops: bool) -> Any:
    """Integrate speed and direction of the slip, velocity and place of the centre; ``stops`` ends it with the slip."""

    def slope(t: float, y: Any) -> list[float]:
        speed, angle, vx, vy = y[:4]
        force, rub = BOUND * (1.0 + part * math.cos(RATE * t)), MU * GRAVITY
        lag = TURN * t - angle
        across = force * math.sin(lag) / speed
        ax, ay = force * math.cos(TURN * t) - rub * math.cos(angle), force * math.sin(TURN * t) - rub * math.sin(angle)
        return [force * math.cos(lag) - BOUND, across, ax, ay, vx, vy]

    def slip(t: float, y: Any) -> float:
        return float(y[0] - 1e-12)

    slip.terminal = True  # type: ignore[attr-defined]
    tolerances = {"rtol": 1e-10, "atol": [1e-14, 1e-11, *[1e-12] * 4]}
    return solve_ivp(slope, (first, last), start, method="Radau", events=slip if stops else None, **tolerances)


def test_creeping_stopping_and_breaking_away() -> None:
    """Event by event as by scipy, in steps a thousandth as many as explicit ones need."""
    solution = _model(1e-8, PART, SLIP)[0].run(0.8)
    assert solution.counters.steps < 2000
    events = solution.events
    assert events.cause.tolist() == [Cause.START, Cause.SLIP_TO_STICK, Cause.STICK_TO_SLIP]
    creeps = _by_scipy(PART, [SLIP, 0.0, SLIP, 0.0, 0.0, 0.0], 0.0, 0.8, True)
    stop, breaks = creeps.t[-1], 1.5 * math.pi / RATE
    slowing = BOUND * PART * abs(math.cos(RATE * stop))
    # so slow a slip stops when its error says
    assert abs(events.time[1] - stop) * slowing < 5e-6
    assert events.time[2] == pytest.approx(breaks, abs=1e-7)
    # a ball that rolls has 5/7 of the force for its centre
    drag, u = 5.0 / 7.0 * BOUND, creeps.y[2:4, -1]
    angles, ends = TURN * np.array([stop, breaks]), (stop, breaks)
    around = np.array([np.sin(angles), -np.cos(angles)])
    roll = solve_ivp(
        lambda t, y: [drag * (1.0 + PART * math.cos(RATE * t)) * f(TURN * t) for f in (math.cos, math.sin)],
        ends, u, method="DOP853", rtol=1e-12, atol=1e-14,
    )  # fmt: skip
    np.testing.assert_allclose(roll.y[:, -1] - u, drag / TURN * (around[:, 1] - around[:, 0]), rtol=5e-3)
    later = 1e-4
    angle, speed = TURN * (breaks + later), 0.5 * BOUND * PART * RATE * later**2
    u = roll.y[:, -1] + later * drag * np.array([math.cos(angle), math.sin(angle)])
    end = _by_scipy(PART, [speed, angle, *u, 0.0, 0.0], breaks + later, 0.8, False).y[:, -1]
    np.testing.assert_allclose(solution.u_end[:2], end[2:4], rtol=0.0, atol=1e-6)


def test_balls_that_fly_by_far_away_do_not_disturb_a_slip_that_creeps() -> None:
    """They make the list of near contacts change again and again: the slip stays stiff, and its motion the same."""
    ends, t_end = [], 0.003
    for n in (0, 11):
        model, ball = _model(1e-8, PART, 0.01 * SLIP, n_far=n)
        solution = model.run(t_end)
        # explicit steps, as short as the direction of the slip relaxes, are more than 500
        assert solution.counters.steps < 200
        ends.append(solution.of(ball)[1][-1])
    np.testing.assert_allclose(ends[1], ends[0], rtol=0.0, atol=1e-6)


def test_the_order_of_implicit_steps() -> None:
    """Ten times the tolerance are ten times the error and 10^(1/4) times the step, to the work and the energy, too."""
    exact = _by_scipy(2e-6, [1e-4, 0.0, 1e-4, 0.0, 0.0, 0.0], 0.0, 0.6, False).y[2:, -1]
    steps, errors = [], []
    for tolerance in (1e-6, 1e-7, 1e-8, 1e-9):
        solution = _model(tolerance, 2e-6, 1e-4)[0].run(0.6)
        assert solution.energy.residual < 3.0 * tolerance
        assert solution.energy.friction_loss > 0.0
        steps.append(solution.counters.steps)
        errors.append(np.max(np.abs(np.r_[solution.u_end[:2], solution.q_end[:2]] - exact)))
    assert steps[-1] < 2000
    assert errors[-1] < 1e-7
    order = -np.diff(np.log(errors)) / np.diff(np.log(steps))
    np.testing.assert_allclose(order, 4.0, atol=0.3)


def test_a_creeping_run_is_cut_looked_into_and_turned() -> None:
    """Cut within implicit steps it goes on to the last bit; between samples and turned by 1 rad it is the same."""
    model, ball = _model(1e-8, PART, SLIP)
    whole = model.run(0.8, sample_interval=0.05)
    for t in (0.123, 0.471, 0.6):
        before = model.run(t, sample_interval=0.05)
        assert lost_by_stopping(whole, before, model.run(0.8, start=before.state, sample_interval=0.05)) == []
    fine = model.run(0.3, sample_interval=0.013)
    np.testing.assert_allclose(whole.at(fine.t)["u"][:, :2], fine.u[:, :2], rtol=0.0, atol=1e-6)
    # the run's end divides a step as a sample does
    ends = np.array([model.run(t).u_end[:2] for t in fine.t[1:]])
    np.testing.assert_allclose(ends, fine.u[1:, :2], rtol=0.0, atol=5e-8)
    friction = whole.history("friction_force", times=[0.123, 0.3, 0.7])["friction_force"][:, 0]
    np.testing.assert_allclose(np.hypot(*friction.T[:2]), MU * ball.total_mass * GRAVITY, rtol=1e-9)
    turned = _model(1e-8, PART, SLIP, ahead=1.0)[0].run(0.8, sample_interval=0.05)
    np.testing.assert_allclose(turned.events.time, whole.events.time, rtol=0.0, atol=6e-4)
    c, s = math.cos(1.0), math.sin(1.0)
    np.testing.assert_allclose(turned.u[:, :2], whole.u[:, :2] @ np.array([[c, s], [-s, c]]), rtol=0.0, atol=1e-6)


def test_the_instant_of_a_stop_hangs_on_no_tolerance() -> None:
    """Of an ellipsoid, whose slip turns as it slows down, far better than the tolerance of velocities would have it."""
    stops = []
    for tolerance in (1e-12, 1e-13):
        ground, body = Plate(), EllipsoidBody(8e-3, 14e-3, 11e-3)
        system = ns.System([ground, body], GRAVITY)
        system.contact(ground, body, normal=Unilateral(), friction=Coulomb(MU), impact=EnergeticImpact(0.6))
        system.place(
            body, position=(0.0, 0.0, 0.03), orientation=(0.5, 0.5, 0.5, 0.5), angular_velocity=(3.0, 2.0, 1.0)
        )
        events = ns.simulate(system, 0.3, engine=ns.EventDriven(tolerance=tolerance)).events
        stops.append(events.time[events.cause == Cause.SLIP_TO_STICK])
    assert len(stops[0]) == 2
    np.testing.assert_allclose(stops[0], stops[1], rtol=0.0, atol=2e-10)
