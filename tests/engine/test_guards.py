"""What fires, when, and what does not: the written semantics of events."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, BoxBody, Dumbbell, Harmonic, Plate, Rest
from nonsmooth.engine.memory.modes import Cause, word
from nonsmooth.solution.modes import mode_shares

G = 9.81


@pytest.mark.parametrize("depth", [-1e-9, -1e-6, 1e-9, 1e-6, 1e-3])
def test_a_dip_within_a_step_is_found(build: Any, depth: float) -> None:
    """A plate at 25 Hz under a hovering ball: it hits iff its top is higher, however briefly, and at that time."""
    ball, frequency, amplitude = Ball(0.01), 25.0, 1e-3
    system = build.over(ball, Harmonic(amplitude=amplitude, frequency=frequency), gravity=0.0, friction=0.0)
    system.place(ball, position=(0, 0, 0.01 + amplitude * (1.0 - depth)))
    solution = ns.simulate(system, 0.03)
    if depth < 0.0:
        assert solution.events.causes() == ["start"]
    else:
        assert solution.events.causes()[:2] == ["start", "impact"]
        expected = math.asin(1.0 - depth) / (2.0 * math.pi * frequency)
        # a grazing root is as sharp as the gap's rounding allows
        assert solution.events.time[1] == pytest.approx(expected, abs=1e-10)


@pytest.mark.parametrize("drift", [0.02, 0.05])
def test_a_dip_under_a_passing_ball_is_found(build: Any, drift: float) -> None:
    """Many quiet periods before the ball has come down to the plate's top: the first touch is not missed."""
    ball, frequency, amplitude = Ball(0.01), 25.0, 1e-3
    omega = 2.0 * math.pi * frequency
    system = build.over(ball, Harmonic(amplitude=amplitude, frequency=frequency), gravity=0.0, friction=0.0)
    system.place(ball, position=(0, 0, 0.02), velocity=(0.3, 0, -drift))
    solution = ns.simulate(system, 0.7, sample_interval=0.7)
    times = np.linspace(0.0, 0.7, 4_000_001)
    gaps = 0.01 - drift * times - amplitude * np.sin(omega * times)
    first = times[np.argmax(gaps < 0.0)]
    assert solution.events.time[1] == pytest.approx(first, abs=2e-7)


def test_a_zero_at_the_start_does_not_fire(build: Any) -> None:
    """A ball that starts on the plate and rises is in flight, not in an impact; it fires when it comes back."""
    ball = Ball(0.01)
    system = build.over(ball, friction=0.0)
    system.place(ball, position=(0, 0, 0.01), velocity=(0, 0, 0.5))
    solution = ns.simulate(system, 0.11)
    assert solution.events.causes() == ["start", "impact"]
    assert solution.events.words("after")[0] == "{0,0,0}"
    assert solution.events.time[1] == pytest.approx(1.0 / G, abs=1e-12)


def test_a_gap_at_rest_beside_contacts_that_hold_does_not_fire(build: Any) -> None:
    """A tall block slides and turns on three of its feet: the gap under the fourth is zero, and drifts as theirs do."""
    block = BoxBody(0.01, 0.01, 0.017, density=1200.0, rounding=1e-3)
    system = build.over(block, friction=0.5, restitution=0.5)
    speed = 0.5 * math.sqrt(0.5)
    system.place(block, position=(0, 0, 0.017), velocity=(speed, speed, 0), angular_velocity=(0, 0, 2.0))
    solution = ns.simulate(system, 0.1)
    closed = solution.events.after[-1] > 0
    assert np.count_nonzero(closed) < 4
    assert "event" not in solution.counters.limits


def test_a_zero_at_the_end_fires(build: Any) -> None:
    """The interval is half open: an event at the end time belongs to the run, one just behind it does not."""
    ball = Ball(0.01)
    fall = math.sqrt(2.0 * 0.05 / G)
    for t_end, count in ((fall + 1e-9, 1), (fall - 1e-9, 0)):
        system = build.over(ball, friction=0.0)
        system.place(ball, position=(0, 0, 0.06))
        assert ns.simulate(system, t_end).events.count(Cause.IMPACT) == count


def test_starting_in_an_impact(build: Any) -> None:
    """Touching and approaching at t = 0 is an impact at t = 0."""
    ball = Ball(0.01)
    system = build.over(ball, friction=0.0, restitution=0.5)
    system.place(ball, position=(0, 0, 0.01), velocity=(0, 0, -1.0))
    solution = ns.simulate(system, 0.01)
    assert solution.events.time[0] == 0.0
    assert "impact" in solution.events.causes()
    assert solution.events.u_after[-1, 2] == pytest.approx(0.5, abs=1e-12)


def test_simultaneous_impacts_are_one_event(build: Any) -> None:
    """Two balls dropped from one height hit in one event {11,11,..}; with heights apart there are two."""
    for apart, words in ((0.0, ["{11,11,00}"]), (1e-6, ["{01,01,00}", "{10,10,00}"])):
        first, second, plate = Ball(0.01), Ball(0.02), Plate(Rest())
        system = ns.System([plate, first, second], G)
        for ball in (first, second):
            system.contact(plate, ball, **build.laws(restitution=0.5))
        system.place(first, position=(0, 0, 0.06))
        system.place(second, position=(1, 0, 0.07 + apart))
        solution = ns.simulate(system, 0.12)
        impacts = np.flatnonzero(solution.events.cause == Cause.IMPACT)
        assert [solution.events.words("during")[i] for i in impacts] == words


def test_flat_dumbbell_hits_with_both_balls(build: Any) -> None:
    """A flat fall is one double impact, and stays flat."""
    body = Dumbbell()
    system = build.over(body, restitution=0.5)
    system.place(body, position=(0, 0, body.radius + 0.01))
    solution = ns.simulate(system, 0.05)
    assert solution.events.words("during")[1] == "{11,11,00}"
    np.testing.assert_allclose(solution.u_end[3:], 0.0, rtol=0, atol=1e-12)
    np.testing.assert_allclose(solution.events.impulse[1, 0], solution.events.impulse[1, 1], rtol=1e-12, atol=1e-18)


@pytest.mark.parametrize(("tilt", "expected"), [(0.2, "{01,00,"), (-0.2, "{10,00,")])
def test_mode_word_puts_contact_1_rightmost(build: Any, tilt: float, expected: str) -> None:
    """Ball 1 down is {01,..}, ball 2 down {10,..}."""
    body = Dumbbell()
    system = build.over(body, restitution=0.0)
    z1 = body.radius + max(0.0, -body.centre_distance * math.sin(tilt))
    system.place(body, **build.paper_start(body, (0, 0, z1, 0, tilt, 0), np.zeros(6)))
    solution = ns.simulate(system, 0.01)
    assert solution.events.words("after")[0].startswith(expected)
    assert mode_shares(solution)[build.lived(solution)[0]] == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("a", "b", "c", "expected"),
    [([1], [0], [1], "{1,0,1}"), ([1, 0, 1], [0, 0, 1], [1, 0, 0], "{101,100,001}"), ([], [], [], "{,,}")],
)
def test_word_of_any_number_of_contacts(a: Any, b: Any, c: Any, expected: str) -> None:
    """The notation of Eq. (29) for n contacts."""
    assert word(a, b, c) == expected


def test_tilted_ball_falls_like_a_pendulum_until_it_hits(build: Any) -> None:
    """The time from tilt to impact of a dumbbell on a frictionless plate, from energy, to 1e-9 s."""
    from scipy.integrate import quad

    body, tilt = Dumbbell(), 0.5
    system = build.over(body, friction=0.0, restitution=0.0)
    system.place(body, **build.paper_start(body, (0, 0, body.radius, 0, tilt, 0), np.zeros(6)))
    solution = ns.simulate(system, 0.2, engine=ns.EventDriven(tolerance=1e-12))
    half, m, j = body.centre_distance / 2.0, body.total_mass, body.inertia[1]

    def slowness(s: float) -> float:
        beta = tilt * (1.0 - s * s)
        drop = 2.0 * m * G * half * (math.sin(tilt) - math.sin(beta))
        rate = math.sqrt(drop / (j + m * half**2 * math.cos(beta) ** 2)) if drop > 0.0 else math.inf
        return 2.0 * tilt * s / rate

    expected = quad(slowness, 1e-9, 1.0, epsabs=1e-13, epsrel=1e-12)[0]
    hit = solution.events.time[solution.events.cause == Cause.IMPACT][0]
    assert hit == pytest.approx(expected, abs=1e-9)
