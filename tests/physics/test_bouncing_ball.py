"""A ball that bounces to rest, and a ball on a sinusoidal table."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Harmonic
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.solution.modes import mode_shares

G = 9.81
RADIUS = 0.01


@pytest.mark.parametrize("restitution", [0.2, 0.5, 0.9])
def test_event_times_and_rest(build: Any, restitution: float) -> None:
    """Impacts at v0/g (1 + 2 e + 2 e^2 + ...) to 1e-10 s; at rest after (1 + e)/(1 - e) v0/g."""
    e, v0 = restitution, 1.0
    ball = Ball(RADIUS)
    system = build.over(ball, friction=0.0, restitution=e, duration=1e-7)
    system.place(ball, position=(0, 0, RADIUS + v0**2 / (2 * G)))
    rest = (1.0 + e) / (1.0 - e) * v0 / G
    solution = ns.simulate(system, rest + 0.1)
    impacts = solution.events.time[solution.events.cause == Cause.IMPACT]
    expected = v0 / G * (2.0 * np.cumsum(e ** np.arange(len(impacts))) - 1.0)
    np.testing.assert_allclose(impacts, expected, rtol=0, atol=1e-10)
    closing = solution.events.time[solution.events.cause == Cause.CLOSING]
    assert len(closing) == 1
    assert closing[0] == pytest.approx(rest, abs=2.1e-7 / (1.0 - e))
    assert solution.u_end == pytest.approx(np.zeros(6), abs=1e-15)
    assert solution.q_end[2] == pytest.approx(RADIUS, abs=1e-15)
    assert mode_shares(solution)["{1,0,0}"] == pytest.approx(0.1 / (rest + 0.1), abs=1e-6)
    assert solution.energy.residual <= 1e-9
    assert solution.energy.restitution_loss == pytest.approx(ball.total_mass * v0**2 / 2.0, rel=1e-9)


@pytest.mark.parametrize("side", [-1e-4, 1e-4])
def test_accumulation_rule(build: Any, side: float) -> None:
    """The contact closes at the first g'+ <= g T_c, Eq. (33), and not at the one before."""
    e, v0, bounces = 0.5, 1.0, 6
    ball = Ball(RADIUS)
    system = build.over(ball, friction=0.0, restitution=e, duration=v0 * e**bounces / G * (1.0 + side))
    system.place(ball, position=(0, 0, RADIUS + v0**2 / (2 * G)))
    solution = ns.simulate(system, 0.4)
    assert solution.events.count(Cause.IMPACT) == (bounces if side > 0.0 else bounces + 1)
    assert solution.events.count(Cause.CLOSING) == 1
    last = v0 * e ** (bounces if side > 0.0 else bounces + 1)
    assert solution.energy.closing_loss == pytest.approx(0.5 * ball.total_mass * last**2, rel=1e-6)
    assert solution.energy.residual <= 1e-9


def test_the_rule_uses_the_actual_relative_acceleration(build: Any) -> None:
    """On a plate that falls away at nearly g, a small bounce is no accumulation."""
    omega = 2.0 * math.pi * 5.0
    closings = []
    for phase in (math.pi / 2.0, -math.pi / 2.0):
        motion = Harmonic(amplitude=0.95 * G / omega**2, frequency=5.0, phase=phase)
        ball = Ball(RADIUS)
        system = build.over(ball, motion, friction=0.0, restitution=0.5, duration=1e-3)
        start = motion.amplitude * math.sin(phase)
        system.place(ball, position=(0, 0, RADIUS + start), velocity=(0, 0, -0.01))
        solution = ns.simulate(system, 2e-3)
        closings.append(solution.events.count(Cause.CLOSING))
    # rebound 5 mm/s against g_eff T_c of 0.5 mm/s and of 19 mm/s
    assert closings == [0, 1]


@pytest.mark.parametrize("cut_off", [2e-5, 1e-7])
def test_plastic_ball_lands_once(build: Any, cut_off: float) -> None:
    """E = 0: one impact, then contact."""
    ball = Ball(RADIUS)
    system = build.over(ball, friction=0.0, restitution=0.0, duration=cut_off)
    system.place(ball, position=(0, 0, RADIUS + 0.05))
    solution = ns.simulate(system, 0.3)
    assert solution.events.causes() == ["start", "impact"]
    assert build.lived(solution) == ["{1,0,0}", "{0,0,0}"] or build.lived(solution) == ["{0,0,0}", "{1,0,0}"]
    assert solution.events.time[1] == pytest.approx(math.sqrt(0.1 / G), abs=1e-11)


def _orbit(build: Any, gamma: float, e: float, periods: int, perturb: float = 1e-3) -> tuple[Any, float]:
    """Run from near the period-1 orbit; return the times between impacts, relative to the period."""
    frequency = 25.0
    omega = 2.0 * math.pi * frequency
    cosine = min(1.0, math.pi * (1.0 - e) / ((1.0 + e) * gamma))
    motion = Harmonic(amplitude=gamma * G / omega**2, frequency=frequency, phase=math.acos(cosine))
    ball = Ball(RADIUS)
    system = build.over(ball, motion, friction=0.0, restitution=e)
    height = motion.amplitude * math.sin(motion.phase)
    system.place(ball, position=(0, 0, RADIUS + height), velocity=(0, 0, G / (2.0 * frequency) * (1.0 + perturb)))
    solution = ns.simulate(system, periods / frequency, sample_interval=1.0)
    impacts = solution.events.time[solution.events.cause == Cause.IMPACT]
    return np.diff(impacts) * frequency, solution.energy.residual


def _bounds(e: float) -> tuple[float, float]:
    low = math.pi * (1.0 - e) / (1.0 + e)
    return low, math.sqrt(low**2 + 4.0 * (1.0 + e**2) ** 2 / (1.0 + e) ** 4)


@pytest.mark.parametrize("restitution", [0.6, 0.8])
def test_period_one_orbit_is_stable_between_its_bounds(build: Any, restitution: float) -> None:
    """Pi (1-e)/(1+e) < Gamma < sqrt([pi (1-e)/(1+e)]^2 + 4 (1+e^2)^2/(1+e)^4): inside, a disturbance dies out."""
    low, high = _bounds(restitution)
    for gamma in (1.02 * low, 0.5 * (low + high), 0.98 * high):
        intervals, residual = _orbit(build, gamma, restitution, 400)
        assert len(intervals) >= 398
        assert np.max(np.abs(intervals[-20:] - 1.0)) < 2e-4
        assert residual <= 1e-8


@pytest.mark.parametrize("restitution", [0.6, 0.8])
def test_period_one_orbit_ends_at_its_bounds(build: Any, restitution: float) -> None:
    """Above the upper bound the period doubles, below the lower one there is no such orbit."""
    low, high = _bounds(restitution)
    doubled, _ = _orbit(build, 1.02 * high, restitution, 400)
    assert np.max(np.abs(doubled[-20:] - 1.0)) > 1e-2
    np.testing.assert_allclose(doubled[-20:-2] + doubled[-19:-1], 2.0, rtol=0, atol=1e-3)
    below, _ = _orbit(build, 0.98 * low, restitution, 100, 0.0)
    assert len(below) == 0 or np.max(np.abs(below[-5:] - 1.0)) > 1e-2


def test_ball_leaves_the_table_where_it_must(build: Any) -> None:
    """Resting on the table with Gamma > 1 the ball takes off at asin(1/Gamma), to 1e-11 s."""
    gamma, frequency = 1.3, 25.0
    omega = 2.0 * math.pi * frequency
    motion = Harmonic(amplitude=gamma * G / omega**2, frequency=frequency)
    ball = Ball(RADIUS)
    system = build.over(ball, motion, friction=0.0)
    system.place(ball, position=(0, 0, RADIUS), velocity=(0, 0, motion.amplitude * omega))
    solution = ns.simulate(system, 0.012)
    assert solution.events.causes() == ["start", "lift-off"]
    assert solution.events.cause[1] == Cause.LIFT_OFF
    assert solution.events.time[1] == pytest.approx(math.asin(1.0 / gamma) / omega, abs=1e-11)
