"""Whole runs with every shape, against closed forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import Ball, Box, Capsule, Cylinder, Disc, Ellipsoid, Plate, Rest, Sphere
from bodies.shapes.frustum import LEAST
from nonsmooth.engine.memory.modes import CAUSES
from nonsmooth.interfaces import Body, Shape
from tests.bodies.carriers import Carrier, Stand

GRAVITY = 9.81


def _block(x: float, y: float, z: float, mass: float = 1.0) -> Carrier:
    third = mass / 3.0
    return Carrier((Box(x, y, z),), mass, (third * (y * y + z * z), third * (x * x + z * z), third * (x * x + y * y)))


@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_a_box_dropped_flat_comes_to_rest_flat(build: Any, restitution: float) -> None:
    """Four vertices strike at once, again and again, and then hold."""
    box = _block(0.03, 0.02, 0.01)
    system = build.over(box, restitution=restitution, friction=0.3)
    system.place(box, position=(0.0, 0.0, 0.011))
    solution = ns.simulate(system, 0.3)
    np.testing.assert_allclose(solution.q_end, [0.0, 0.0, 0.01, 1.0, 0.0, 0.0, 0.0], rtol=0, atol=1e-11)
    np.testing.assert_allclose(solution.u_end, 0.0, rtol=0, atol=1e-10)
    assert solution.energy.residual <= 1e-8
    assert build.lived(solution)[0] == "{01010101,00000000,00000000}"


@pytest.mark.parametrize("excess", [-0.01, 0.01])
def test_a_block_on_a_slope_tips_at_its_own_angle(build: Any, excess: float) -> None:
    """It tips if the tangent of the slope exceeds width over height."""
    width, height = 0.01, 0.03
    slope = math.atan((1.0 + excess) * width / height)
    box = _block(width, 0.02, height)
    system = build.over(box, Rest(slope), friction=1.0)
    system.place(
        box,
        position=(height * math.sin(slope), 0.0, height * math.cos(slope)),
        orientation=(math.cos(slope / 2.0), 0.0, math.sin(slope / 2.0), 0.0),
    )
    solution = ns.simulate(system, 0.2)
    turning = solution.u_end[4]
    assert turning > 1e-3 if excess > 0.0 else abs(turning) < 1e-9
    assert solution.energy.residual <= 1e-8


@pytest.mark.parametrize(
    "shape",
    [Capsule(0.01, 0.03, axis_x=1.0, axis_z=0.0), Cylinder(0.01, 0.03, axis_x=1.0, axis_z=0.0), Sphere(0.01)],
    ids=lambda shape: type(shape).__name__,
)
def test_what_rolls_keeps_rolling(build: Any, shape: Shape) -> None:
    """At its speed, straight on, upon one line."""
    radius, speed = 0.01, 0.2
    body = Carrier((shape,), 1.0, (0.5 * radius**2, 5e-4, 5e-4))
    system = build.over(body, friction=0.3)
    turning = (-speed / radius, 0.0, 0.0)
    system.place(body, position=(0.0, 0.0, radius), velocity=(0.0, speed, 0.0), angular_velocity=turning)
    solution = ns.simulate(system, 1.0)
    np.testing.assert_allclose(solution.q_end[:3], [0.0, speed, radius], rtol=0, atol=1e-11)
    np.testing.assert_allclose(solution.u_end, [0.0, speed, 0.0, *turning], rtol=0, atol=1e-10)
    assert len(build.lived(solution)) == 1
    assert solution.energy.residual <= 1e-10


@pytest.mark.slow
@pytest.mark.parametrize(
    "shape", [Disc(0.05), Cylinder(0.05, 0.01, z=0.01 - LEAST * 0.05)], ids=["disc", "rim of a cylinder"]
)
@pytest.mark.parametrize(("tilt", "precession"), [(1.0, 8.0), (0.6, 20.0)])
def test_steady_rolling_in_a_circle(build: Any, shape: Shape, tilt: float, precession: float) -> None:
    """A disc inclined by the tilt rolls on its rim in a circle.  That of a cylinder is set back by the least feet.

    With the moments A across and C along the axis, spin s along the axis and precession P about the vertical, the
    angular momentum about the centre turns with P under the moment of the contact force:
    P sin (A P cos - C s) = m R (R s P sin + g cos).
    """
    radius, mass = 0.05, 0.2
    along, across = 0.5 * mass * radius**2, 0.25 * mass * radius**2
    s, c = math.sin(tilt), math.cos(tilt)
    spin = (across * precession**2 * s * c - mass * radius * GRAVITY * c) / (
        precession * s * (along + mass * radius**2)
    )
    axis, up = np.array([s, 0.0, c]), np.array([-c, 0.0, s])
    velocity = radius * spin * np.cross(axis, up)
    orientation = np.array([math.cos(tilt / 2.0), 0.0, math.sin(tilt / 2.0), 0.0])
    omega = Rotation.from_quat(np.roll(orientation, -1)).inv().apply(spin * axis + precession * s * up)
    body = Carrier((shape,), mass, (across, across, along))
    system = build.over(body, friction=1.5)
    system.place(body, position=(0, 0, radius * s), orientation=orientation, velocity=velocity, angular_velocity=omega)
    solution = ns.simulate(system, 1.0, engine=ns.EventDriven(tolerance=1e-11))
    assert len(build.lived(solution)) == 1
    assert solution.energy.residual <= 1e-9
    center = np.cross([0.0, 0.0, 1.0], velocity) / precession
    for t, q in zip(solution.t, solution.q, strict=True):
        turn = Rotation.from_rotvec([0.0, 0.0, precession * t])
        np.testing.assert_allclose(q[:3], center - turn.apply(center) + [0, 0, radius * s], rtol=0, atol=1e-9)
        found = Rotation.from_quat(np.roll(q[3:], -1)).apply([0.0, 0.0, 1.0])
        np.testing.assert_allclose(found, turn.apply(axis), rtol=0, atol=1e-8)


def test_an_ellipsoid_rocks_at_its_frequency(build: Any) -> None:
    """Small rolling about the rest position: omega^2 = m g (a^2 / c - c) / (I + m c^2)."""
    a, b, c = 0.03, 0.02, 0.01
    inertia = (a * a + c * c) / 5.0
    body = Carrier((Ellipsoid(a, b, c),), 1.0, ((b * b + c * c) / 5.0, inertia, (a * a + b * b) / 5.0))
    tilt = 1e-4
    system = build.over(body, friction=1.0)
    height = math.hypot(a * math.sin(tilt), c * math.cos(tilt))
    system.place(body, position=(0.0, 0.0, height), orientation=(math.cos(tilt / 2.0), 0.0, math.sin(tilt / 2.0), 0.0))
    period = 2.0 * math.pi / math.sqrt(GRAVITY * (a * a / c - c) / (inertia + c * c))
    solution = ns.simulate(system, 2.25 * period, engine=ns.EventDriven(tolerance=1e-11))
    angle = 2.0 * solution.q_end[5]
    assert abs(angle) < 1e-5 * tilt
    rate = tilt * 2.0 * math.pi / period
    assert solution.u_end[4] == pytest.approx(-rate, rel=1e-5)


R, r, START = 0.05, 0.02, 0.1
LEVEL = {"axis_x": 1.0, "axis_z": 0.0}
CONVEX: dict[str, tuple[Shape, tuple[float, float], tuple[float, float], float]] = {
    "edge of a box": (Box(0.1, 0.1, R, z=-R), (START, 0.01), (1.0, 0.0), r),
    "vertex of a box": (Box(0.1, 0.1, R, z=-R), (START, START), (math.sqrt(0.5), math.sqrt(0.5)), r),
    "rim of a cylinder": (Cylinder(0.1, R, z=-R), (0.06, 0.08), (0.6, 0.8), r),
    "rim of a disc": (Disc(0.1), (0.06, 0.08), (0.6, 0.8), r),
    "side of a cylinder": (Cylinder(R, 0.2, z=-R, **LEVEL), (0.02, 0.0), (0.0, 1.0), R + r),
    "side of a capsule": (Capsule(R, 0.2, z=-R, **LEVEL), (0.02, 0.0), (0.0, 1.0), R + r),
    "end of a capsule": (Capsule(R, 0.1, z=-R, **LEVEL), (START, 0.0), (1.0, 0.0), R + r),
    "sphere": (Sphere(R, z=-R), (0.0, 0.0), (0.6, 0.8), R + r),
}


def _leaves(body: Body, stand: Stand, start: Any, build: Any, velocity: Any) -> Any:
    system = ns.System([stand, body])
    system.contact(stand, body, **build.laws(friction=0.0))
    system.place(body, position=start, velocity=velocity)
    solution = ns.simulate(system, 0.6, engine=ns.EventDriven(tolerance=1e-11))
    events = solution.events
    left = events.q[events.cause == CAUSES.index("lift-off")]
    assert len(left) >= 1
    assert solution.energy.residual <= 1e-9
    return left[0]


@pytest.mark.parametrize("name", CONVEX)
@pytest.mark.parametrize("speed", [0.05, 0.3])
def test_a_ball_slides_over_and_leaves(build: Any, name: str, speed: float) -> None:
    """Without friction, on a circle of radius D, the force ends where cos = (2 + v^2 / (g D)) / 3."""
    shape, (x, y), (along, across), size = CONVEX[name]
    # a little before the circle begins; what comes before it is level
    back = 0.0 if size == R + r and name != "end of a capsule" else 1e-3
    start = (x - back * along, y - back * across, r)
    q = _leaves(Ball(r), Stand((shape,)), start, build, (speed * along, speed * across, 0.0))
    cosine = (q[2] - (r - size)) / size
    assert cosine == pytest.approx((2.0 + speed**2 / (GRAVITY * size)) / 3.0, abs=1e-8)
    sine = ((q[0] - x) * along + (q[1] - y) * across) / size
    assert math.hypot(cosine, sine) == pytest.approx(1.0, abs=1e-9)


def test_a_capsule_slides_over_a_parallel_one_and_leaves(build: Any) -> None:
    """The contact stays in the middle of the overlap, and nothing tilts."""
    stand = Stand((Capsule(R, 0.2, z=-R, **LEVEL),))
    body = Carrier((Capsule(r, 0.1, **LEVEL),), 1.0, (2e-4, 3e-3, 3e-3))
    speed, size = 0.1, R + r
    q = _leaves(body, stand, (0.0, 0.0, r), build, (0.0, speed, 0.0))
    assert (q[2] + R) / size == pytest.approx((2.0 + speed**2 / (GRAVITY * size)) / 3.0, abs=1e-8)
    np.testing.assert_allclose(q[3:], [1.0, 0.0, 0.0, 0.0], rtol=0, atol=1e-9)


def test_a_ball_rolls_off_a_box_that_stands_on_a_plate(build: Any) -> None:
    """Over the edge, down to the plate, where it bounces and rolls on; the energy account closes, the box stays."""
    radius = 0.02
    plate, box, ball = Plate(), _block(0.1, 0.1, 0.05, mass=5.0), Ball(radius)
    system = ns.System([plate, box, ball])
    laws = build.laws(restitution=0.3, friction=0.4)
    for pair in ((box, ball), (plate, box), (plate, ball)):
        system.contact(*pair, **laws)
    system.place(box, position=(0.0, 0.0, 0.05))
    system.place(
        ball,
        position=(0.09, 0.01, 0.1 + radius),
        velocity=(0.1, 0.03, 0.0),
        angular_velocity=(-0.03 / radius, 0.1 / radius, 0.0),
    )
    solution = ns.simulate(system, 0.6)
    assert solution.energy.residual <= 1e-8
    np.testing.assert_allclose(solution.q_end[:3], [0.0, 0.0, 0.05], rtol=0, atol=1e-6)
    assert solution.q_end[7] > 0.1 + radius
    assert solution.q_end[9] == pytest.approx(radius, abs=1e-3)
