"""Bodies that stick to one at rest by a single contact go on past events elsewhere, as if there were none."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Plate, Rest
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral

RADIUS, GRAVITY, FRICTION = 0.01, 9.81, 0.5
LAWS: dict[str, Any] = {"normal": Unilateral(), "friction": Coulomb(FRICTION), "impact": EnergeticImpact(0.9)}
HEIGHT, FAR = 1e-3, 10.0
"""Of a ball above its floor, so that it bounces many times within a tenth of a second, or not at all [m]."""


def _beside(height: float, rolling: list[tuple[float, float]], slope: float = 0.0) -> tuple[ns.System, list[Ball]]:
    """Return balls on a slope, by place and speed, that roll, and one at a height above a floor of its own."""
    turned = math.cos(0.5 * slope), 0.0, math.sin(0.5 * slope), 0.0
    ground, floor = Plate(Rest(orientation=turned)), Plate(Rest(position=(0.0, 0.0, -FAR)))
    balls = [Ball(RADIUS) for _ in range(len(rolling) + 1)]
    system = ns.System([ground, floor, *balls], GRAVITY)
    along, up = np.array([math.cos(slope), 0.0, -math.sin(slope)]), np.array([math.sin(slope), 0.0, math.cos(slope)])
    for ball, (place, speed) in zip(balls, rolling, strict=False):
        system.contact(ground, ball, **LAWS)
        spin = 0.0, speed / RADIUS, 0.0
        system.place(ball, position=RADIUS * up + place * along, velocity=speed * along, angular_velocity=spin)
    system.contact(floor, balls[-1], **LAWS)
    system.place(balls[-1], position=(FAR, 0.0, RADIUS - FAR + height))
    return system, balls[:-1]


@pytest.mark.parametrize("slope", [0.0, 0.2])
def test_what_happens_elsewhere_changes_no_bit(slope: float) -> None:
    """Balls roll beside one that bounces as beside one that flies, and as the closed form says."""
    rolling = [(0.0, 0.3), (1.0, -0.2)]
    runs = []
    for height in (HEIGHT, 0.5 * FAR):
        system, balls = _beside(height, rolling, slope)
        runs.append((ns.simulate(system, 0.2, sample_interval=0.01), balls))
    (disturbed, balls), (quiet, others) = runs
    assert disturbed.counters.impacts >= 8
    assert quiet.counters.impacts == 0
    assert disturbed.energy.residual < 1e-9
    for ball, other, (place, speed) in zip(balls, others, rolling, strict=True):
        (q, u), (q_quiet, u_quiet) = disturbed.of(ball), quiet.of(other)
        np.testing.assert_array_equal(q, q_quiet)
        np.testing.assert_array_equal(u, u_quiet)
        t, fall = disturbed.t, 5.0 / 7.0 * GRAVITY * math.sin(slope)
        gone = place + speed * t + 0.5 * fall * t**2
        np.testing.assert_allclose(q[:, 0], RADIUS * math.sin(slope) + gone * math.cos(slope), rtol=0.0, atol=1e-9)
        np.testing.assert_allclose(u[:, 4], (speed + fall * t) / RADIUS, rtol=0.0, atol=1e-6)
        half = 0.5 * (gone - place) / RADIUS
        np.testing.assert_allclose(q[:, [3, 5]], np.stack([np.cos(half), np.sin(half)], 1), rtol=0.0, atol=1e-7)


def test_a_course_ends_where_something_strikes() -> None:
    """A ball that rolls strikes one at rest: they exchange velocities, slide, and roll on at 2/7 and 5/7 of it."""
    speed, way = 0.3, 0.01
    system, (striker, struck) = _beside(HEIGHT, [(0.0, speed), (2.0 * RADIUS + way, 0.0)])
    system.contact(striker, struck, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(1.0))
    solution = ns.simulate(system, 0.2)
    struck_at = solution.events.time[solution.events.contact == 3]
    np.testing.assert_allclose(struck_at, [way / speed], rtol=0.0, atol=1e-11)
    for ball, part in ((striker, 2.0 / 7.0), (struck, 5.0 / 7.0)):
        _, u = solution.of(ball)
        assert u[-1, 0] == pytest.approx(part * speed, rel=1e-8)
        assert u[-1, 4] == pytest.approx(part * speed / RADIUS, rel=1e-8)
    assert solution.energy.residual < 1e-9


@pytest.mark.parametrize("cut", [0.0301, 0.0457, 0.11])
def test_a_run_that_is_cut_within_a_course_goes_on_to_the_last_bit(cut: float) -> None:
    """A state holds where the courses of its bodies began, and when they end."""
    system, _ = _beside(HEIGHT, [(0.0, 0.3), (1.0, -0.2)], 0.2)
    model = ns.assemble(system)
    whole = model.run(0.2, sample_interval=0.05)
    half = model.run(cut, sample_interval=0.05)
    again = model.run(0.2, start=half.state, sample_interval=0.05)
    np.testing.assert_array_equal(again.q_end, whole.q_end)
    np.testing.assert_array_equal(again.u_end, whole.u_end)
    n = len(again.events) - 1
    np.testing.assert_array_equal(again.events.time[1:], whole.events.time[-n:])
