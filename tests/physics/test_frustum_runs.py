"""Cylinders, cones and discs in motion against other bodies than planes: rest, landings, conservation."""

from __future__ import annotations

import math
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
    SuperellipsoidBody,
)
from bodies.inertia import tensor_of
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
LOG = Cylinder(0.02, 0.03, z=-0.02, axis_x=1.0, axis_z=0.0)
STEEP = math.atan2(0.01, 0.02)
"""Half the angle of a cone."""
ON_ITS_SIDE = (math.cos(0.25 * math.pi + 0.5 * STEEP), math.sin(0.25 * math.pi + 0.5 * STEEP), 0.0, 0.0)


def _laws(friction: Any, restitution: float) -> dict[str, Any]:
    return {"normal": Unilateral(), "friction": friction, "impact": EnergeticImpact(restitution=restitution)}


RESTS: dict[str, tuple[Shape, FreeBody, float, tuple[float, float, float, float], int]] = {
    "a cylinder stands on a box": (TABLE, CylinderBody(0.01, 0.02), 0.02, UPRIGHT, 3),
    "a cylinder lies on a box": (TABLE, CylinderBody(0.01, 0.02), 0.01, LYING, 2),
    "a cylinder lies over the edges of a box": (NARROW, CylinderBody(0.01, 0.02), 0.01, LYING, 2),
    "a cone stands on a box": (TABLE, ConeBody(0.01, 0.02), 0.005, UPRIGHT, 3),
    "a cone lies on a box": (TABLE, ConeBody(0.01, 0.02), 0.015 * math.sin(STEEP), ON_ITS_SIDE, 2),
    "a disc lies on a box": (TABLE, DiscBody(0.01), 1e-6, UPRIGHT, 3),
    "a box stands on a cap": (Cylinder(0.02, 0.02, z=-0.02), BoxBody(0.01, 0.012, 0.005), 0.005, UPRIGHT, 4),
    "a box larger than the cap stands on its feet": (PILLAR, BoxBody(0.03, 0.032, 0.005), 0.005, UPRIGHT, 3),
    "a capsule lies on a cap": (PILLAR, CapsuleBody(0.005, 0.012), 0.005, LYING, 2),
    "a capsule lies across a cap": (PILLAR, CapsuleBody(0.005, 0.03), 0.005, LYING, 2),
    "a cylinder stands on a cap": (PILLAR, CylinderBody(0.01, 0.02), 0.02, UPRIGHT, 3),
    "a wide cylinder stands on a cap": (PILLAR, CylinderBody(0.04, 0.02), 0.02, UPRIGHT, 3),
    "a cylinder lies on a cap": (PILLAR, CylinderBody(0.01, 0.015), 0.01, LYING, 2),
    "a cylinder lies across a cap": (PILLAR, CylinderBody(0.01, 0.04), 0.01, LYING, 2),
    "a cone stands on a cap": (PILLAR, ConeBody(0.01, 0.02), 0.005, UPRIGHT, 3),
    "a disc lies on a cap": (PILLAR, DiscBody(0.01), 1e-6, UPRIGHT, 3),
    "a beam lies across a log": (LOG, BoxBody(0.005, 0.03, 0.005), 0.005, UPRIGHT, 2),
    "a boxy body lies on a cap": (PILLAR, SuperellipsoidBody(0.01, 0.012, 0.008, 0.4, 0.6), 0.008, UPRIGHT, 1),
}
"""Shape of the support, body, height of its origin over the support, orientation, contacts that hold it."""


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
    "cylinder and capsule": (CylinderBody(0.03, 0.05), CapsuleBody(0.02, 0.04)),
    "cone and capsule": (ConeBody(0.04, 0.07), CapsuleBody(0.02, 0.04)),
    "disc and capsule": (DiscBody(0.05), CapsuleBody(0.02, 0.04)),
    "cylinder and cylinder": (CylinderBody(0.03, 0.05), CylinderBody(0.04, 0.02)),
    "cylinder and cone": (CylinderBody(0.03, 0.05), ConeBody(0.04, 0.07)),
    "cone and cone": (ConeBody(0.03, 0.05), ConeBody(0.04, 0.07)),
    "disc and cylinder": (DiscBody(0.05), CylinderBody(0.03, 0.05)),
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
