"""The second library behind the same interface: the same distances as FCL, the same refusals."""

from __future__ import annotations

import importlib.util
import itertools
import pickle
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import Box, Plane, Sphere
from bodies.coal.solid import CoalSolid
from bodies.distances.pose import Pose
from bodies.distances.separation import DoubtfulDistance, separation
from bodies.fcl.solid import FclSolid
from nonsmooth.errors import MissingPackagesError
from nonsmooth.interfaces import ConvexShape
from tests.bodies.fcl.solids import SHAPES, poses

needs_coal = pytest.mark.skipif(importlib.util.find_spec("coal") is None, reason="needs nonsmooth[coal]")


def test_without_the_package_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(MissingPackagesError, match=r'pip install "nonsmooth\[coal\]"'):
        CoalSolid(Sphere(0.01))


@needs_coal
@pytest.mark.parametrize(("one", "two"), list(itertools.combinations_with_replacement(SHAPES, 2)))
def test_both_libraries_agree(one: str, two: str) -> None:
    """In both orders, to 1e-8 m, where neither is in doubt; overlaps too."""
    rng, compared = np.random.default_rng([7, len(one), len(two)]), 0
    for _ in range(40):
        pose, other = poses(rng)
        try:
            ours, theirs, back = (
                separation(kind(SHAPES[a]), p, kind(SHAPES[b]), q)
                for kind, a, p, b, q in (
                    (CoalSolid, one, pose, two, other),
                    (FclSolid, one, pose, two, other),
                    (CoalSolid, two, other, one, pose),
                )
            )
        except DoubtfulDistance:
            continue
        compared += 1
        assert ours.overlap == theirs.overlap == back.overlap
        assert ours.distance == pytest.approx(theirs.distance, abs=3e-8)
        assert ours.distance == pytest.approx(back.distance, abs=1e-9)
        if not ours.overlap:
            np.testing.assert_allclose(ours.second - ours.first, back.first - back.second, atol=1e-3)
    assert compared >= 35


@needs_coal
def test_refusals_and_pickling() -> None:
    with pytest.raises(ns.InvalidInput, match=r"^coal must be given a bounded solid.*Known: Box"):
        CoalSolid(Plane())
    ball, box = CoalSolid(Sphere(0.01)), Box(0.01, 0.01, 0.01)
    with pytest.raises(ns.InvalidInput, match="needs solids of one library"):
        separation(ball, Pose(), FclSolid(box), Pose())
    again = pickle.loads(pickle.dumps(ball))
    away = Pose(np.array([0.0, 0.05, 0.0]))
    assert separation(again, Pose(), CoalSolid(box), away).distance == pytest.approx(0.03, abs=1e-15)
    assert separation(ball, Pose(), ball, Pose()).overlap


@needs_coal
@pytest.mark.parametrize("pair", [("capsule", "box"), ("ellipsoid", "box"), ("cylinder", "cylinder")])
def test_shallow_overlaps(pair: tuple[str, str]) -> None:
    """Depths of 1e-9 to 1e-4 m are overlaps, or in doubt: never a distance."""
    rng, told = np.random.default_rng(0), 0
    first, second = (SHAPES[name] for name in pair)
    assert isinstance(first, ConvexShape)
    assert isinstance(second, ConvexShape)
    a, b = CoalSolid(first), CoalSolid(second)
    for _ in range(200):
        turn: Any = Rotation.random(2, rng).as_matrix()
        n = rng.normal(size=3)
        n /= np.linalg.norm(n)
        on_a, on_b = turn[0] @ first.support(turn[0].T @ n), turn[1] @ second.support(turn[1].T @ -n)
        depth = 10.0 ** rng.uniform(-9.0, -4.0)
        try:
            found = separation(a, Pose(np.zeros(3), turn[0]), b, Pose(on_a - on_b - depth * n, turn[1]))
        except DoubtfulDistance:
            continue
        told += 1
        assert found.overlap
    assert told >= 150
