"""Rounded boxes and hulls: how large they are, mass properties, what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from bodies import Box, BoxBody, ConvexHull, HullBody, Sphere
from nonsmooth import InvalidInput


def test_a_rounded_box_is_as_large_as_a_sharp_one_and_a_rounded_hull_larger_by_the_radius() -> None:
    sharp, rounded = Box(0.1, 0.2, 0.3), Box(0.1, 0.2, 0.3, rounding=0.05)
    np.testing.assert_allclose(rounded.bounds, sharp.bounds, rtol=0, atol=1e-15)
    assert rounded.length == pytest.approx(np.linalg.norm([0.05, 0.15, 0.25]) + 0.05)
    hull = ConvexHull(sharp.vertices, rounding=0.05)
    np.testing.assert_allclose(hull.bounds, np.array([[-0.15, -0.25, -0.35], [0.15, 0.25, 0.35]]), rtol=0, atol=1e-15)
    same = ConvexHull(rounded.vertices, rounding=0.05)
    assert same.volume == pytest.approx(rounded.volume, rel=1e-14)
    np.testing.assert_allclose(same.inertia, rounded.inertia, rtol=0, atol=1e-15)
    bodies = BoxBody(0.1, 0.2, 0.3, rounding=0.05), HullBody(rounded.vertices, rounding=0.05)
    assert bodies[1].total_mass == pytest.approx(bodies[0].total_mass, rel=1e-14)
    np.testing.assert_allclose(bodies[1].inertia, bodies[0].inertia, rtol=1e-13)


def test_a_box_rounded_almost_all_over_is_almost_a_ball() -> None:
    """As its core shrinks, the solid is that of the ball and the spread of the core."""
    box, ball = Box(0.1, 0.1, 0.1, rounding=0.1 - 1e-6), Sphere(0.1)
    assert box.volume == pytest.approx(ball.volume, rel=1e-4)
    np.testing.assert_allclose(box.inertia, ball.inertia, rtol=0, atol=1e-4 * np.max(ball.inertia))


def test_who_asks_a_rounded_polyhedron_for_sharp_edges_is_refused() -> None:
    """Pairs that know sharp ones only must not take the core for the body."""
    with pytest.raises(InvalidInput, match=r"Box\.rounding"):
        assert Box(0.1, 0.2, 0.3, rounding=0.05).polytope


@pytest.mark.parametrize(
    ("kind", "sizes", "rounding", "words"),
    [
        (Box, (1.0, 2.0, 1.0), -0.1, ("Box.rounding", ">= 0", "-0.1")),
        (Box, (1.0, 2.0, 1.0), 1.0, ("Box.rounding", "at most 0.99998", "of the whole")),
        (BoxBody, (1.0, 2.0, 1.0), 1.5, ("BoxBody.rounding", "less than the least")),
    ],
)
def test_bad_roundings(kind: type, sizes: tuple[float, ...], rounding: float, words: tuple[str, ...]) -> None:
    with pytest.raises(InvalidInput) as caught:
        kind(*sizes, rounding=rounding)
    assert all(word in str(caught.value) for word in words)
