"""Discs against vertices and edges that are sharp: tips that come through, and blades that lie beside the rim."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from bodies import ConvexHull, Disc, TriangleMesh, Triangles
from nonsmooth.interfaces import Shape
from tests.benchmarks.random_systems import convex
from tests.benchmarks.random_systems.pieces import Piece, pieces_of_shape
from tests.bodies.carriers import Rig
from tests.bodies.polytopes import SLIVER

RADIUS = 0.01
GAPS = (1e-2, 1e-3, 1e-5, 1e-9, 0.0, -1e-9, -1e-7, -1e-5, -1e-4, -5e-4)


def _hull(corners: Any) -> Shape:
    return ConvexHull(corners.tolist())


def _mesh(corners: Any) -> Shape:
    return TriangleMesh(Triangles(corners, ((0, 2, 1), (0, 3, 2), (0, 1, 3), (1, 2, 3)), "tetrahedron"))


@pytest.mark.parametrize("solid", [_hull, _mesh])
def test_a_tip_that_leans_comes_through_a_disc(build: Any, solid: Any) -> None:
    """The tip of a tetrahedron is its only vertex near the disc, and the gap its height over it."""
    rng = np.random.default_rng(3)
    for lean in (0.0, 0.005, 0.02):
        # counter-clockwise from outside, above the tip and to one side of it
        ring = np.array([(4e-3, 0.0, 6e-3), (-2e-3, 4e-3, 7e-3), (-2e-3, -4e-3, 8e-3)])
        rig = Rig((Disc(RADIUS), solid(np.vstack([np.zeros(3), np.add(ring, [lean, 0.0, 0.0])]))), build.laws())
        for _ in range(5):
            place = Rotation.from_rotvec([0.0, 0.0, rng.uniform(0.0, 6.0)]), rng.uniform(-0.1, 0.1, 3)
            foot = rng.uniform(0.0, 0.5) * RADIUS * np.array([np.cos(a := rng.uniform(0.0, 6.0)), np.sin(a), 0.0])
            turn, up = Rotation.random(random_state=rng), rng.choice([-1.0, 1.0])
            side = Rotation.from_rotvec([np.pi if up < 0.0 else 0.0, 0.0, 0.0])
            for gap in GAPS:
                tip = turn.apply(np.add(foot, [0.0, 0.0, up * gap])) + place[1]
                tumbled = turn * side * place[0]
                rig.put([(place[1], np.roll(turn.as_quat(), 1)), (tip, np.roll(tumbled.as_quat(), 1))], np.zeros(12))
                facing = rig.geometry[rig.geometry[:, 30] <= 0.0, 0]
                assert np.min(np.abs(facing - gap)) <= 1e-14
                if gap >= 0.0:
                    assert np.min(facing) >= gap - 1e-14


@pytest.mark.parametrize("tilt", [0.3, -0.3, 2.8, -2.8])
def test_a_disc_meets_a_face_by_the_lowest_point_of_its_rim(build: Any, tilt: float) -> None:
    """Whichever of its sides is up: the gap is the height of the centre less R sin(tilt)."""
    corners = np.array([(-0.1, -0.1, 0.0), (0.1, -0.1, 0.0), (0.0, 0.1, 0.0), (0.0, 0.0, -0.1)])
    floor = TriangleMesh(Triangles(corners, ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)), "tetrahedron"))
    rig = Rig((Disc(RADIUS), floor), build.laws())
    turn = np.array([np.cos(0.5 * tilt), 0.0, np.sin(0.5 * tilt), 0.0])
    rig.put([(np.array([0.0, 0.0, 0.02]), turn), (np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]))], np.zeros(12))
    facing = rig.geometry[rig.geometry[:, 30] <= 0.0, 0]
    assert np.min(facing, initial=np.inf) == pytest.approx(0.02 - RADIUS * abs(np.sin(tilt)), abs=1e-15)


def _nearest(one: Piece, two: Piece, turns: Any, way: Any) -> tuple[float, Any]:
    """Return distance and direction from the one to the other by support functions alone."""
    rows = np.array([one.kind, two.kind]), np.stack([one.numbers, two.numbers]), one.corners, two.corners
    direction = way / np.linalg.norm(way)
    between = way + turns[1] @ two.place - turns[0] @ one.place
    axes = np.stack([turns[0] @ one.axes, turns[1] @ two.axes])
    _, distance = convex.bounds(*rows, axes, between, 0.0, np.inf, direction)
    return distance, direction


def _gap_along(one: Piece, two: Piece, turns: Any, way: Any, direction: Any) -> float:
    """Return the separation of two bodies along a direction by support functions alone [m]."""
    rows = np.array([one.kind, two.kind]), np.stack([one.numbers, two.numbers]), one.corners, two.corners
    between = way + turns[1] @ two.place - turns[0] @ one.place
    axes = np.stack([turns[0] @ one.axes, turns[1] @ two.axes])
    return float(convex._plane(*rows, axes, between, direction))


@pytest.mark.slow
@pytest.mark.parametrize("radius", [0.012, 0.005])
def test_a_blade_beside_the_rim_of_a_disc_does_not_overlap_it(build: Any, radius: float) -> None:
    rng = np.random.default_rng(6)
    shapes = Disc(radius), ConvexHull(SLIVER)
    rig, (one,), (two,) = Rig(shapes, build.laws()), pieces_of_shape(shapes[0]), pieces_of_shape(shapes[1])
    for _ in range(300):
        turns = [Rotation.random(random_state=rng) for _ in range(2)]
        axes = [turn.as_matrix() for turn in turns]
        way = rng.normal(size=3) * 0.01
        distance, n = _nearest(one, two, axes, way)
        if distance < 1e-6:
            continue
        way = way + (1e-6 - distance) * n
        rig.put(
            [(x, np.roll(turn.as_quat(), 1)) for x, turn in zip((np.zeros(3), way), turns, strict=True)], np.zeros(12)
        )
        facing = rig.geometry[rig.geometry[:, 30] <= 0.0]
        # a corner beside the rim faces nothing yet; a pair leaves out contacts along whose normal its parts overlap
        for row in facing[facing[:, 0] < 1e-6 - 1e-11]:
            assert _gap_along(one, two, axes, way, row[1:4]) < -1e-6
