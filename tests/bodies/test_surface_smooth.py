"""Separation of boxes, hulls, capsules and convex meshes from smooth bodies, near, deep and in coincident poses."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from bodies import Box, Capsule, Ellipsoid, Superellipsoid, TriangleMesh
from bodies.meshes.triangles import Triangles
from nonsmooth.engine.native.kernel import PLAIN
from tests.benchmarks.gap_poses import Gaps
from tests.bodies.given_shapes import EllipsoidSum
from tests.bodies.polytopes import random_hull

pytestmark = pytest.mark.skipif(PLAIN, reason="calls compiled functions by their addresses")

HULL = random_hull(np.random.default_rng(4), 9, 8e-3)
SURFACES: dict[str, Any] = {
    "box": Box(8e-3, 5e-3, 4e-3),
    "rounded box": Box(8e-3, 5e-3, 4e-3, rounding=1e-3),
    "hull": HULL,
    "capsule": Capsule(3e-3, 8e-3),
}
SMOOTH: dict[str, Any] = {
    "ellipsoid": Ellipsoid(6e-3, 4e-3, 8e-3),
    "superellipsoid": Superellipsoid(6e-3, 4e-3, 8e-3, 1.3, 1.2),
    "boxy": Superellipsoid(6e-3, 4e-3, 8e-3, 0.6, 0.7),
    "given": EllipsoidSum(),
}
POSES = 60


def _poses(surface: Any, smooth: Any, rng: np.random.Generator) -> tuple[Any, Any]:
    """Return places and rotations: at gaps down to -4 mm, and with the centre at a corner, on an edge or at the middle.

    In half of the poses the axes are aligned.  Superellipsoids get no coincident poses: with the centre deep in the
    surface, Newton's method may miss the largest gap at a flat or sharp place.
    """
    count = 1 if isinstance(smooth, Superellipsoid) else 3
    corners, edges = np.array(surface.core.vertices), surface.core.edges
    turns, places = Rotation.random(POSES, random_state=rng).as_matrix(), []
    turns[::2] = np.eye(3)
    for i, turn in enumerate(turns):
        one, two = corners[list(edges[rng.integers(len(edges))][:2])]
        if i % count == 0:
            n = rng.normal(size=3)
            n /= np.linalg.norm(n)
            gap = rng.choice([1e-3, 1e-9, 0.0, -1e-9, -1e-6, -1e-4, -1e-3, -4e-3])
            places.append(surface.support(n) + gap * n - turn @ smooth.support(turn.T @ -n))
        else:
            places.append(rng.choice([one, 0.5 * (one + two), np.mean(corners, axis=0)]))
    return np.array(places), turns


def _along(surface: Any, smooth: Any, place: Any, turn: Any, n: Any) -> float:
    """Return the gap of the supporting planes across a unit vector [m]."""
    return float(n @ (place + turn @ smooth.support(turn.T @ -n) - surface.support(n)))


def _gaps(surface: Any, smooth: Any, places: Any, turns: Any) -> Any:
    here = np.zeros((len(places), 3)), np.broadcast_to(np.eye(3), (len(places), 3, 3))
    return Gaps(surface, smooth)(here, (places, turns))


@pytest.mark.parametrize("smooth", SMOOTH)
@pytest.mark.parametrize("surface", SURFACES)
def test_the_gap_is_the_largest_of_all_supporting_planes(surface: str, smooth: str) -> None:
    one, two = SURFACES[surface], SMOOTH[smooth]
    rng = np.random.default_rng([len(surface), len(smooth)])
    places, turns = _poses(one, two, rng)
    normals = np.array(one.core.planes).reshape(-1, 4)[:, :3]
    for place, turn, row in zip(places, turns, _gaps(one, two, places, turns), strict=True):
        assert row[0] == pytest.approx(_along(one, two, place, turn, row[1:4]), abs=1e-12)
        tried = rng.normal(size=(40, 3))
        tried = np.vstack([tried / np.linalg.norm(tried, axis=1)[:, None], normals, turn.T, -turn.T])
        assert row[0] >= max(_along(one, two, place, turn, n) for n in tried) - 1e-12


@pytest.mark.parametrize("smooth", SMOOTH)
def test_a_convex_mesh_has_the_gaps_of_its_hull(smooth: str) -> None:
    mesh: Any = TriangleMesh(Triangles(*HULL.drawing()))
    places, turns = _poses(HULL, SMOOTH[smooth], np.random.default_rng(len(smooth)))
    rows = [_gaps(shape, SMOOTH[smooth], places, turns) for shape in (HULL, mesh)]
    np.testing.assert_allclose(rows[1][:, 0], rows[0][:, 0], atol=1e-12)
