"""Superellipsoids that are flat one way and sharp the other: their charts, gaps of known poses, and their motion."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from bodies import Superellipsoid
from bodies.contacts.smooth.chart import chart_of, start_of
from bodies.contacts.smooth.smooth_core import Cores as _Cores
from bodies.contacts.smooth.smooth_newton import largest_gap
from bodies.shapes.support_function import gauge_of
from bodies.shapes.support_function import support_of as _support_of
from nonsmooth.engine.native.kernel import PLAIN

# called with arrays in place of tuples
Cores: Any = _Cores
support_of: Any = _support_of

Array = NDArray[np.float64]
BOTH_WAYS = [(0.3, 1.3), (1.4, 0.5)]
GAPS = (1e-1, 1e-3, 1e-5, 1e-7, 1e-9, -1e-9, -1e-7, -1e-5)
"""[m]"""


def _core(exponents: Any, semi: Any = (0.006, 0.009, 0.007)) -> Array:
    return np.array(Superellipsoid(*semi, *exponents).core)


@settings(max_examples=60, deadline=None)
@given(st.floats(0.2, 1.8), st.floats(0.2, 1.8), st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3))
def test_point_and_normal_move_as_the_chart_says(along: float, across: float, way: list[float]) -> None:
    """Of any exponents: the support point along the normal, U and S by differences, U + L S = 1."""
    if np.min(np.abs(way)) < 0.05 or min(abs(along - 1.0), abs(across - 1.0)) < 0.01:
        return
    core, n, length = _core((along, across)), np.array(way) / np.linalg.norm(way), 0.005
    norm: Any = tuple(core[:5].tolist())
    point, normal, first, second, slide, turn, w, one, two = chart_of(norm, length, start_of(norm, tuple(n.tolist())))
    np.testing.assert_allclose(normal, n, rtol=0, atol=1e-12)
    np.testing.assert_allclose(point, support_of(core, n)[1], rtol=0, atol=1e-14)
    assert gauge_of(core, point) == pytest.approx(1.0, rel=1e-12)
    tangents = np.array([first, second])
    s, u = (np.array([[m[0], m[1]], [m[1], m[2]]]) for m in (slide, turn))
    np.testing.assert_allclose(u + length * s, np.eye(2), rtol=0, atol=1e-9)
    step = 1e-6 * length
    for i, way_of_w in enumerate((one, two)):
        there, back = (
            chart_of(norm, length, tuple(np.array(w) + sign * step * np.array(way_of_w))) for sign in (1, -1)
        )
        moves, turns = (tangents @ (np.array(there[k]) - np.array(back[k])) / (2.0 * step) for k in (0, 1))
        np.testing.assert_allclose(moves, u[:, i], rtol=0, atol=1e-6)
        np.testing.assert_allclose(length * turns, length * s[:, i], rtol=0, atol=1e-6)


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize("exponents", BOTH_WAYS)
@pytest.mark.parametrize("other", [(0.4, 1.2), (1.3, 0.6), (0.3, 0.7), (1.2, 1.4), (1.0, 1.0)])
def test_gaps_of_known_poses(exponents: Any, other: Any) -> None:
    """At any normal, and next to flat and sharp places; from either side."""
    rng, one = np.random.default_rng(7), _core(exponents)
    for gap in GAPS:
        for i in range(1 if PLAIN else 8):
            two = _core(other, rng.uniform(0.004, 0.01, 3).tolist())
            turn, n = Rotation.random(random_state=rng).as_matrix(), rng.normal(size=3)
            # not where a slight overlap is more than the bodies are round
            n[i % 3] *= 10.0 ** rng.uniform(-8.0, -1.0) if gap > -1e-8 else 1.0
            n /= np.linalg.norm(n)
            p, q = np.array(support_of(one, n)[1]), np.array(support_of(two, (-turn.T @ n))[1])
            x = p + gap * n - turn @ q
            for swapped in (False, True):
                there = -turn.T @ x if swapped else x
                pair = (two, one, turn.T) if swapped else (one, two, turn)
                g, _, normal = largest_gap(Cores(*pair[:2], tuple(pair[2].ravel()), tuple(there)))
                assert abs(g - gap) <= 1e-12
                np.testing.assert_allclose(-turn @ np.array(normal) if swapped else normal, n, rtol=0, atol=1e-9)


@pytest.mark.parametrize("exponents", BOTH_WAYS)
def test_a_ball_over_the_third_axis(exponents: Any) -> None:
    """Over the middle of a flat place, or over a tip, where the chart has no directions."""
    ball = np.array(Superellipsoid(0.004, 0.004, 0.004).core)
    found = largest_gap(Cores(_core(exponents), ball, (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.012)))
    np.testing.assert_allclose(
        [found[0], *found[1], *found[2]], [0.001, 0.0, 0.0, 0.008, 0.0, 0.0, 1.0], rtol=0, atol=1e-16
    )
