"""A vertex that comes down on a disc, however its edges lean: the disc meets it, and goes on doing so behind."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from bodies import ConvexHull, Disc, TriangleMesh, Triangles
from nonsmooth.interfaces import Shape
from tests.bodies.carriers import Rig

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
