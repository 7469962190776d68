"""Bodies in generalised coordinates: against other bodies and closed forms, and every contradiction refused."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import nonsmooth as ns
from bodies import Coordinate, Dumbbell, GeneralisedBody, Plate, Point, PointFrame, Sphere, TurningFrame
from nonsmooth.binding.call import body_caller
from nonsmooth.compiled import compiled
from nonsmooth.solution.modes import mode_shares
from nonsmooth.types import Floats
from tests.bodies.planar_functions import (
    END,
    PART,
    end_bias,
    end_jacobian,
    end_position,
    gyroscopic,
    no_bias,
    no_power,
    part_jacobian,
    part_pose,
    planar,
    rigid_mass,
    weight_potential,
)

GRAVITY = 9.81


@pytest.mark.slow
@pytest.mark.parametrize(("tilt", "slip", "friction"), [(0.3, 0.4, 0.2), (-0.2, -1.0, 0.6)])
def test_a_turning_frame_moves_as_the_free_body(build: Any, tilt: float, slip: float, friction: float) -> None:
    """A dumbbell in its three planar coordinates falls, hits, slides and sticks as the spatial one does."""
    spatial = Dumbbell()
    q = (0.0, 0.02, tilt)
    frame = TurningFrame(part_pose, part_jacobian, no_bias, spatial.shapes)
    flat = planar([frame], spatial.total_mass, spatial.inertia[1], q, (slip, 0.0, 2.0))
    one, two = (
        build.over(spatial, friction=friction, restitution=0.3),
        build.over(flat, friction=friction, restitution=0.3),
    )
    # the free body turns about -y where the angle runs from x to z
    start = {"position": (0, 0, 0.02), "orientation": (math.cos(tilt / 2), 0, -math.sin(tilt / 2), 0)}
    one.place(spatial, **start, velocity=(slip, 0, 0), angular_velocity=(0, -2.0, 0))
    first, second = (ns.simulate(system, 0.3) for system in (one, two))
    assert len(first.events) == len(second.events) > 6
    np.testing.assert_allclose(second.events.time, first.events.time, rtol=0, atol=2e-8)
    np.testing.assert_allclose(second.q[:, :2], first.q[:, [0, 2]], rtol=0, atol=1e-8)
    np.testing.assert_allclose(second.u[-1], [*first.u[-1, [0, 2]], -first.u[-1, 4]], rtol=0, atol=1e-5)
    assert second.energy.residual < 1e-8


@pytest.mark.slow
def test_a_vertex_slides_without_friction(build: Any) -> None:
    """A rod slips down on its tip: one equation for its angle, by scipy, through the second-order term of a vertex."""
    half, weight, inertia, tilt = 0.5, 2.0, 0.1, 1.2
    frame = PointFrame(end_position, end_jacobian, end_bias, (Point(),))
    rod = planar([frame], weight, inertia, (0.0, half * math.sin(tilt), math.pi + tilt), half=half)
    system = build.over(rod, friction=0.0)
    solution = ns.simulate(system, 0.3, engine=ns.EventDriven(tolerance=1e-11))

    def slope(t: float, y: Any) -> Any:
        s, c = math.sin(y[0]), math.cos(y[0])
        return [
            y[1],
            (-weight * GRAVITY * half * c + weight * half**2 * s * c * y[1] ** 2)
            / (inertia + weight * (half * c) ** 2),
        ]

    done = solve_ivp(slope, (0.0, 0.3), [tilt, 0.0], method="DOP853", rtol=1e-12, atol=1e-13)
    assert solution.q_end[2] - math.pi == pytest.approx(done.y[0, -1], abs=1e-9)
    assert solution.u_end[2] == pytest.approx(done.y[1, -1], abs=1e-8)
    assert abs(solution.q_end[0]) < 1e-12
    assert mode_shares(solution) == {"{1,0,1}": 1.0}


# an oscillator of one coordinate with a damper


def _unit(q: Floats, out: Floats, weight: float) -> None:
    out[0] = weight


def _damped(t: float, q: Floats, u: Floats, out: Floats, spring: float, damper: float) -> None:
    out[0] = -spring * q[0] - damper * u[0]


def _spring_energy(q: Floats, spring: float) -> float:
    return 0.5 * spring * q[0] * q[0]


def _damper_power(t: float, q: Floats, u: Floats, damper: float) -> float:
    return -damper * u[0] * u[0]


@pytest.mark.slow
def test_the_work_of_a_damper() -> None:
    """It is the last coordinate, comes off the potential energy and closes the account; the motion is known."""
    weight, spring, damper = 2.0, 50.0, 3.0
    body = GeneralisedBody(
        (Coordinate("x", "m", 0.1),),
        _unit,
        _damped,
        _spring_energy,
        power=_damper_power,
        constants={"weight": weight, "spring": spring, "damper": damper},
    )
    solution = ns.simulate(ns.System([body]), 1.0, engine=ns.EventDriven(tolerance=1e-11))
    decay, omega = damper / (2.0 * weight), math.sqrt(spring / weight - (damper / (2.0 * weight)) ** 2)
    exact = (
        0.1 * np.exp(-decay * solution.t) * (np.cos(omega * solution.t) + decay / omega * np.sin(omega * solution.t))
    )
    np.testing.assert_allclose(solution.q[:, 0], exact, rtol=0, atol=1e-10)
    energy = 0.5 * spring * solution.q[:, 0] ** 2 + 0.5 * weight * solution.u[:, 0] ** 2
    np.testing.assert_allclose(solution.q[:, 1], energy - 0.5 * spring * 0.01, rtol=0, atol=1e-10)
    assert solution.energy.residual < 1e-9


# any mass matrix


def _given_mass(q: Floats, out: Floats, entries: Floats) -> None:
    for i in range(16):
        out[i] = entries[i]


def _no_force(t: float, q: Floats, u: Floats, out: Floats) -> None:
    pass


def _level(q: Floats) -> float:
    return 0.0


def _any(entries: Any) -> GeneralisedBody:
    coordinates = tuple(Coordinate(f"q_{i}", "m", rate=1.0) for i in range(4))
    return GeneralisedBody(coordinates, _given_mass, _no_force, _level, constants={"entries": tuple(entries)})


@pytest.mark.slow
@settings(max_examples=30)
@given(st.lists(st.floats(-1.0, 1.0), min_size=16, max_size=16), st.floats(1e-3, 1e3))
def test_mass_is_inverted(numbers: list[float], scale: float) -> None:
    """The output block holds M^-1 and u . M u / 2, whatever stood there before."""
    root = np.array(numbers).reshape(4, 4)
    matrix = scale * (root @ root.T + 0.1 * np.eye(4))
    body = _any(matrix.ravel())
    q, u = body.state(u=(1.0, -2.0, 0.5, 3.0))
    out = np.full(4 + 4 + 16 + 2, 7.0)
    body_caller(body.evaluator, body.parameters(), "test")(0.0, q, u, out)
    np.testing.assert_allclose(out[8:24].reshape(4, 4) @ matrix, np.eye(4), atol=1e-9)
    assert out[24] == pytest.approx(0.5 * u @ matrix @ u)
    np.testing.assert_array_equal(out[:8], [*u, 0, 0, 0, 0])


@pytest.mark.parametrize(
    ("matrix", "words"),
    [
        (np.eye(4) + 1e-9 * np.eye(4, k=1), ("mass: _given_mass", "symmetric", "M[j n + i]")),
        (np.diag([1.0, 1.0, -1.0, 1.0]), ("mass: _given_mass", "positive definite")),
        (np.ones((4, 4)), ("mass: _given_mass", "positive definite", "inertia")),
        (np.full((4, 4), math.inf), ("constants['entries']", "finite")),
    ],
)
def test_masses_that_are_none(matrix: Any, words: tuple[str, ...]) -> None:
    """Not symmetric, indefinite, singular, infinite."""
    with pytest.raises(ns.InvalidInput) as caught:
        ns.System([_any(matrix.ravel())])
    for word in words:
        assert word in str(caught.value)


def test_a_mass_that_degenerates_on_the_way_stops_the_run() -> None:
    """What can only be seen in the run ends it with a reason, not with numbers made up."""

    def mass(q: Floats, out: Floats) -> None:
        out[0] = 1.0 - q[0]

    def force(t: float, q: Floats, u: Floats, out: Floats) -> None:
        out[0] = 0.5 * u[0] * u[0] + 1.0

    def potential(q: Floats) -> float:
        return -q[0]

    body = GeneralisedBody((Coordinate("x", "m", 0.0, 0.5),), mass, force, potential)
    with pytest.raises(ns.RunFailed):
        ns.simulate(ns.System([body]), 10.0)


def test_starts() -> None:
    """Words, shapes, numbers; frames refuse what is no shape."""
    rod = planar([PointFrame(**END)], 1.0, 1.0, half=0.5)
    with pytest.raises(ns.UnknownName, match="start of GeneralisedBody"):
        rod.state(position=(0, 0, 0))
    with pytest.raises(ns.InvalidInput, match="q of GeneralisedBody must be 3 finite numbers"):
        rod.state(q=(0, 0))
    q, u = rod.state(q=(1, 2, 3), u=(4, 5, 6))
    np.testing.assert_array_equal([q, u], [[1, 2, 3], [4, 5, 6]])
    with pytest.raises(ns.InvalidInput, match=r"PointFrame\.carried must contain shapes only"):
        PointFrame(**END, carried=(3.0,))  # type: ignore[arg-type]


def test_forces_that_do_no_work_need_a_power_that_says_so() -> None:
    """A gyroscopic force is no mistake where the power is given as zero: the path is a circle."""
    coordinates = Coordinate("x", "m", rate=1.0), Coordinate("z", "m"), Coordinate("a", "rad")
    body = GeneralisedBody(
        coordinates, rigid_mass, gyroscopic, weight_potential, power=no_power, constants={"weight": 1.0, "inertia": 1.0}
    )
    solution = ns.simulate(ns.System([body], gravity=0.0), 2.0)
    np.testing.assert_allclose(solution.q[:, 0], np.sin(solution.t), rtol=0, atol=1e-7)
    np.testing.assert_allclose(solution.q[:, 1], np.cos(solution.t) - 1.0, rtol=0, atol=1e-7)


@compiled
def _square(x: float) -> float:
    return x * x


def _quartic(q: Floats, stiffness: float) -> float:
    return float(0.25 * stiffness * _square(_square(q[0])))


def _cubic(t: float, q: Floats, u: Floats, out: Floats, stiffness: float) -> None:
    out[0] = -stiffness * q[0] * _square(q[0])


def test_functions_may_share_a_compiled_helper() -> None:
    """And keep the energy of an anharmonic oscillator."""
    constants = {"weight": 1.0, "stiffness": 4.0}
    body = GeneralisedBody((Coordinate("x", "m", 1.0),), _unit, _cubic, _quartic, constants=constants)
    solution = ns.simulate(ns.System([body]), 5.0)
    energy = solution.q[:, 0] ** 4 + 0.5 * solution.u[:, 0] ** 2
    np.testing.assert_allclose(energy, 1.0, rtol=0, atol=1e-7)


def test_equal_bodies_share_what_is_compiled() -> None:
    """The evaluator is one function, whatever the constants, starts and shapes."""
    bodies = [planar([PointFrame(**END, carried=shapes)], m, 1.0, half=0.5) for m, shapes in ((1, ()), (2, (Point(),)))]
    assert bodies[0].evaluator is bodies[1].evaluator
    other: Callable[..., None] = planar([PointFrame(**PART)], 1.0, 1.0).evaluator
    assert other is not bodies[0].evaluator


def test_a_point_and_a_small_sphere_agree(build: Any) -> None:
    """As the radius goes to zero, the vertex is its limit."""

    def end(shape: Any) -> ns.Solution:
        rod = planar([PointFrame(**END, carried=(shape,))], 1.0, 0.05, (0, 0.6, 4.0), (0.3, 0, 1.0), half=0.5)
        return ns.simulate(build.over(rod, friction=0.1), 0.6)

    sharp, round_ = end(Point()), end(Sphere(1e-7))
    assert sharp.events.causes() == round_.events.causes()
    assert len(sharp.events) > 3
    np.testing.assert_allclose(sharp.q_end, round_.q_end, rtol=0, atol=1e-5)


def test_a_plane_carries_the_vertex_pair_either_way(build: Any) -> None:
    """The plate is first, whatever the order."""
    rod, plate = planar([PointFrame(**END, carried=(Point(),))], 1.0, 1.0, half=0.5), Plate()
    system = ns.System([rod, plate])
    (contact,) = system.contact(rod, plate, **build.laws())
    assert contact.first is plate
    assert contact.kinematics.features == ("plane-vertex",)
