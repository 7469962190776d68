"""Contacts of cylinders, cones and discs with polyhedra and capsules, against poses made from their nearest points."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.random import Generator
from scipy.spatial.transform import Rotation

from bodies import Box, Capsule, ConvexHull, Cylinder, Disc
from bodies.contacts.surface.surface_pairs import MOST_NEAR
from tests.benchmarks.touches import ROUND, Touch, box, hull, on
from tests.bodies.carriers import Rig
from tests.bodies.rounds import PosedRound, tangent, touch_round

GAPS = (1e-1, 1e-3, 1e-5, 1e-7, 1e-9, 0.0, -1e-9, -1e-7, -1e-5)
FEATURES = (
    ("rim", "face"),
    ("apex", "face"),
    ("cap", "vertex"),
    ("side", "vertex"),
    ("side", "edge"),
    ("rim", "edge"),
)
KINDS = [(name, *pair) for name in ROUND for pair in FEATURES if pair[0] in ROUND[name][1]]
POLYHEDRA = {"box": box, "hull": hull}
_STEP = 1e-4
_WEIGHTS = {1: 3.0 / 4.0, 2: -3.0 / 20.0, 3: 1.0 / 60.0}
"""Central differences of sixth order."""


def edge_through(shape: Any, point: Any, normal: Any) -> Any:
    """Return the direction of the edge of a polyhedron that a point lies on, or is off by the rounding."""
    vertices, point = np.array(shape.core.vertices), point - shape.sweep * normal
    ends = [(vertices[one], vertices[two]) for one, two, *_ in shape.core.edges]
    lengths = [np.linalg.norm(two - one) for one, two in ends]
    longer = [np.linalg.norm(point - one) + np.linalg.norm(point - two) for one, two in ends]
    number = int(np.argmin(np.array(longer) - lengths))
    return (ends[number][1] - ends[number][0]) / lengths[number]


def pose_of(rng: Generator, first: Touch, part: str, second: Touch, other: str, gap: float) -> PosedRound:
    tangents = tangent(first[0], part, first[2]), edge_through(*second) if other == "edge" else None
    return PosedRound(rng, first, second, tangents, gap)


def differences(rig: Rig, posed: PosedRound, u: Any, number: int) -> Any:
    """Return the derivatives of gap and gap rate; the rig is left at the pose."""

    def at(t: float) -> Any:
        rig.put(posed.moved(u, t), u)
        assert rig.geometry[number, 30] <= 0.0
        return np.array([rig.geometry[number, 0], rig.rate[number, 0]])

    near = {i: (at(i * _STEP) - at(-i * _STEP)) / _STEP for i in _WEIGHTS}
    at(0.0)
    return np.sum([weight * near[i] for i, weight in _WEIGHTS.items()], axis=0)


def _stays(rig: Rig, posed: PosedRound, u: Any, number: int) -> bool:
    """Whether a contact is the same one wherever the differences are taken."""
    past = []
    for i in range(-3, 4):
        rig.put(posed.moved(u, i * _STEP), u)
        past.append(rig.geometry[number, 30])
    return bool(max(past) <= 0.0)


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("solid", POLYHEDRA)
@pytest.mark.parametrize(("name", "part", "other"), KINDS)
def test_gap_normal_and_witness_of_constructed_poses(build: Any, name: str, part: str, other: str, solid: str) -> None:
    """One contact has the gap, normal and witness points that they were made with.

    None other that faces its partner is nearer, and those that do not are open.
    """
    rng = np.random.default_rng(7)
    for _ in range(5):
        first, second = touch_round(rng, name, part), on(POLYHEDRA[solid], other)(rng)
        rig = Rig((first[0], second[0]), build.laws())
        for gap in GAPS:
            posed = pose_of(rng, first, part, second, other, gap)
            rig.put(posed.poses, np.zeros(12))
            blocks = rig.geometry
            assert len(posed.found_in(blocks)) == 1
            if gap >= 0.0:
                past = blocks[:, 30] > 0.0
                assert np.min(blocks[~past, 0]) >= gap - 1e-15
                assert np.min(blocks[past, 0]) > 1e-10


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize(("name", "part", "other"), KINDS)
def test_rates_are_derivatives(build: Any, name: str, part: str, other: str) -> None:
    """Gap rate against differences of the gap to 1e-8, second-order term against those of the rate to 1e-6."""
    rng = np.random.default_rng(8)
    for gap in (1e-3, 1e-5, 1e-9):
        looked = 0
        while looked < 3:
            first, second = touch_round(rng, name, part), on(hull, other)(rng)
            rig = Rig((first[0], second[0]), build.laws())
            posed = pose_of(rng, first, part, second, other, gap)
            rig.put(posed.poses, np.zeros(12))
            (number,) = posed.found_in(rig.geometry)
            u = np.concatenate([rng.normal(size=3) * scale for scale in (0.02, 1.0, 0.02, 1.0)])
            if other == "edge" and not _stays(rig, posed, u, number):
                # a face next to the edge takes over
                continue
            looked += 1
            rate, second_rate = differences(rig, posed, u, number)
            assert rig.rate[number, 0] == pytest.approx(rate, rel=1e-8, abs=1e-10)
            assert rig.bias[number, 0] == pytest.approx(second_rate, rel=1e-6, abs=1e-7)


def on_capsule(rng: Generator, part: str) -> Touch:
    """Return a capsule, a point of its side or of an end, and the normal there."""
    radius, half = float(rng.uniform(1e-3, 4e-3)), float(rng.uniform(4e-3, 1e-2))
    shape, n = Capsule(radius, half), rng.normal(size=3)
    place = half * float(rng.uniform(-0.9, 0.9))
    if part == "side":
        n[2] = 0.0
    else:
        place = half if n[2] > 0.0 else -half
    n /= np.linalg.norm(n)
    return shape, np.array([0.0, 0.0, place]) + radius * n, n


CAPSULE_KINDS = [
    (name, part, other)
    for name, (_, parts) in ROUND.items()
    for part in parts
    for other in ("end", "side")
    if other == "end" or part != "cap"
]


def _posed_capsule(rng: Generator, name: str, part: str, other: str, gap: float) -> tuple[Any, PosedRound]:
    first, second = touch_round(rng, name, part, is_on_feet=False), on_capsule(rng, other)
    tangents = tangent(first[0], part, first[2]), np.array([0.0, 0.0, 1.0]) if other == "side" else None
    return (first[0], second[0]), PosedRound(rng, first, second, tangents, gap)


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize(("name", "part", "other"), CAPSULE_KINDS)
def test_capsules_at_constructed_poses(build: Any, name: str, part: str, other: str) -> None:
    """As above, also 0.1 mm deep; and rates are derivatives."""
    rng = np.random.default_rng(9)
    for gap in (*GAPS, -1e-4):
        for _ in range(3):
            shapes, posed = _posed_capsule(rng, name, part, other, gap)
            rig = Rig(shapes, build.laws())
            rig.put(posed.poses, np.zeros(12))
            blocks = rig.geometry
            (number,) = posed.found_in(blocks)
            past = blocks[:, 30] > 0.0
            assert np.min(blocks[~past, 0]) >= gap - 1e-15
            assert gap < 0.0 or np.all(blocks[past, 0] > 1e-10)
            if gap > 1e-2:
                continue
            u = np.concatenate([rng.normal(size=3) * scale for scale in (0.02, 1.0, 0.02, 1.0)])
            rate, second_rate = differences(rig, posed, u, number)
            assert rig.rate[number, 0] == pytest.approx(rate, rel=1e-8, abs=1e-10)
            assert rig.bias[number, 0] == pytest.approx(second_rate, rel=1e-6, abs=1e-7)


BETWEEN = [
    (one, part, two, other)
    for one in ROUND
    for two in ROUND
    for part, other in (
        ("rim", "cap"),
        ("apex", "cap"),
        ("cap", "rim"),
        ("cap", "apex"),
        ("side", "side"),
        ("rim", "side"),
        ("apex", "side"),
        ("side", "rim"),
        ("side", "apex"),
        ("rim", "rim"),
    )
    if part in ROUND[one][1] and other in ROUND[two][1]
]


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize(("one", "part", "two", "other"), BETWEEN)
def test_frustums_at_constructed_poses(build: Any, one: str, part: str, two: str, other: str) -> None:
    """As above; and rates are derivatives, of a crossing of rims at some of the poses at least."""
    rng, looked = np.random.default_rng(12), 0
    for gap in GAPS:
        for _ in range(3):
            first, second = touch_round(rng, one, part), touch_round(rng, two, other)
            tangents = tangent(first[0], part, first[2]), tangent(second[0], other, second[2])
            posed = PosedRound(rng, first, second, tangents if part == other else (None, None), gap)
            rig = Rig((first[0], second[0]), build.laws())
            rig.put(posed.poses, np.zeros(12))
            blocks = rig.geometry
            found = posed.found_in(blocks)
            # next to the line of centres both halves of rims see the same crossing
            assert len(found) in ((1, 2) if part == other == "rim" else (1,))
            if gap >= 0.0:
                past = blocks[:, 30] > 0.0
                assert np.min(blocks[~past, 0]) >= gap - 1e-15
                assert np.min(blocks[past, 0]) > 1e-10
            if gap > 1e-2 or gap < 0.0:
                continue
            u = np.concatenate([rng.normal(size=3) * scale for scale in (0.02, 1.0, 0.02, 1.0)])
            if part == other == "rim" and not _stays(rig, posed, u, found[0]):
                # the crossing goes over to the other half of the rim
                continue
            rate, second_rate = differences(rig, posed, u, found[0])
            assert rig.rate[found[0], 0] == pytest.approx(rate, rel=1e-8, abs=1e-10)
            assert rig.bias[found[0], 0] == pytest.approx(second_rate, rel=1e-6, abs=1e-7)
            looked += 1
    assert looked >= 3


def test_a_fine_hull_has_a_search(build: Any) -> None:
    """A hull has more pairs of edges and rims than a contact list should have: the contacts are those of near pairs."""
    points = np.random.default_rng(3).normal(size=(400, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    rig = Rig((Cylinder(1.0, 1.0), ConvexHull(points.tolist())), build.laws(), 0.1)
    assert len(rig.contacts) == MOST_NEAR
    unit = np.array([1.0, 0.0, 0.0, 0.0])
    rig.put([(np.zeros(3), unit), (np.array([1.99, 0.0, 0.0]), unit)], np.zeros(12))
    assert rig.listed() > 0.0
    gaps = rig.geometry[rig.geometry[:, 30] <= 0.0, 0]
    assert np.min(gaps) == pytest.approx(0.99 - np.max(-np.array(points)[:, 0]), abs=0.01)


@pytest.mark.parametrize("name", ["cylinder", "disc"])
def test_round_off_opens_no_crossing_of_flush_faces(build: Any, name: str) -> None:
    """A cap is pressed into a face and juts out over an edge: its rim crosses the edge twice, at the depth of the cap.

    The contact points lie on the side of the box and on the rim, within round-off.
    """
    radius, depth, shift = 0.02, 5e-5, 1e-4
    shape, below = (Disc(radius), 0.0) if name == "disc" else (Cylinder(radius, 0.01, foot_height=0.0), 0.01)
    rig, rng = Rig((shape, Box(radius, 0.03, radius)), build.laws()), np.random.default_rng(4)
    unit = np.array([1.0, 0.0, 0.0, 0.0])
    for _ in range(20):
        place = np.array([shift, 0.0, radius - depth + below]) + 1e-17 * rng.normal(size=3)
        turn = Rotation.from_rotvec(1e-15 * rng.normal(size=3)).as_quat()
        rig.put([(place, np.roll(turn, 1)), (np.zeros(3), unit)], np.zeros(12))
        blocks = rig.geometry[rig.geometry[:, 30] <= 0.0]
        crosses = np.abs(blocks[:, 10] - radius) < 1e-9
        # both points of the rim over the edge, from the Pythagorean theorem
        apart = math.sqrt(radius**2 - (radius - shift) ** 2)
        assert sorted(blocks[crosses, 11]) == pytest.approx([-apart, apart], abs=1e-9)
        assert blocks[crosses, 0] == pytest.approx(-depth, abs=1e-8)
