"""Contacts that come to the end of a face go on at its edge and its vertices, whatever the size of the bodies."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import nonsmooth as ns
from bodies import Ball, BoxBody, DrivenBody, Plate, Rest
from bodies.shapes.box import Box
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral

GRAVITY = 9.81
WAY = 0.05
"""From where the ball starts to the edge, in radii."""


@settings(max_examples=25)
@given(
    size=st.sampled_from([1e-3, 1e-2, 1.0, 1e2]),
    speed=st.floats(0.2, 0.6),
    heading=st.floats(0.1, 1.2),
    on_edge=st.floats(0.05, 0.5),
)
@pytest.mark.parametrize("rough", [True, False])
@pytest.mark.filterwarnings("ignore:.*usual range")
def test_from_face_to_edge_to_vertex(rough: bool, size: float, speed: float, heading: float, on_edge: float) -> None:
    """Rolling or smooth, neither lift-off nor impact: two changes of feature, and each brings its curvature's force.

    The centre turns about the edge by its speed v across it, so that the edge bears v^2 / r less than the face, and
    the vertex w^2 / r less than that by the speed w along the edge.
    """
    radius, time = size, math.sqrt(size / GRAVITY)
    half = 5.0 * radius
    ball, table = Ball(radius, density=3000.0), DrivenBody(Rest(), (Box(half, half, half),))
    system = ns.System([table, ball], GRAVITY)
    friction = Coulomb(0.9) if rough else Frictionless()
    system.contact(table, ball, normal=Unilateral(), friction=friction, impact=EnergeticImpact(0.5))
    across, along = speed * radius / time * math.cos(heading), speed * radius / time * math.sin(heading)
    edge = WAY * radius / across
    vertex = edge + on_edge * time
    system.place(
        ball,
        position=(half - WAY * radius, half - along * vertex, half + radius),
        velocity=(across, along, 0.0),
        angular_velocity=(-along / radius, across / radius, 0.0) if rough else (0.0, 0.0, 0.0),
    )
    solution = ns.simulate(system, vertex + 0.1 * time, engine=ns.EventDriven(tolerance=1e-12))
    events = solution.events
    found = [i for i, cause in enumerate(events.causes()) if cause == "change of feature"]
    # what rolls turns about the edge by 5/7 of its weight, so that its spin about the vertical takes it along a little
    assert events.time[found] == pytest.approx([edge, vertex], rel=2e-2 if rough else 1e-9)
    assert events.causes() == ["start", "change of feature", "change of feature"]
    assert np.max(np.abs(events.u_after - events.u_before)) < 1e-6 * speed * radius / time
    assert solution.counters.impacts == 0
    np.testing.assert_array_equal(events.after[found], events.before[found])
    moment = 1e-7 * time
    times = np.array([t + side * moment for t in events.time[found] for side in (-1.0, 1.0)])
    before, on, last, after = np.sum(solution.history("normal_force", times=times)["normal_force"], axis=1)
    weight = ball.total_mass * GRAVITY
    w = solution.at(events.time[found[1]])["u"][1]
    assert before == pytest.approx(weight, rel=1e-9)
    assert before - on == pytest.approx(ball.total_mass * across**2 / radius, abs=1e-6 * weight)
    assert last - after == pytest.approx(ball.total_mass * w**2 / radius, abs=1e-6 * weight)


@pytest.mark.parametrize("size", [1e-2, 1.0, 1e2])
@pytest.mark.parametrize("friction", [0.0, 0.1])
@pytest.mark.parametrize("yaw", [0.0, 0.3])
@pytest.mark.filterwarnings("ignore:.*usual range")
def test_a_box_slides_past_an_edge_as_if_there_were_none(size: float, friction: float, yaw: float) -> None:
    """Its corners leave the face and crossings of edges bear it: mu g slows it down all the way, and nothing else."""
    box, table = BoxBody(0.2 * size, 0.15 * size, 0.1 * size), DrivenBody(Rest(), (Box(size, size, size),))
    system = ns.System([table, box], GRAVITY)
    rub = Coulomb(friction) if friction > 0.0 else Frictionless()
    system.contact(table, box, normal=Unilateral(), friction=rub, impact=EnergeticImpact(0.3))
    speed = 1.5 * math.sqrt(size)
    system.place(
        box,
        position=(0.85 * size, 0.03 * size, 1.1 * size),
        orientation=(math.cos(0.5 * yaw), 0.0, 0.0, math.sin(0.5 * yaw)),
        velocity=(speed, 0.0, 0.0),
    )
    # friction presses forward: the box tips where its centre is mu times its height before the edge
    seconds = 0.12 * size / speed
    solution = ns.simulate(system, seconds)
    assert {*solution.events.causes()} <= {"start", "end of a feature"}
    assert solution.counters.impacts == 0
    left = np.array([speed - friction * GRAVITY * seconds, 0.0, 0.0, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(solution.u_end * [1.0, 1.0, 1.0, size, size, size], left, rtol=0, atol=1e-7 * speed)


def test_a_ball_slides_over_the_line_where_two_plates_meet() -> None:
    """The plates are nearly one: neither stops the ball, though it touches both for a while."""
    lean, speed, radius = 1e-5, 5e-4, 0.01
    plates = [Plate(), Plate(Rest(orientation=(math.cos(0.5 * lean), 0.0, -math.sin(0.5 * lean), 0.0)))]
    ball = Ball(radius)
    system = ns.System([*plates, ball], GRAVITY)
    for plate in plates:
        system.contact(plate, ball, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(0.5))
    system.place(ball, position=(0.0, 0.0, radius), velocity=(speed, 0.0, 0.0))
    assert ns.simulate(system, 1e-3).u_end[0] == pytest.approx(speed, rel=0.02)


@pytest.mark.parametrize("shift", [(0.05, 0.0), (0.0499, 0.0), (0.0501, 0.0), (0.05, 1e-3)], ids=str)
def test_a_box_tips_over_an_equal_one(shift: tuple[float, float]) -> None:
    """Its lower face meets two corners at once: one opens as the other one still closes."""
    plate, lower, upper = Plate(), *(BoxBody(0.05, 0.04, 0.02) for _ in range(2))
    system = ns.System((plate, lower, upper))
    for pair in itertools.combinations((plate, lower, upper), 2):
        system.contact(*pair, normal=Unilateral(), friction=Coulomb(0.4), impact=EnergeticImpact(0.6))
    system.place(lower, position=(0.0, 0.0, 0.022))
    system.place(upper, position=(*shift, 0.064))
    solution = ns.simulate(system, 0.2)
    assert solution.status == "done", solution.message
