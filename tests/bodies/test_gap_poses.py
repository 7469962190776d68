"""Gaps at random, aligned and bordering poses, proved by outlines of the bodies alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from bodies import Cylinder, Disc, Ellipsoid
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.interfaces import ConvexShape
from nonsmooth.rotations import rotation
from tests.benchmarks.gap_draws import SMOOTH_PAIRS, Pose
from tests.benchmarks.gap_poses import WAY, WRONG, Gaps, measure, proved
from tests.benchmarks.outlines import outline_of

pytestmark = pytest.mark.skipif(PLAIN, reason="calls compiled functions by their addresses")

NEXT_TO_A_CAP = (
    (
        Cylinder(0.01869, 0.01771, rounding=0.00784),
        Ellipsoid(0.01853, 0.01173, 0.007649),
        [0.0, -1.5146400518211363e-08, 0.04441537649397554, 0.7071067811586844, 0.7071067812144107, 0.0, 0.0],
        [
            0.010054550418990284,
            0.02693163748050382,
            0.04158580240667584,
            0.7555009043471002,
            0.6272005719760374,
            -0.13535305040192003,
            0.13233123106286037,
        ],
        1.394e-3,
    ),
    (
        Disc(0.01447),
        Ellipsoid(0.01789, 0.01474, 0.009903),
        [
            0.05384234008494012,
            -0.08597621895835902,
            0.014919730090257143,
            0.775021978404907,
            0.1091618757641512,
            0.6061256943631437,
            0.14154949880633558,
        ],
        [
            0.00022980344696071713,
            -0.08252405586645428,
            0.014970627675466724,
            -0.18862514381995818,
            0.17464219356720526,
            -0.35495190416934036,
            -0.8988491559053764,
        ],
        34.4e-3,
    ),
)
"""The smooth body's lowest point over the cap is next to the rim, and the normal next to the axis."""


def _pose(numbers: list[float], shift: float = 0.0) -> Pose:
    q = np.array(numbers[3:]) / np.linalg.norm(numbers[3:])
    return np.array([numbers[:3]]) + np.array([shift, 0.0, 0.0]), rotation(q)[None]


@pytest.mark.parametrize(("first", "second", "one", "two", "gap"), NEXT_TO_A_CAP)
@pytest.mark.parametrize("shift", [0.0, 1e-7, 1e-6, 1e-5, -1e-5, 1e-4, -1e-4])
def test_a_rim_holds_where_its_normal_is_nearly_the_axis(
    first: ConvexShape, second: ConvexShape, one: list[float], two: list[float], gap: float, shift: float
) -> None:
    poses = _pose(one), _pose(two, shift)
    rows = Gaps(first, second)(*poses)
    found = proved(outline_of(first), outline_of(second), *poses, rows, np.random.default_rng(0))
    assert found.error[0] <= WRONG
    assert found.gap[0] == pytest.approx(gap, abs=2.0 * abs(shift) + 5e-5)


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("pair", SMOOTH_PAIRS)
def test_gaps_of_smooth_bodies_are_right_and_do_not_jump(pair: str) -> None:
    """At some hundred poses, apart and overlapping by up to a micrometre."""
    tally = measure(pair, 100, seed=3, per_shapes=20)
    assert tally.poses >= 100
    assert (tally.none, tally.wrong, tally.jumps) == (0, 0, 0)
    assert tally.worst <= WRONG


def test_the_check_sees_a_wrong_gap() -> None:
    """One that is off by 2e-9 m, an overlap of bodies apart, a point that is not the body's."""
    first, second, one, two, _ = NEXT_TO_A_CAP[0]
    poses, outlines = (_pose(one), _pose(two)), (outline_of(first), outline_of(second))
    right = Gaps(first, second)(*poses)
    for column, by in ((0, 2e-9), (0, -0.05), (4, 2e-9), (9, -2e-9)):
        rows = right.copy()
        rows[0, column] += by
        assert proved(*outlines, *poses, rows, np.random.default_rng(0)).error[0] > WRONG


def test_bodies_about_one_centre_without_a_gap_are_deep() -> None:
    first, second = Cylinder(0.007, 0.007), Ellipsoid(0.018, 0.0036, 0.0028)
    pose = _pose([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    rows = np.full((1, 10), np.nan)
    rows[0, 0] = np.inf
    found = proved(outline_of(first), outline_of(second), pose, pose, rows, np.random.default_rng(0))
    assert found.common[0]
    assert found.lower[0] < -1e-3


def test_the_check_sees_a_jump(monkeypatch: pytest.MonkeyPatch) -> None:
    """A gap that changes by twice the way."""
    called = Gaps.__call__
    calls = []

    def jumping(self: Gaps, first: Pose, second: Pose) -> np.ndarray:
        calls.append(0)
        rows = called(self, first, second)
        # every other call is the look aside
        rows[:, 0] += 2.0 * WAY * (len(calls) % 2 == 0)
        return rows

    monkeypatch.setattr(Gaps, "__call__", jumping)
    tally = measure("sphere-sphere", 6, per_shapes=2)
    assert replace(tally, cost=0.0).jumps > 0
