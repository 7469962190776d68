"""Rounded cylinders, cones and discs against meshes that are not convex: distances of the cores, and transitions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from bodies import Cone, Cylinder, Disc, TriangleMesh, Triangles
from nonsmooth.engine.native.kernel import PLAIN
from tests.bodies.carriers import Rig
from tests.bodies.meshes.parts import bracket
from tests.bodies.round_distances import core_distance

Array = NDArray[Any]
UNIT = np.array([1.0, 0.0, 0.0, 0.0])
PLACE: dict[str, float] = {"x": 1e-3, "y": -2e-3, "z": 1e-3, "axis_x": 0.48, "axis_y": -0.6, "axis_z": 0.64}
SHAPES = {
    "cylinder": Cylinder(6e-3, 5e-3, **PLACE, rounding=1e-3),
    "cone": Cone(6e-3, 0.012, **PLACE, rounding=1e-3),
    "disc": Disc(8e-3, **PLACE, rounding=8e-4),
}
MESH = TriangleMesh(Triangles(*bracket(), "bracket"))
_CLOSE = 1e-11
"""Gap at which bodies are moved past each other [m]."""


@pytest.mark.slow
@pytest.mark.parametrize("name", SHAPES)
def test_gap_is_the_distance_of_the_core(build: Any, name: str) -> None:
    """At random places of cores that are apart: the nearest of what faces each other."""
    shape, rng = SHAPES[name], np.random.default_rng(3)
    rig = Rig((shape, MESH), build.laws())
    low, high = MESH.bounds
    compared = 0
    for place in rng.uniform(low - 0.01, high + 0.01, (20 if PLAIN else 60, 3)):
        turn = Rotation.random(random_state=rng)
        distance = core_distance(MESH, shape, place, turn)
        rig.put([(place, np.roll(turn.as_quat(), 1)), (np.zeros(3), UNIT)], np.zeros(12))
        gaps, past = rig.geometry[:, 0], rig.geometry[:, 30]
        if distance >= 1e-9:
            compared += 1
            # the rims are set back by the feet
            assert -1e-14 <= np.min(gaps[past <= 0.0]) - (distance - shape.rounding) <= shape.set_back + 1e-14
            assert np.all(gaps[past > 0.0] > min(distance - shape.rounding, 0.0) - 1e-14)
    assert compared > 3


@pytest.mark.parametrize("share", [0.0, 0.2, 0.5, 0.7])
def test_an_apex_meets_a_face_and_an_edge_as_a_sphere(build: Any, share: float) -> None:
    """A cone that points at a face or, at a share of its length, at an edge is as far from it as its tip."""
    corners = np.array([(-0.03, -0.05, 0.0), (0.03, 0.05, 0.0), (0.05, -0.03, -0.08), (-0.05, 0.03, -0.08)])
    solid = TriangleMesh(Triangles(corners, ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)), "tetrahedron"))
    cone = Cone(6e-3, 0.012, rounding=1e-3)
    rig = Rig((cone, solid), build.laws())
    normal, point = np.array([0.0, 0.0, 1.0]), (1.0 - share) * corners[0] + share * corners[1]
    if share == 0.0:
        across = np.cross(corners[2] - corners[0], corners[1] - corners[0])
        normal, point = across / np.linalg.norm(across), np.mean(corners[:3], axis=0)
    turn = Rotation.align_vectors([-normal], [[0.0, 0.0, 1.0]])[0]
    for gap in (1e-3, 1e-6, 0.0, -1e-4):
        place = point + gap * normal - turn.apply(cone.support(np.array([0.0, 0.0, 1.0])))
        rig.put([(place, np.roll(turn.as_quat(), 1)), (np.zeros(3), UNIT)], np.zeros(12))
        facing = rig.geometry[rig.geometry[:, 30] <= 0.0, 0]
        assert np.min(facing, initial=np.inf) == pytest.approx(gap, abs=1e-15)


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="a minute in plain mode")
@pytest.mark.parametrize("name", SHAPES)
def test_features_hand_over_without_a_hole_and_without_a_double(build: Any, name: str) -> None:
    """Past each other, all but touching: at every place exactly one contact has the distance of the bodies.

    Where it changes, which is looked at to 1e-12 of the way, the gap and its normal do not jump.
    """
    shape, rng = SHAPES[name], np.random.default_rng(9)
    rig = Rig((shape, MESH), build.laws())
    low, high = MESH.bounds
    changes = 0
    for _ in range(6):
        start, turn, spin = rng.normal(size=3), Rotation.random(random_state=rng), rng.normal(size=3)
        start *= 0.03 / np.linalg.norm(start)
        way = 0.4 * np.cross(start, rng.normal(size=3))

        def put(
            t: float, start: Array = start, turn: Any = turn, spin: Array = spin, way: Array = way
        ) -> tuple[int, Array, tuple[Array, Rotation]]:
            place, turned = 0.5 * (low + high) + start + t * way, Rotation.from_rotvec(t * spin) * turn
            for _ in range(2):
                rig.put([(place, np.roll(turned.as_quat(), 1)), (np.zeros(3), UNIT)], np.zeros(12))
                facing = rig.geometry[:, 30] <= 0.0
                nearest = int(np.argmin(np.where(facing, rig.geometry[:, 0], np.inf)))
                block, before = rig.geometry[nearest], place
                # moved along the normal the bodies keep their nearest points
                place = place - (_CLOSE - block[0]) * block[1:4]
            return nearest, rig.geometry, (before, turned)

        before, times = -1, np.linspace(-1.0, 1.0, 40)
        for i, t in enumerate(times):
            nearest, blocks, pose = put(t)
            gap = blocks[nearest, 0]
            if i % 8 == 0:
                distance = core_distance(MESH, shape, *pose) - shape.rounding
                assert -1e-14 <= gap - distance <= shape.set_back + 1e-14
            assert np.min(np.delete(blocks[:, 0], nearest)) > gap + 1e-11
            if before not in (-1, nearest):
                changes += 1
                one, two = times[i - 1], t
                while two - one > 1e-12:
                    middle = 0.5 * (one + two)
                    one, two = (middle, two) if put(middle)[0] == before else (one, middle)
                last, first = put(one)[1][before], put(two)
                assert first[1][first[0], 0] == pytest.approx(last[0], abs=1e-12)
                # an edge gives its contact to the corner a little before its end, and the normals differ by that
                np.testing.assert_allclose(first[1][first[0], 1:4], last[1:4], rtol=0, atol=1e-5)
            before = nearest
    assert changes > 5
