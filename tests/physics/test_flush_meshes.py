"""Equal meshes that are not convex meet head on, flush or almost: edges along edges, corners on borders."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import MeshBody, Triangles
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.native.kernel import PLAIN
from tests.bodies.meshes.parts import Mesh, channel

pytestmark = pytest.mark.skipif(PLAIN, reason="compiled runs take seconds, plain ones minutes")

E = 0.5
SHIFTS = ((0.0, 0.0), (1e-12, 0.0), (1e-9, 1e-9), (1e-6, 0.0), (1e-6, 1e-6), (1e-3, 0.0))
ANGLES = (0.0, 1e-9, 1e-8, 1e-7, 1.1e-7, 1e-6, 1e-3, 9.9e-3, 1.1e-2, 0.1)
"""About the line of centres [rad]."""


def _hollow_box() -> Mesh:
    """Return a square tube along z whose outer edges are on the axes x and y: 32 triangles."""
    rings = [(r, z) for r in (0.03, 0.05) for z in (-0.05, 0.05)]
    turns = [0.5 * math.pi * i for i in range(4)]
    points = [(r * math.cos(turn), r * math.sin(turn), z) for r, z in rings for turn in turns]
    faces = list[tuple[int, int, int]]()
    # inner wall, outer wall, bottom, top: each between two of the rings
    for low, high in ((4, 0), (8, 12), (0, 8), (12, 4)):
        for i in range(4):
            j = (i + 1) % 4
            faces += [(low + i, low + j, high + j), (low + i, high + j, high + i)]
    return np.array(points), np.array(faces)


MESHES = {"hollow box": _hollow_box(), "U": channel()}
WORLDS = {"along the axes": np.array([1.0, 0.0, 0.0, 0.0]), "aslant": np.array([0.7, 0.1, -0.5, 0.5])}
"""Orientations of both bodies and of the line of centres."""
EDGE_ON_EDGE = (("hollow box", 0), ("hollow box", 1))
FACE_ON_FACE = (("hollow box", 2), ("U", 1))
"""Meshes and directions for which the points of contact are symmetric about the line of centres."""


@pytest.mark.fast_cases(24)
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("shift", SHIFTS, ids=str)
@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("world", WORLDS)
def test_they_collide_head_on(world: str, angle: float, shift: tuple[float, float], axis: int, name: str) -> None:
    """Momentum is kept and the bodies separate, with the impact's ratio if the points of contact are symmetric."""
    if (name, axis) in EDGE_ON_EDGE and max(shift) == 1e-3 and 0.0 < angle < 1e-8:
        pytest.skip("one end of the edge collides with a face, and the other end is 1e-10 m away")
    points, faces = MESHES[name]
    one, two = (MeshBody(Triangles(points.tolist(), faces.tolist())) for _ in range(2))
    direction, turned = np.eye(3)[axis], Rotation.from_quat(WORLDS[world], scalar_first=True)
    system = ns.System([one, two], gravity=0.0)
    system.contact(one, two, normal=Unilateral(), friction=Coulomb(0.0), impact=EnergeticImpact(E))
    system.place(one, velocity=turned.apply(direction), orientation=_quaternion(turned))
    second_turned = turned * Rotation.from_rotvec(angle * direction)
    place = turned.apply(0.13 * direction + np.roll([0.0, *shift], axis))
    system.place(two, position=place, orientation=_quaternion(second_turned))
    solution = ns.simulate(system, 0.12)
    first, second = (float(solution.of(body)[1][-1, :3] @ turned.apply(direction)) for body in (one, two))
    assert first + second == pytest.approx(1.0, abs=1e-9)
    assert second > first + 1e-3
    # closer to parallel, round-off decides which ends of the edges meet first
    is_central = (name, axis) in FACE_ON_FACE or ((name, axis) in EDGE_ON_EDGE and angle >= 1e-6)
    if is_central and max(shift) == 0.0:
        assert second - first == pytest.approx(E, abs=1e-6)


def _quaternion(turned: Rotation) -> tuple[float, ...]:
    return tuple(float(x) for x in turned.as_quat(scalar_first=True))
