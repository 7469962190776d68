"""Convex hulls: faces, mass properties, what is refused."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from bodies import Box, BoxBody, Compound, ConvexHull, HullBody, Part, Polyhedron
from nonsmooth import InvalidInput
from tests.bodies.polytopes import dodecahedron, random_hull

CUBE = tuple(itertools.product((-0.5, 0.5), repeat=3))
OCTAHEDRON = tuple(tuple(sign * (i == j) for j in range(3)) for i in range(3) for sign in (-1.0, 1.0))
TETRAHEDRON = ((1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0))


@pytest.mark.parametrize(
    ("points", "counts", "volume", "moment"),
    [
        # volume and moment of inertia about any axis over volume and square of the edge
        (CUBE, (8, 6, 12), 1.0, 1.0 / 6.0),
        (OCTAHEDRON, (6, 8, 12), 4.0 / 3.0, 2.0 / 10.0),
        (TETRAHEDRON, (4, 4, 6), 8.0 / 3.0, 8.0 / 20.0),
        (dodecahedron(np.sqrt(3.0)), (20, 12, 30), 2.0 * (5.0 + np.sqrt(5.0)), None),
    ],
)
def test_regular_bodies(points: Any, counts: tuple[int, ...], volume: float, moment: float | None) -> None:
    hull = ConvexHull(points)
    polytope = hull.polytope
    assert (len(polytope.vertices), len(polytope.faces), len(polytope.edges)) == counts
    assert hull.volume == pytest.approx(volume, rel=1e-14)
    np.testing.assert_allclose(hull.centroid, 0.0, atol=1e-15)
    inertia = hull.inertia
    np.testing.assert_allclose(inertia, inertia[0, 0] * np.eye(3), rtol=0, atol=1e-14 * inertia[0, 0])
    if moment is not None:
        assert inertia[0, 0] == pytest.approx(moment * volume, rel=1e-14)


def test_points_inside_on_faces_and_on_edges_do_not_matter() -> None:
    grid = tuple(itertools.product(np.linspace(-0.5, 0.5, 4).tolist(), repeat=3))
    polytope = ConvexHull(grid).polytope
    assert sorted(polytope.vertices) == sorted(CUBE)
    assert sorted(len(face) for face in polytope.faces) == [4] * 6
    assert all(plane[3] == 0.5 for plane in polytope.planes)


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10**6), st.integers(4, 40), st.floats(1e-4, 1e2))
def test_faces_bound_all_vertices(seed: int, n: int, size: float) -> None:
    """No vertex is outside of a face, those of the face are on it, and edges join faces at an angle."""
    hull = random_hull(np.random.default_rng(seed), n, size)
    polytope = hull.polytope
    vertices, planes = np.array(polytope.vertices), np.array(polytope.planes)
    heights = vertices @ planes[:, :3].T - planes[:, 3]
    assert np.max(heights) <= 1e-13 * size
    for face, corners in enumerate(polytope.faces):
        assert np.max(np.abs(heights[list(corners), face])) <= 1e-13 * size
    for one, two, left, right in polytope.edges:
        assert {one, two} <= set(polytope.faces[left]) & set(polytope.faces[right])
    assert hull.length == pytest.approx(np.max(np.linalg.norm(vertices, axis=1)))


def test_a_hull_of_corners_has_the_mass_properties_of_the_box() -> None:
    """Wherever its points have their origin, and as a turned part of a compound."""
    box = BoxBody(0.1, 0.2, 0.3)
    corners: NDArray[np.float64] = np.array(Box(0.1, 0.2, 0.3).vertices)
    hull = HullBody(np.add(corners, (1.0, -2.0, 0.5)).tolist())
    assert hull.total_mass == pytest.approx(box.total_mass, rel=1e-12)
    np.testing.assert_allclose(hull.inertia, box.inertia, rtol=1e-11)
    np.testing.assert_allclose(hull.products, 0.0, atol=1e-11)
    np.testing.assert_allclose(hull.centre, [1.0, -2.0, 0.5], rtol=0, atol=1e-14)
    turn = (0.8, 0.36, -0.48, 0.0)
    two = [Compound((Part(body, (0.1, 0.2, 0.3), turn),)) for body in (box, HullBody(corners.tolist()))]
    np.testing.assert_allclose(two[1].inertia, two[0].inertia, rtol=1e-12)
    placed: list[NDArray[np.float64]] = []
    for compound, kind in zip(two, (Box, ConvexHull), strict=True):
        shape = compound.shapes[0]
        assert isinstance(shape, kind)
        assert isinstance(shape, Polyhedron)
        placed.append(np.array(sorted(np.round(shape.polytope.vertices, 12).tolist())))
    np.testing.assert_allclose(placed[1], placed[0], rtol=0, atol=1e-11)
    assert HullBody(CUBE, mass=3.0).total_mass == 3.0


BAD: list[tuple[dict[str, Any], tuple[str, ...]]] = [
    ({"points": CUBE[:3]}, ("ConvexHull.points", "at least four points")),
    ({"points": 1.0}, ("ConvexHull.points", "at least four points")),
    ({"points": [(0, 0), (1, 0), (0, 1), (1, 1)]}, ("at least four points of three numbers",)),
    ({"points": [*CUBE, (0.0, np.nan, 0.0)]}, ("ConvexHull.points[8]", "must be finite", "nan")),
    ({"points": [(x, y, 0.0) for x, y, _ in CUBE]}, ("do not lie in one plane", "thickness")),
    ({"points": [(x, y, 1e-9 * z) for x, y, z in CUBE]}, ("do not lie in one plane",)),
    ({"points": [(1.0, 2.0, 3.0)] * 5}, ("do not lie in one plane",)),
    (
        {"points": (lambda x: x / np.linalg.norm(x, axis=1)[:, None])(np.random.default_rng(1).normal(size=(800, 3)))},
        ("at most 500 vertices", "800", "Simplify"),
    ),
    ({"points": CUBE, "orientation_x": 0.5}, ("ConvexHull orientation", "unit length")),
]


@pytest.mark.parametrize(("arguments", "words"), BAD)
def test_bad_points_are_refused(arguments: dict[str, Any], words: tuple[str, ...]) -> None:
    with pytest.raises(InvalidInput) as caught:
        ConvexHull(**arguments)
    for word in words:
        assert word in str(caught.value)


def test_mass_and_density_together_are_refused() -> None:
    with pytest.raises(InvalidInput, match=r"HullBody\.mass"):
        HullBody(CUBE, mass=1.0, density=1000.0)
