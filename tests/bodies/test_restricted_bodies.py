"""Bodies in a plane and on a line: as free bodies that happen to stay there."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import Ball, Harmonic, LineBody, PlanarBody, Plane, Plate, RigidBody, Sphere

numbers = st.floats(-2.0, 2.0)
vectors = st.tuples(numbers, numbers, numbers).map(np.array)
SHAPES = (Sphere(0.01, x=-0.03), Sphere(0.01, x=0.03, z=0.005))


def _written(body: Any, size: int, q: Any, u: Any, gravity: Any) -> Any:
    out = np.zeros(size)
    pulls = dict(zip(("gravity_x", "gravity_y", "gravity_z"), np.asarray(gravity).tolist(), strict=True))
    body.evaluator(0.0, q, u, out, **{**body.parameters(), **pulls})
    return out


@given(q=vectors, u=vectors, gravity=vectors)
def test_planar_block_is_that_of_a_free_body(q: Any, u: Any, gravity: Any) -> None:
    """Frame, Jacobian, force, inverse mass and energy are those of the free body in its plane, without the rest."""
    planar, free = PlanarBody(2.0, 0.03, SHAPES, y=0.4), RigidBody(2.0, (0.02, 0.03, 0.025), SHAPES)
    one = _written(planar, 59, q, u, gravity)
    half = 0.5 * q[2]
    start = np.array([q[0], 0.4, q[1], math.cos(half), 0.0, math.sin(half), 0.0])
    columns = [0, 2, 4]
    rates = np.zeros(6)
    rates[columns] = u
    other = _written(free, 111, start, rates, gravity)
    same: dict[str, Any] = {"rtol": 0, "atol": 1e-12}
    np.testing.assert_allclose(one[:24], other[:24], **same)
    np.testing.assert_allclose(one[24:42].reshape(6, 3), other[24:60].reshape(6, 6)[:, columns], **same)
    np.testing.assert_array_equal(one[42:45], u)
    np.testing.assert_allclose(one[45:48], other[67:73][columns], **same)
    np.testing.assert_allclose(one[48:57].reshape(3, 3), other[73:109].reshape(6, 6)[np.ix_(columns, columns)], **same)
    np.testing.assert_allclose(one[57:], other[109:], **same)


@given(direction=vectors.filter(lambda v: np.linalg.norm(v) > 0.1), s=numbers, rate=numbers, gravity=vectors)
def test_line_block_is_newton_along_the_line(direction: Any, s: float, rate: float, gravity: Any) -> None:
    """Frame on the line, force by projection, energies of the mass."""
    along = direction / np.linalg.norm(direction)
    turn = np.array([0.8, 0.0, 0.0, 0.6])
    body = LineBody(3.0, tuple(along), SHAPES, (0.1, 0.2, 0.3), tuple(turn))
    out = _written(body, 35, np.array([s]), np.array([rate]), gravity)
    place = np.array([0.1, 0.2, 0.3]) + s * along
    same: dict[str, Any] = {"rtol": 0, "atol": 1e-12}
    np.testing.assert_allclose(out[:3], place, **same)
    np.testing.assert_allclose(out[3:12].reshape(3, 3), Rotation.from_quat(np.roll(turn, -1)).as_matrix(), **same)
    np.testing.assert_allclose(out[12:15], rate * along, **same)
    np.testing.assert_array_equal(out[15:24], 0.0)
    np.testing.assert_allclose(out[24:30], [*along, 0.0, 0.0, 0.0], **same)
    expected = [rate, 3.0 * gravity @ along, 1.0 / 3.0, 1.5 * rate * rate, -3.0 * gravity @ place]
    np.testing.assert_allclose(out[30:], expected, **same)


@pytest.mark.parametrize("friction", [0.0, 0.15])
def test_a_planar_body_moves_as_the_free_one(build: Any, friction: float) -> None:
    """Two balls on a vibrating plate, tilted, sliding and spinning: flights, impacts of one and both, sticking."""
    tilt, ends, events = 0.3, [], []
    for body in (PlanarBody(0.1, 6e-5, SHAPES), RigidBody(0.1, (4e-5, 6e-5, 5e-5), SHAPES)):
        planar = body.n_u == 3
        system = build.over(body, Harmonic(amplitude=1e-3, frequency=20.0), friction=friction, restitution=0.6)
        start: dict[str, Any] = (
            {"angle": tilt, "velocity": (0.2, 0.0), "angular_velocity": 3.0}
            if planar
            else {
                "orientation": (math.cos(tilt / 2), 0.0, math.sin(tilt / 2), 0.0),
                "velocity": (0.2, 0.0, 0.0),
                "angular_velocity": (0.0, 3.0, 0.0),
            }
        )
        ns.at_height(system, body, 0.002, **start)
        solution = ns.simulate(system, 0.25, engine=ns.EventDriven(tolerance=1e-11, impact_tolerance=1e-11))
        assert solution.energy.residual <= 1e-7
        q = solution.q_end
        ends.append(q if planar else [q[0], q[2], 2.0 * math.atan2(q[5], q[3])])
        events.append(solution.events.time)
    assert len(events[0]) == len(events[1]) > 5
    np.testing.assert_allclose(events[0], events[1], rtol=0, atol=1e-7)
    np.testing.assert_allclose(ends[0], ends[1], rtol=0, atol=1e-6)


def test_a_planar_ball_rolls() -> None:
    """Sliding with v it ends rolling at 5/7 v, the law of the plane having nothing to say across it."""
    from laws import Coulomb, EnergeticImpact, Unilateral

    ball, plate = PlanarBody(0.2, 0.4 * 0.2 * 1e-4, (Sphere(0.01),)), Plate()
    system = ns.System([plate, ball])
    system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(0.2), impact=EnergeticImpact(0.5))
    ns.touching(system, ball, velocity=(0.7, 0.0))
    solution = ns.simulate(system, 0.5)
    np.testing.assert_allclose(solution.u_end, [0.5, 0.0, 50.0], rtol=1e-9, atol=1e-9)
    assert solution.events.time[-1] == pytest.approx(2.0 * 0.7 / (7.0 * 0.2 * 9.81), abs=1e-9)


def test_on_a_vertical_line_a_body_bounces_as_a_ball(build: Any) -> None:
    """The guide takes no part: the same times, the same heights, down to rest."""
    ends = []
    ball = Ball(0.01)
    for body in (ball, LineBody(ball.total_mass, carried=(Sphere(0.01),))):
        system = build.over(body, friction=0.2, restitution=0.5)
        ns.at_height(system, body, 0.02)
        solution = ns.simulate(system, 0.3)
        ends.append((solution.events.time, solution.q_end[2 if body is ball else 0]))
    assert ends[0][0] == pytest.approx(ends[1][0], abs=1e-12)
    assert ends[0][1] == pytest.approx(ends[1][1], abs=1e-12)


def test_an_inclined_line_falls_slower() -> None:
    """Distance g sin(angle) t^2 / 2, with the energy kept."""
    angle, t = 0.5, 0.4
    body = LineBody(1.0, (math.cos(angle), 0.0, -math.sin(angle)))
    system = ns.System([body])
    system.place(body, position=0.1, velocity=0.2)
    solution = ns.simulate(system, t)
    assert solution.q_end[0] == pytest.approx(0.1 + 0.2 * t + 0.5 * 9.81 * math.sin(angle) * t * t, abs=1e-12)
    assert solution.energy.residual <= 1e-9


BAD: list[tuple[Any, tuple[str, ...]]] = [
    (lambda: PlanarBody(0.0, 1.0), ("PlanarBody.mass", "> 0")),
    (lambda: PlanarBody(1.0, -1.0), ("PlanarBody.moment", "> 0", "kg m^2")),
    (lambda: PlanarBody(1.0, 1.0, Plane()), ("PlanarBody.carried", "tuple of shapes")),  # type: ignore[arg-type]
    (lambda: PlanarBody(1.0, 1.0).state(position=(0, 0, 1)), ("position of PlanarBody", "2 finite numbers", "[m]")),
    (lambda: PlanarBody(1.0, 1.0).state(angle=(1, 2)), ("angle of PlanarBody", "must be a finite number", "[rad]")),
    (lambda: PlanarBody(1.0, 1.0).state(angle=math.nan), ("angle of PlanarBody", "nan")),
    (lambda: PlanarBody(1.0, 1.0).state(orientation=1.0), ("start of PlanarBody", "orientation", "position")),
    (lambda: LineBody(-1.0), ("LineBody.mass", "> 0", "-1.0")),
    (lambda: LineBody(1.0, (0.0, 0.0, 0.0)), ("LineBody.direction", "have a direction", "not zero")),
    (lambda: LineBody(1.0, orientation=(1, 1, 0, 0)), ("LineBody.orientation", "unit quaternion")),
    (lambda: LineBody(1.0, origin=(1.0,)), ("LineBody.origin", "3 finite numbers")),  # type: ignore[arg-type]
    (lambda: LineBody(1.0, carried=(1,)), ("LineBody.carried", "shapes only")),  # type: ignore[arg-type]
    (lambda: LineBody(1.0).state(position=(0, 0, 1)), ("position of LineBody", "must be a finite number", "[m]")),
    (lambda: LineBody(1.0).state(velocity="fast"), ("velocity of LineBody", "finite number", "fast")),
    (lambda: LineBody(1.0).state(angle=0.0), ("start of LineBody", "angle")),
]


@pytest.mark.parametrize(("make", "words"), BAD)
def test_bad_input(make: Any, words: tuple[str, ...]) -> None:
    """The message names the thing, the rule and the value."""
    with pytest.raises(ns.InvalidInput) as caught:
        make()
    for word in words:
        assert word in str(caught.value)
