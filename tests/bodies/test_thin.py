"""Thin bodies: gaps of known poses with semi-axes in ratios up to 1000, and no overlap where there is none."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from bodies import Superellipsoid
from bodies.contacts.smooth.smooth_core import Cores as _Cores
from bodies.contacts.smooth.smooth_newton import largest_gap
from bodies.shapes.support_function import support_of as _support_of
from nonsmooth.engine.native.kernel import PLAIN

# called with arrays in place of tuples
Cores: Any = _Cores
support_of: Any = _support_of

GAPS = (1e-1, 1e-3, 1e-5, 1e-7, 1e-9)
"""[m]"""


def _thin(rng: np.random.Generator, ratio: float, low: float, high: float) -> Any:
    """Return the core of a body of 1 cm whose least semi-axis is the ratio-th part of it."""
    share = rng.uniform(0.0, 1.0, 3)
    share = (share - np.min(share)) / np.ptp(share)
    exponents = rng.uniform(low, high, 2) if low != high else np.full(2, low)
    return np.array(Superellipsoid(*(0.01 * ratio**-share).tolist(), *exponents.tolist()).core)


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize(
    ("ratio", "low", "high"),
    [(1000.0, 1.0, 1.0), (1000.0, 1.05, 1.6), (10.0, 0.2, 0.95)],
    ids=["ellipsoids", "superellipsoids", "boxy"],
)
def test_bodies_apart(ratio: float, low: float, high: float) -> None:
    """Gap and normal; needles, blades and discs, rims and points."""
    rng = np.random.default_rng(11)
    for gap in GAPS:
        for _ in range(3 if PLAIN else 30):
            one, two = (_thin(rng, ratio, low, high) for _ in range(2))
            turn, n = Rotation.random(random_state=rng).as_matrix(), rng.normal(size=3)
            n /= np.linalg.norm(n)
            p, q = np.array(support_of(one, n)[1]), np.array(support_of(two, (-turn.T @ n))[1])
            g, _, normal = largest_gap(Cores(one, two, tuple(turn.ravel()), tuple(p + gap * n - turn @ q)))
            assert abs(g - gap) <= 1e-12
            # round-off of the place over a radius of curvature of 1e-9 m
            np.testing.assert_allclose(normal, n, rtol=0, atol=1e-7)


@pytest.mark.slow
def test_deep_in_each_other_no_guess_is_made() -> None:
    """An answer says that bodies overlap only if they do: the longest way out of random poses against a search."""
    rng = np.random.default_rng(12)
    directions = rng.normal(size=(400, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    told = 0
    for _ in range(5 if PLAIN else 60):
        one, two = (_thin(rng, 100.0, 1.0, 1.0) for _ in range(2))
        turn, x = Rotation.random(random_state=rng).as_matrix(), 0.01 * rng.normal(size=3)
        g = float(largest_gap(Cores(one, two, tuple(turn.ravel()), tuple(x)))[0])
        apart = max(n @ x - support_of(one, n)[0] - support_of(two, (-turn.T @ n))[0] for n in directions)
        if np.isnan(g):
            continue
        told += 1
        assert g >= apart - 1e-12
    assert told >= (4 if PLAIN else 55)


def test_one_in_the_middle_of_the_other() -> None:
    """Equal centres, a point in an ellipsoid included: the shortest way out is along the shortest axis."""
    same = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    one, small = np.array(Superellipsoid(0.03, 0.02, 0.01).core), np.array(Superellipsoid(0.003, 0.002, 0.001).core)
    point = np.array([0.0] * 3 + [2.0] * 2 + [0.0] * 13)
    assert largest_gap(Cores(one, small, same, (0.0, 0.0, 0.0)))[0] == pytest.approx(-0.011, abs=1e-15)
    assert largest_gap(Cores(one, point, same, (0.0, 0.0, 1e-9)))[0] == pytest.approx(-0.01, abs=1e-8)
    assert largest_gap(Cores(one, point, same, (0.0, 0.0, 0.0)))[0] == pytest.approx(-0.01, abs=1e-15)
