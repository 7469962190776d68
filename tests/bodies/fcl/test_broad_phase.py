"""The tree of boxes against all pairs; complete within the look-ahead; planes beside it; wrong input."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

import nonsmooth as ns
from bodies.fcl.broad_phase import BroadPhase

Array = NDArray[np.float64]


def _all_pairs(halves: Array, places: Array) -> Array:
    one, two = np.triu_indices(len(places), 1)
    near = np.all(np.abs(places[one] - places[two]) <= halves[one] + halves[two], axis=1)
    return np.stack([one[near], two[near]], axis=1)


@pytest.mark.parametrize("n", [1, 2, 30, 300])
def test_all_pairs(n: int) -> None:
    """Over a walk, boxes of different sizes."""
    rng = np.random.default_rng(n)
    halves = rng.uniform(0.01, 0.06, (n, 3))
    tree, places, count = BroadPhase(halves, 0.005), rng.uniform(-0.3, 0.3, (n, 3)), 0
    for _ in range(10):
        pairs = tree.pairs(places)
        np.testing.assert_array_equal(pairs, _all_pairs(halves + 0.005, places))
        count += len(pairs)
        places = places + rng.normal(0.0, 0.05, places.shape)
    assert count > 0 or n < 30


@given(st.lists(st.tuples(*[st.integers(-3, 3)] * 3), min_size=1, max_size=12))
def test_bodies_on_a_grid_and_at_one_place(grid: list[tuple[int, int, int]]) -> None:
    """Equal places, boxes that just touch, signed zeros."""
    places = np.array(grid, dtype=float) * -1.0
    halves = np.resize([0.25, 0.75, 0.6], (len(grid), 3))
    pairs = BroadPhase(halves).pairs(places)
    np.testing.assert_array_equal(pairs, _all_pairs(halves, places))


def test_pairs_hold_for_the_look_ahead() -> None:
    """Whoever touches within h at speeds up to v and accelerations up to a is among the pairs at its beginning."""
    rng, n, v, a, h = np.random.default_rng(5), 200, 0.5, 9.81, 0.02
    radii = rng.uniform(0.01, 0.03, n)
    places = rng.uniform(-0.25, 0.25, (n, 3))
    speeds = rng.normal(size=(n, 3))
    speeds *= v / np.linalg.norm(speeds, axis=1)[:, None]
    found = {tuple(pair) for pair in BroadPhase(radii, v * h + 0.5 * a * h * h).pairs(places).tolist()}
    met: set[tuple[int, int]] = set()
    for t in np.linspace(0.0, h, 21):
        now = places + t * speeds - [0.0, 0.0, 0.5 * a * t * t]
        one, two = np.triu_indices(n, 1)
        touch = np.linalg.norm(now[one] - now[two], axis=1) <= radii[one] + radii[two]
        met |= set(zip(one[touch].tolist(), two[touch].tolist(), strict=True))
    at_first = {tuple(pair) for pair in BroadPhase(radii).pairs(places).tolist()}
    assert met <= found
    assert met - at_first


def test_planes_stand_beside_the_tree() -> None:
    """A tilted plane and boxes of three sides: those with a corner below it."""
    rng = np.random.default_rng(9)
    halves, places = rng.uniform(0.01, 0.1, (100, 3)), rng.uniform(-0.3, 0.3, (100, 3))
    normal = np.array([0.36, -0.48, 0.8])
    corners = places[:, None] + np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, 8).T * halves[:, None]
    below = np.flatnonzero(np.min((corners - [0.1, 0.0, 0.0]) @ normal, axis=1) <= 0.0)
    found = BroadPhase(halves).over_plane(places, (0.1, 0.0, 0.0), normal)
    np.testing.assert_array_equal(found, below)
    assert 0 < len(found) < 100


def test_wrong_input_does_not_reach_the_tree() -> None:
    """FCL takes what is not a number without a word, and its pairs are wrong from then on."""
    for halves in ([0.0], [-1.0], [np.nan], [np.inf], [[1.0, 2.0]], np.zeros((2, 2, 2))):
        with pytest.raises(ns.InvalidInput, match=r"BroadPhase\.halves must be positive and finite"):
            BroadPhase(halves)
    with pytest.raises(ns.InvalidInput, match=r"BroadPhase\.margin"):
        BroadPhase([1.0], -1.0)
    tree = BroadPhase([1.0, 2.0])
    for places in ([[0.0, 0.0, 0.0]], [[0.0, 0.0, np.nan], [0.0, 0.0, 0.0]], [0.0, 0.0]):
        with pytest.raises(ns.InvalidInput, match="BroadPhase: positions must be finite"):
            tree.pairs(places)
    assert tree.pairs([[0.0, 0.0, 0.0], [2.5, 0.0, 0.0]]).tolist() == [[0, 1]]


def test_none_and_pickled() -> None:
    assert BroadPhase(np.zeros((0, 3))).pairs(np.zeros((0, 3))).shape == (0, 2)
    tree = pickle.loads(pickle.dumps(BroadPhase([1.0, 2.0], 0.5)))
    assert tree.pairs([[0.0, 0.0, 0.0], [3.9, 0.0, 0.0]]).tolist() == [[0, 1]]
    assert tree.pairs([[0.0, 0.0, 0.0], [4.1, 0.0, 0.0]]).tolist() == []
