"""Distances next to contact: aligned, flush and degenerate poses whose distance is known, and hulls at random."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from scipy.optimize import nnls
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import Box, Capsule, Cone, ConvexHull, Cylinder, Disc, Ellipsoid, Sphere
from nonsmooth.interfaces import Shape

Array = np.ndarray
GAPS = (0.0, 1e-12, 1e-9, 1e-6, 1e-3, -1e-12, -1e-9, -1e-6, -1e-3)
SHIFTS = (0.0, 1e-12, 1e-9, 1e-6, 1e-3, 0.02)
TURNS = (0.0, 1e-9, 1e-6, 1e-3, 0.3, math.pi / 2.0)
EXACT = 1e-12
"""Error of a distance that counts, of bodies of 0.1 m [m]."""
_CORNERS = np.array(list(itertools.product((-0.05, 0.05), (-0.03, 0.03), (-0.02, 0.02))))
SHAPES: dict[str, Shape] = {
    "cube": Box(0.05, 0.05, 0.05),
    "brick": Box(0.05, 0.03, 0.02),
    "rounded brick": Box(0.054, 0.034, 0.024, rounding=0.004),
    "octahedron": ConvexHull((0.06 * np.vstack([np.eye(3), -np.eye(3)])).tolist()),
    "hull brick": ConvexHull(_CORNERS.tolist()),
    "sphere": Sphere(0.05),
    "capsule": Capsule(0.03, 0.05),
    "cylinder": Cylinder(0.05, 0.07, foot_height=0.0),
    "rounded cylinder": Cylinder(0.055, 0.075, rounding=0.005, foot_height=0.0),
    "coin": Cylinder(0.012, 0.001, foot_height=0.0),
    "cone": Cone(0.05, 0.1, foot_height=0.0),
    "disc": Disc(0.05, foot_height=0.0),
    "ellipsoid": Ellipsoid(0.05, 0.03, 0.02),
    "flat ellipsoid": Ellipsoid(0.05, 0.05, 0.002),
}
SHORTER = {"discs", "discs rim to rim", "edges", "vertices", "flat ellipsoids, rims"}
"""Poses in which bodies that overlap have a shorter way out than along x."""


@dataclass(frozen=True)
class Pose:
    """The first shape at the origin, the second one at (reach + gap, y, z): its distance is the gap, along x."""

    name: str
    shapes: tuple[str, str]
    turns: tuple[Array, Array]
    reach: float
    y: float
    z: float


def _about(axis: str, angle: float) -> Array:
    return np.asarray(Rotation.from_euler(axis, angle).as_matrix())


def _diagonal_along_x() -> Array:
    return np.asarray(Rotation.align_vectors([[1.0, 0.0, 0.0]], [[1.0, 1.0, 1.0]])[0].as_matrix())


_NONE, _LAID, _EDGE = np.eye(3), _about("y", math.pi / 2.0), _about("z", math.pi / 4.0)


def _shifted() -> Iterator[Pose]:
    """Yield faces, rims, edges and vertices on faces, shifted across the normal and turned about it."""
    for y, z in itertools.product(SHIFTS, SHIFTS):
        small = min(y, 1e-3), min(z, 1e-3)
        for turn in TURNS:
            spin, laid = _about("x", turn), _LAID @ _about("z", turn)
            yield Pose("cubes", ("cube", "cube"), (_NONE, spin), 0.1, y, z)
            yield Pose("bricks", ("brick", "brick"), (_NONE, spin), 0.1, y, z)
            yield Pose("brick and hull", ("brick", "hull brick"), (_NONE, spin), 0.1, y, z)
            yield Pose("rounded bricks", ("rounded brick", "rounded brick"), (_NONE, spin), 0.108, y, z)
            yield Pose("coaxial cylinders", ("cylinder", "cylinder"), (_LAID, laid), 0.14, y, z)
            yield Pose("coaxial coins", ("coin", "coin"), (_LAID, laid), 0.002, *small)
            yield Pose("discs", ("disc", "disc"), (_LAID, laid), 0.0, y, z)
            yield Pose("edges", ("cube", "cube"), (_EDGE, spin @ _EDGE), 0.1 * math.sqrt(2.0), 0.0, small[1])
        corner = 0.05 + 0.05 * math.sqrt(3.0)
        yield Pose("vertex on face", ("cube", "cube"), (_NONE, _diagonal_along_x()), corner, y, z)
        yield Pose("edge on face", ("cube", "cube"), (_NONE, _EDGE), 0.05 + 0.05 * math.sqrt(2.0), y, z)
        yield Pose("octahedron on face", ("cube", "octahedron"), (_NONE, _NONE), 0.11, y, z)
        yield Pose("cylinder end on face", ("cube", "cylinder"), (_NONE, _LAID), 0.12, y, z)
        yield Pose("rim on face", ("cube", "coin"), (_NONE, _NONE), 0.062, y, z)
        yield Pose("sphere on face", ("cube", "sphere"), (_NONE, _NONE), 0.1, y, z)


def _aligned() -> Iterator[Pose]:
    """Yield round bodies side by side and tip to tip, shifted along their common line."""
    for z in SHIFTS:
        small = min(z, 1e-3)
        for angle in (0.0, 0.7):
            spin = _about("z", angle)
            yield Pose("parallel cylinders", ("cylinder", "cylinder"), (_NONE, spin), 0.1, 0.0, z)
            yield Pose("parallel rounded", ("rounded cylinder", "rounded cylinder"), (_NONE, spin), 0.11, 0.0, z)
            yield Pose("coins rim to rim", ("coin", "coin"), (_NONE, spin), 0.024, 0.0, small)
            yield Pose("parallel capsules", ("capsule", "capsule"), (_NONE, spin), 0.06, 0.0, z)
            yield Pose("flank on face", ("cube", "cylinder"), (_NONE, spin), 0.1, 0.02, z)
    corner = _diagonal_along_x()
    yield Pose("discs rim to rim", ("disc", "disc"), (_NONE, _NONE), 0.1, 0.0, 0.0)
    yield Pose("vertices", ("cube", "cube"), (corner, corner), 0.1 * math.sqrt(3.0), 0.0, 0.0)
    yield Pose("ellipsoids", ("ellipsoid", "ellipsoid"), (_NONE, _NONE), 0.1, 0.0, 0.0)
    yield Pose("flat ellipsoids", ("flat ellipsoid", "flat ellipsoid"), (_LAID, _LAID), 0.004, 0.0, 0.0)
    yield Pose("flat ellipsoids, rims", ("flat ellipsoid", "flat ellipsoid"), (_NONE, _NONE), 0.1, 0.0, 0.0)
    for z in SHIFTS:
        yield Pose("cone on base", ("cone", "cone"), (_LAID, _LAID), 0.1, min(z, 1e-3), 0.0)


POSES = [*_shifted(), *_aligned()]
KINDS = list(dict.fromkeys(pose.name for pose in POSES))


def _check(pose: Pose, gap: float, world: Rotation, origin: Array) -> None:
    """Check the distance of a pose in either order of the shapes."""
    first, second = (SHAPES[name] for name in pose.shapes)
    place = origin + world.apply([pose.reach + gap, pose.y, pose.z])
    turns = [np.roll((world * Rotation.from_matrix(turn)).as_quat(), 1) for turn in pose.turns]
    at: Any = ((origin, turns[0]), (place, turns[1]))
    found, back = ns.distance(first, second, at=at), ns.distance(second, first, at=at[::-1])
    # the pose itself is known up to round-off of its coordinates
    what = f"{pose}, gap {gap}, found {found.gap}"
    assert found.gap >= gap - EXACT, what
    assert abs(found.gap - back.gap) <= EXACT, what
    if gap >= 0.0 or pose.name not in SHORTER:
        assert abs(found.gap - gap) <= EXACT, what
        assert found.lower <= gap + EXACT, what
        assert gap - EXACT <= found.upper <= gap + (1e-9 if abs(gap) < 1e-3 else 1e-6 * abs(gap)), what
    if gap >= 1e-6:
        normal = world.apply([1.0, 0.0, 0.0])
        assert np.linalg.norm(found.normal - normal) <= 1e-6, what


def _of_kind(name: str, every: int) -> None:
    rng = np.random.default_rng([11, *name.encode()])
    cases = itertools.product([pose for pose in POSES if pose.name == name], GAPS, (False, True))
    for pose, gap, is_turned in itertools.islice(cases, None, None, every):
        world = Rotation.random(random_state=rng) if is_turned else Rotation.identity()
        _check(pose, gap, world, rng.uniform(-0.3, 0.3, 3) if is_turned else np.zeros(3))


@pytest.mark.parametrize("name", KINDS)
def test_some_aligned_poses(name: str) -> None:
    """Every kind, in some poses: right to 1e-12 m, apart, touching and overlapping, in either order."""
    of_kind = sum(pose.name == name for pose in POSES) * len(GAPS) * 2
    _of_kind(name, max(1, of_kind // 61))


@pytest.mark.slow
@pytest.mark.parametrize("name", KINDS)
def test_all_aligned_poses(name: str) -> None:
    """Every kind, in all poses."""
    _of_kind(name, 1)


def _least_distance(points: Array) -> float:
    """Return the distance of the hull of points from the origin (C. Lawson, R. Hanson, Solving Least Squares, 1974)."""
    scale = float(np.max(np.abs(points)))
    rows = np.vstack([points.T / scale, np.ones(len(points))])
    weights, _ = nnls(rows, np.array([0.0, 0.0, 0.0, 1.0]))
    # the corners of the face that is nearest; its plane has the accurate distance
    first, *others = points[weights > 0.0]
    edges = np.array(others).reshape(-1, 3) - first
    return float(np.linalg.norm(first + edges.T @ np.linalg.lstsq(edges.T, -first, rcond=None)[0]))


def test_hulls_against_least_squares_and_a_library() -> None:
    """Random hulls, apart by 1e-6 to 0.1 m: non-negative least squares of all differences of corners, and FCL."""
    rng = np.random.default_rng(2)
    for _ in range(60):
        corners = [0.05 * x / np.linalg.norm(x, axis=1)[:, None] for x in (rng.normal(size=(12, 3)) for _ in "ab")]
        one, two = (ConvexHull(x.tolist()) for x in corners)
        way, turn = rng.normal(size=3), Rotation.random(random_state=rng)
        place = 0.15 * way / np.linalg.norm(way)
        quaternion = np.roll(turn.as_quat(), 1)
        far = ns.distance(one, two, at=(None, (place, quaternion)))
        place = place + (10.0 ** rng.uniform(-6.0, -1.0) - far.gap) * far.normal
        found = ns.distance(one, two, at=(None, (place, quaternion)))
        others = place + turn.apply(corners[1])
        exact = _least_distance((others[None] - corners[0][:, None]).reshape(-1, 3))
        assert found.gap == pytest.approx(exact, abs=1e-14)
        assert found.upper - found.lower <= 1e-14
        library = ns.distance(one, two, at=(None, (place, quaternion)), by="fcl")
        assert library.lower <= found.gap <= library.upper
