"""Cylinders, cones and discs in motion against other bodies than planes: rest, landings, conservation."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import (
    Box,
    BoxBody,
    CapsuleBody,
    ConeBody,
    Cylinder,
    CylinderBody,
    DiscBody,
    EllipsoidBody,
    FreeBody,
    HullBody,
    Plane,
    Plate,
    Rest,
    SuperellipsoidBody,
)
from bodies.inertia import tensor_of
from bodies.shapes.frustum import LEAST
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.interfaces import Shape
from tests.bodies.carriers import Stand
from tests.bodies.polytopes import tetrahedron

UPRIGHT = (1.0, 0.0, 0.0, 0.0)
LYING = (math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0)
TABLE = Box(0.05, 0.05, 0.05, z=-0.05)
NARROW = Box(0.05, 0.01, 0.05, z=-0.05)
"""A lying cylinder is longer than it is deep."""
PILLAR = Cylinder(0.02, 0.02, z=-0.02, foot_height=2e-6)
ON_RIM = -PILLAR.foot_height
"""Height of the rims of the pillar over the tips of its feet [m]: a body that touches no foot lies at this height."""
LOW_PILLAR, LOW = Cylinder(0.02, 0.02, z=-0.02), 0.02 * LEAST
"""A pillar on feet of the least height, and this height [m]."""
LOG = Cylinder(0.02, 0.03, z=-0.02, axis_x=1.0, axis_z=0.0)
STEEP = math.atan2(0.01, 0.02)
"""Half the angle of a cone."""
ON_ITS_SIDE = (math.cos(0.25 * math.pi + 0.5 * STEEP), math.sin(0.25 * math.pi + 0.5 * STEEP), 0.0, 0.0)


def _laws(friction: Any, restitution: float) -> dict[str, Any]:
    return {"normal": Unilateral(), "friction": friction, "impact": EnergeticImpact(restitution=restitution)}


ROUND_PILLAR = replace(PILLAR, rounding=0.003)
SMOOTH_TABLE = replace(TABLE, rounding=0.005)
ROUND_CONE = ConeBody(0.01, 0.02, rounding=0.001)
(_shape,) = ROUND_CONE.shapes
ROUND_LIES = (0.02 + _shape.parameters()["z"]) * math.sin(STEEP)
"""Its mass centre is so far from the side, whose plane goes through the apex of a sharp one."""
ROUNDED = BoxBody(0.01, 0.012, 0.005, rounding=0.002)

RESTS: dict[str, tuple[Shape, FreeBody, float, tuple[float, float, float, float], int]] = {
    "a cylinder stands on a box": (TABLE, CylinderBody(0.01, 0.02), 0.02, UPRIGHT, 3),
    "a cylinder lies on a box": (TABLE, CylinderBody(0.01, 0.02), 0.01, LYING, 2),
    "a cylinder lies over the edges of a box": (NARROW, CylinderBody(0.01, 0.02), 0.01, LYING, 2),
    "a cone stands on a box": (TABLE, ConeBody(0.01, 0.02), 0.005, UPRIGHT, 3),
    "a cone lies on a box": (TABLE, ConeBody(0.01, 0.02), 0.015 * math.sin(STEEP), ON_ITS_SIDE, 2),
    "a disc lies on a box": (TABLE, DiscBody(0.01), 1e-6, UPRIGHT, 3),
    "a box stands between the feet of a cap": (LOW_PILLAR, BoxBody(0.005, 0.006, 0.005), 0.005 - LOW, UPRIGHT, 4),
    "a box larger than the cap stands on its feet": (PILLAR, BoxBody(0.03, 0.032, 0.005), 0.005, UPRIGHT, 3),
    "a capsule lies on a cap": (PILLAR, CapsuleBody(0.005, 0.012), 0.005, LYING, 2),
    "a capsule lies across a cap": (PILLAR, CapsuleBody(0.005, 0.03), 0.005, LYING, 2),
    "a cylinder stands on a cap": (PILLAR, CylinderBody(0.01, 0.02), 0.02, UPRIGHT, 3),
    "a wide cylinder stands on a cap": (PILLAR, CylinderBody(0.04, 0.02), 0.02, UPRIGHT, 3),
    "a cylinder lies on a cap": (PILLAR, CylinderBody(0.01, 0.015), 0.01 + ON_RIM, LYING, 2),
    "a cylinder lies across a cap": (PILLAR, CylinderBody(0.01, 0.04), 0.01 + ON_RIM, LYING, 2),
    "a cone stands on a cap": (PILLAR, ConeBody(0.01, 0.02), 0.005, UPRIGHT, 3),
    "a disc lies on a cap": (PILLAR, DiscBody(0.01), 1e-6, UPRIGHT, 3),
    "a rounded box stands on a cap": (Cylinder(0.02, 0.02, z=-0.02), ROUNDED, 0.005, UPRIGHT, 4),
    "a rounded beam lies across a log": (LOG, BoxBody(0.005, 0.03, 0.005, rounding=0.001), 0.005, UPRIGHT, 2),
    "a cylinder stands on a rounded box": (SMOOTH_TABLE, CylinderBody(0.01, 0.02), 0.02, UPRIGHT, 3),
    "a cylinder lies on a rounded box": (SMOOTH_TABLE, CylinderBody(0.01, 0.02), 0.01, LYING, 2),
    "a cone lies on a rounded box": (SMOOTH_TABLE, ConeBody(0.01, 0.02), 0.015 * math.sin(STEEP), ON_ITS_SIDE, 2),
    "a rounded cylinder stands on a plane": (Plane(), CylinderBody(0.01, 0.02, rounding=0.002), 0.02, UPRIGHT, 3),
    "a rounded cylinder lies on a plane": (Plane(), CylinderBody(0.01, 0.02, rounding=0.002), 0.01, LYING, 2),
    "a rounded disc lies on a plane": (Plane(), DiscBody(0.01, rounding=0.001), 0.001 + 9e-7, UPRIGHT, 3),
    "a rounded cone lies on a plane": (Plane(), ROUND_CONE, ROUND_LIES, ON_ITS_SIDE, 2),
    "a rounded cylinder stands on a box": (TABLE, CylinderBody(0.01, 0.02, rounding=0.002), 0.02, UPRIGHT, 3),
    "a rounded cylinder lies on a rounded box": (
        SMOOTH_TABLE,
        CylinderBody(0.01, 0.02, rounding=0.002),
        0.01,
        LYING,
        2,
    ),
    "a rounded cylinder stands on a rounded cap": (
        ROUND_PILLAR,
        CylinderBody(0.01, 0.02, rounding=0.002),
        0.02,
        UPRIGHT,
        3,
    ),
    "a box stands on a rounded cap": (ROUND_PILLAR, BoxBody(0.01, 0.006, 0.005), 0.005 + ON_RIM, UPRIGHT, 4),
    "a rounded cylinder lies on a cap": (
        PILLAR,
        CylinderBody(0.01, 0.015, rounding=0.002),
        0.01 + ON_RIM,
        LYING,
        2,
    ),
    "a beam lies across a log": (LOG, BoxBody(0.005, 0.03, 0.005), 0.005, UPRIGHT, 2),
    "a boxy body lies on a cap": (PILLAR, SuperellipsoidBody(0.01, 0.012, 0.008, 0.4, 0.6), 0.008, UPRIGHT, 1),
}
"""Shape of the support, body, height of its origin over the support, orientation, contacts that hold it."""


@pytest.mark.fast_cases(12)
@pytest.mark.parametrize("name", RESTS)
def test_it_rests(name: str) -> None:
    """On as many contacts as belong to line or face; nothing moves and nothing happens."""
    shape, body, height, orientation, points = RESTS[name]
    stand = Stand((shape,))
    system = ns.System([stand, body])
    system.contact(stand, body, **_laws(Coulomb(0.3), 0.3))
    system.place(body, position=(0.001, 0.0 if shape is LOG else 0.0012, height), orientation=orientation)
    solution = ns.simulate(system, 0.2)
    assert solution.status == "done"
    assert np.count_nonzero(solution.events.after[-1]) == points
    np.testing.assert_allclose(solution.q_end, solution.q[0], rtol=0, atol=1e-9)
    assert np.max(np.abs(solution.u_end)) < 1e-10


def test_a_tilted_cylinder_settles_on_a_box() -> None:
    """It strikes with its rim, topples back on its feet or over on its side, and the books balance."""
    stand, body = Stand((TABLE,)), CylinderBody(0.01, 0.006)
    system = ns.System([stand, body])
    system.contact(stand, body, **_laws(Coulomb(0.3), 0.3))
    system.place(body, position=(0.003, 0.004, 0.02), orientation=(math.cos(0.15), math.sin(0.15), 0.0, 0.0))
    solution = ns.simulate(system, 0.6)
    assert solution.status == "done"
    assert solution.q_end[2] == pytest.approx(0.006, abs=1e-10)
    assert np.max(np.abs(solution.u_end)) < 1e-10
    assert np.count_nonzero(solution.events.after[-1]) == 3
    assert solution.energy.residual < 1e-8


COLLIDING: dict[str, tuple[FreeBody, FreeBody]] = {
    "cylinder and box": (CylinderBody(0.03, 0.05), BoxBody(0.03, 0.04, 0.05)),
    "cone and box": (ConeBody(0.04, 0.07), BoxBody(0.03, 0.04, 0.05)),
    "disc and box": (DiscBody(0.05), BoxBody(0.02, 0.02, 0.03)),
    "cylinder and tetrahedron": (
        CylinderBody(0.03, 0.05),
        HullBody(tetrahedron(np.random.default_rng(2), 0.06).points),
    ),
    "cylinder and rounded box": (CylinderBody(0.03, 0.05), BoxBody(0.03, 0.04, 0.05, rounding=0.01)),
    "cone and rounded box": (ConeBody(0.04, 0.07), BoxBody(0.03, 0.04, 0.05, rounding=0.003)),
    "disc and rounded tetrahedron": (
        DiscBody(0.05),
        HullBody(tetrahedron(np.random.default_rng(2), 0.05).points, rounding=0.01),
    ),
    "cylinder and capsule": (CylinderBody(0.03, 0.05), CapsuleBody(0.02, 0.04)),
    "cone and capsule": (ConeBody(0.04, 0.07), CapsuleBody(0.02, 0.04)),
    "disc and capsule": (DiscBody(0.05), CapsuleBody(0.02, 0.04)),
    "cylinder and cylinder": (CylinderBody(0.03, 0.05), CylinderBody(0.04, 0.02)),
    "cylinder and cone": (CylinderBody(0.03, 0.05), ConeBody(0.04, 0.07)),
    "cone and cone": (ConeBody(0.03, 0.05), ConeBody(0.04, 0.07)),
    "disc and cylinder": (DiscBody(0.05), CylinderBody(0.03, 0.05)),
    "rounded cylinder and box": (CylinderBody(0.03, 0.05, rounding=0.01), BoxBody(0.03, 0.04, 0.05)),
    "rounded cone and rounded box": (
        ConeBody(0.04, 0.07, rounding=0.005),
        BoxBody(0.03, 0.04, 0.05, rounding=0.01),
    ),
    "rounded disc and capsule": (DiscBody(0.05, rounding=0.005), CapsuleBody(0.02, 0.04)),
    "rounded cylinder and ellipsoid": (CylinderBody(0.03, 0.05, rounding=0.01), EllipsoidBody(0.03, 0.04, 0.05)),
    "rounded cylinder and rounded cone": (
        CylinderBody(0.03, 0.05, rounding=0.005),
        ConeBody(0.04, 0.07, rounding=0.005),
    ),
    "two rounded cones": (ConeBody(0.03, 0.05, rounding=0.005), ConeBody(0.04, 0.07, rounding=0.002)),
    "two rounded discs": (DiscBody(0.05, rounding=0.005), DiscBody(0.06, rounding=0.01)),
    "rounded disc and cylinder": (DiscBody(0.05, rounding=0.005), CylinderBody(0.04, 0.02)),
    "disc and disc": (DiscBody(0.05), DiscBody(0.06)),
    "cylinder and ellipsoid": (CylinderBody(0.03, 0.05), EllipsoidBody(0.03, 0.04, 0.05)),
    "cone and superellipsoid": (ConeBody(0.04, 0.07), SuperellipsoidBody(0.03, 0.04, 0.05, 1.3, 1.2)),
    "disc and ellipsoid": (DiscBody(0.05), EllipsoidBody(0.02, 0.02, 0.03)),
    "cylinder and boxy superellipsoid": (CylinderBody(0.03, 0.05), SuperellipsoidBody(0.03, 0.04, 0.05, 0.5, 0.7)),
    "cone and boxy superellipsoid": (ConeBody(0.04, 0.07), SuperellipsoidBody(0.03, 0.04, 0.05, 0.3, 0.6)),
    "cylinder and mixed superellipsoid": (CylinderBody(0.03, 0.05), SuperellipsoidBody(0.03, 0.04, 0.05, 0.5, 1.3)),
    "disc and boxy superellipsoid": (DiscBody(0.05), SuperellipsoidBody(0.02, 0.02, 0.03, 0.4, 0.4)),
}


def _momenta(bodies: Any, q: Any, u: Any) -> tuple[Any, Any]:
    linear, angular = np.zeros(3), np.zeros(3)
    for body, x, v in zip(bodies, q.reshape(-1, 7), u.reshape(-1, 6), strict=True):
        axes = Rotation.from_quat(np.roll(x[3:], -1)).as_matrix()
        linear += body.total_mass * v[:3]
        angular += np.cross(x[:3], body.total_mass * v[:3]) + axes @ tensor_of(body.inertia, body.products) @ v[3:]
    return linear, angular


@pytest.mark.fast_cases(7)
@pytest.mark.parametrize("name", COLLIDING)
def test_colliding_bodies_keep_momentum_and_energy(name: str) -> None:
    """Without friction and with e = 1, to 1e-9, in eight collisions at any orientation."""
    bodies, rng, impacts = COLLIDING[name], np.random.default_rng(3), 0
    for _ in range(8):
        system = ns.System(bodies, gravity=0.0)
        system.contact(*bodies, **_laws(Frictionless(), 1.0))
        for body, side in zip(bodies, (-1.0, 1.0), strict=True):
            system.place(
                body,
                position=np.array([0.1 * side, *rng.uniform(-0.01, 0.01, 2)]),
                orientation=np.roll(Rotation.random(random_state=rng).as_quat(), 1),
                velocity=np.array([-side, *rng.normal(size=2) * 0.1]),
                angular_velocity=5.0 * rng.normal(size=3),
            )
        solution = ns.simulate(system, 0.2)
        assert solution.status == "done"
        impacts += solution.events.causes().count("impact")
        before, after = _momenta(bodies, solution.q[0], solution.u[0]), _momenta(bodies, solution.q_end, solution.u_end)
        momentum = sum(body.total_mass for body in bodies)
        np.testing.assert_allclose(after[0], before[0], rtol=0, atol=1e-12 * momentum)
        np.testing.assert_allclose(after[1], before[1], rtol=0, atol=1e-10 * momentum)
        assert solution.energy.kinetic_end == pytest.approx(solution.energy.kinetic_start, rel=1e-9)
    assert impacts >= 8


def test_a_rounded_beam_slides_along_a_log() -> None:
    """At mu g against its motion until it sticks, without leaving the middle of the log."""
    log, beam, mu, speed = Stand((LOG,)), BoxBody(0.005, 0.03, 0.005, rounding=0.001), 0.3, 0.2
    system = ns.System([log, beam])
    system.contact(log, beam, **_laws(Coulomb(mu), 0.3))
    system.place(beam, position=(-0.01, 0.0, 0.005), orientation=UPRIGHT, velocity=(speed, 0.0, 0.0))
    solution = ns.simulate(system, 0.1)
    assert solution.status == "done"
    way = speed**2 / (2.0 * mu * 9.81)
    np.testing.assert_allclose(solution.q_end[:3], [-0.01 + way, 0.0, 0.005], rtol=0, atol=1e-10)
    assert solution.energy.residual < 1e-10
    assert np.max(np.abs(solution.u_end)) < 1e-10


@pytest.mark.parametrize("seed", range(4))
def test_a_rounded_box_falls_on_a_cylinder(seed: int) -> None:
    """At any orientation: it strikes, slides and rolls off, and the books balance."""
    log, rng = Stand((LOG,)), np.random.default_rng(seed)
    box = BoxBody(0.01, 0.012, 0.008, rounding=0.002)
    system = ns.System([log, box])
    system.contact(log, box, **_laws(Coulomb(0.2), 0.5))
    orientation = np.roll(Rotation.random(random_state=rng).as_quat(), 1)
    place = np.array([0.0, 0.004, 0.03])
    system.place(box, position=place, orientation=orientation, angular_velocity=5.0 * rng.normal(size=3))
    solution = ns.simulate(system, 0.3)
    assert solution.status == "done"
    assert solution.events.causes().count("impact") >= 2
    assert solution.q_end[2] < -0.02
    assert solution.energy.residual < 1e-8


@pytest.mark.parametrize("rounding", [0.0, 0.003])
def test_a_cylinder_rolls_down_a_slope(rounding: float) -> None:
    """On its side: the acceleration is g sin / (1 + J / m R^2), and it keeps rolling, rounded or not."""
    body, slope = CylinderBody(0.01, 0.02, rounding=rounding), 0.1
    plate = Plate(motion=Rest(slope))
    system = ns.System([plate, body])
    system.contact(plate, body, **_laws(Coulomb(0.3), 0.3))
    tilt = Rotation.from_rotvec([0.0, slope, 0.0])
    turn = np.roll((tilt * Rotation.from_quat(np.roll(LYING, -1))).as_quat(), 1)
    system.place(body, position=tilt.apply([0.0, 0.0, 0.01]), orientation=turn)
    solution = ns.simulate(system, 0.3)
    assert solution.status == "done"
    share = body.inertia[2] / (body.total_mass * 0.01**2)
    assert (share == pytest.approx(0.5)) == (rounding == 0.0)
    speed = 0.3 * 9.81 * math.sin(slope) / (1.0 + share)
    np.testing.assert_allclose(tilt.inv().apply(solution.u_end[:3]), [speed, 0.0, 0.0], rtol=0, atol=1e-9)
    np.testing.assert_allclose(solution.u_end[3:], [0.0, 0.0, -speed / 0.01], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(tilt.inv().apply(solution.q_end[:3]), [0.15 * speed, 0.0, 0.01], rtol=0, atol=1e-10)


def test_a_rounded_disc_rolls_in_a_circle() -> None:
    """Steadily, leaning by an angle: the rate of precession is the one that holds it up.

    The centre is at rest for a circle of radius 0 of the rim about it: with the contact at a p + r n from the centre,
    the torque of gravity is that which turns the angular momentum.
    """
    radius, rounding, lean = 0.03, 0.004, 0.5
    body, plate = DiscBody(radius, rounding=rounding), Stand((Plane(),))
    wide = radius - rounding
    across, _, along = (moment / body.total_mass for moment in body.inertia)
    # the disc's axis leans by ``lean`` from the vertical; the centre stays where it is
    s, c = math.sin(lean), math.cos(lean)
    arm, height = wide * c, wide * s + rounding
    # rates: precession p about the vertical, spin w about the own axis; the point of contact is at rest
    # velocity of the lowest point of the torus: p arm + w (wide + rounding s) = 0
    part = -arm / (wide + rounding * s)
    # own components: about the axis w + p c, across p s; angular momentum's horizontal part times p is the torque
    rate = math.sqrt(9.81 * arm / abs(s * (along * (part + c) - across * c)))
    turned = np.array([math.cos(0.5 * lean), 0.0, math.sin(0.5 * lean), 0.0])
    axis = np.array([s, 0.0, c])
    spin = rate * (np.array([0.0, 0.0, 1.0]) + part * axis)
    system = ns.System([plate, body])
    system.contact(plate, body, **_laws(Coulomb(0.5), 0.3))
    system.place(
        body,
        position=(0.0, 0.0, height),
        orientation=turned,
        angular_velocity=Rotation.from_quat(np.roll(turned, -1)).inv().apply(spin),
    )
    solution = ns.simulate(system, 0.5, engine=ns.EventDriven(tolerance=1e-12))
    assert solution.status == "done"
    np.testing.assert_allclose(solution.q_end[:3], [0.0, 0.0, height], rtol=0, atol=1e-8)
    axes = Rotation.from_quat(np.roll(solution.q_end[3:], -1)).as_matrix()
    expected = Rotation.from_rotvec([0.0, 0.0, 0.5 * rate]).apply(axis)
    np.testing.assert_allclose(axes[:, 2], expected, rtol=0, atol=1e-7)
