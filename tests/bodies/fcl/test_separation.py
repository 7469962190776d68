"""Distances by FCL: bounded by support functions, equal to our gaps; every known failure is right or told."""

from __future__ import annotations

import copy
import itertools
import pickle
import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import Box, Capsule, Cone, Cylinder, Disc, HalfSpace, Plane, Point, Sphere
from bodies.distances.pose import Pose
from bodies.distances.separation import DoubtfulDistance, separation
from bodies.fcl.solid import FclSolid as Solid
from nonsmooth.interfaces import ConvexShape
from nonsmooth.plugins import registry
from nonsmooth.system.pairing import nearest_pair
from tests.bodies.carriers import Rig
from tests.bodies.fcl.solids import AXIS, SHAPES, poses

SOLIDS = {name: Solid(shape) for name, shape in SHAPES.items()}


@pytest.mark.parametrize(("one", "two"), list(itertools.combinations_with_replacement(SHAPES, 2)))
def test_pairs(one: str, two: str) -> None:
    """In both orders the same distance; points as far apart, on their own bodies; bounded where both are convex."""
    rng, told = np.random.default_rng([3, len(one), len(two)]), 0
    first, second = SOLIDS[one], SOLIDS[two]
    for _ in range(60):
        pose, other = poses(rng)
        try:
            found, back = separation(first, pose, second, other), separation(second, other, first, pose)
        except DoubtfulDistance:
            assert "cylinder" in (one, two)
            continue
        assert found.overlap == back.overlap
        if found.overlap:
            continue
        told += 1
        assert back.distance == pytest.approx(found.distance, abs=3e-8)
        assert np.linalg.norm(found.second - found.first) == pytest.approx(found.distance, rel=1e-9)
        assert np.isnan(found.lower) == ("mesh" in (one, two))
        if not np.isnan(found.lower):
            assert -1e-8 <= found.distance - found.lower <= 1e-3 * (0.01 + found.distance)
        for solid, at, point in ((first, pose, found.first), (second, other, found.second)):
            shape = solid.shape
            own = at.rotation.T @ (point - at.position)
            if isinstance(shape, ConvexShape):
                # a point of the body is below no support plane
                for direction in rng.normal(size=(20, 3)):
                    assert direction @ own <= direction @ shape.support(direction) + 1e-10
    assert told >= 40


def _single() -> dict[str, tuple[Any, Any]]:
    """Return the pairs of convex shapes that have one contact, in the order of their kinematics."""
    found, known = {}, registry.load_all("kinematics").values()
    for one, two in itertools.combinations_with_replacement(SHAPES, 2):
        pair = nearest_pair(known, SHAPES[one], SHAPES[two])
        if pair is not None and "mesh" not in (one, two):
            shapes = (SHAPES[one], SHAPES[two]) if pair[1] else (SHAPES[two], SHAPES[one])
            if len(pair[0].between(*shapes)) == 1:
                found[f"{one}-{two}"] = shapes
    return found


SINGLE = _single()


def test_there_are_pairs_with_one_contact() -> None:
    assert {"sphere-sphere", "sphere-box", "sphere-capsule", "sphere-cylinder", "capsule-capsule"} <= set(SINGLE)


@pytest.mark.parametrize("name", SINGLE)
def test_an_independent_look_at_our_gaps(name: str, build: Any) -> None:
    """Contact kinematics against FCL, apart and overlapping, on the same random poses."""
    shapes = SINGLE[name]
    rig, rng, seen = Rig(shapes, build.laws()), np.random.default_rng(8), 0
    solids = Solid(shapes[0]), Solid(shapes[1])
    for _ in range(100):
        pose, other = poses(rng)
        turns = [np.roll(Rotation.from_matrix(p.rotation).as_quat(), 1) for p in (pose, other)]
        rig.put([(pose.position, turns[0]), (other.position, turns[1])], np.zeros(12))
        gap = float(np.min(rig.geometry[:, 0]))
        try:
            found = separation(solids[0], pose, solids[1], other)
        except DoubtfulDistance:
            continue
        assert found.overlap == (gap <= 1e-12)
        if not found.overlap:
            seen += 1
            # FCL's points are no nearest ones to the last digit: what is exact lies below, but not below the bound
            assert found.lower - 1e-15 <= gap <= found.distance + 1e-9
            assert found.distance - gap <= 1e-7
    assert seen > 50


TURNS = Rotation.create_group("O").as_matrix()
"""All turns of a cube into itself."""


def test_aligned_boxes_are_right() -> None:
    """Interval by interval, for all relative turns, grid-aligned, touching and overlapping places."""
    rng = np.random.default_rng(2)
    for turn in TURNS:
        one, two = (rng.integers(1, 5, 3) * 0.25 for _ in range(2))
        place = np.asarray(rng.integers(-6, 7, 3) * 0.5, dtype=float)
        found = separation(Solid(Box(*one)), Pose(), Solid(Box(*two)), Pose(place, turn))
        away = np.maximum(np.abs(place) - one - np.abs(turn) @ two, 0.0)
        exact = float(np.linalg.norm(away))
        assert found.distance == pytest.approx(exact, abs=1e-15)
        if exact > 0.0:
            assert found.lower == pytest.approx(exact, abs=1e-15)
    cube = Solid(Box(0.5, 0.5, 0.5))
    assert separation(cube, Pose(), cube, Pose(np.array([4.0, 0.0, 0.0]))).distance == pytest.approx(3.0, abs=1e-15)


@pytest.mark.parametrize(
    "other", [Capsule(0.2, 0.5), Cylinder(0.3, 0.5), Box(0.3, 0.4, 0.5)], ids=["cap", "cyl", "box"]
)
@pytest.mark.parametrize("lean", [0.0, 1e-12, 1e-8, 1e-4])
def test_symmetric_poses_are_right_or_doubted(other: Any, lean: float) -> None:
    """Centred, nearly aligned, on a grid: an answer is within 1e-6 of the bound, and most poses have one."""
    rng, told = np.random.default_rng(4), 0
    box, solid = Solid(Box(0.5, 0.25, 0.75)), Solid(other)
    tilt = Rotation.from_rotvec([lean, 0.0, -lean]).as_matrix()
    for _ in range(100):
        place = np.asarray(rng.integers(-4, 5, 3) * 0.5, dtype=float)
        turn = TURNS[rng.integers(len(TURNS))] @ tilt
        try:
            found = separation(box, Pose(), solid, Pose(place, turn))
        except DoubtfulDistance:
            continue
        told += 1
        if not found.overlap:
            assert found.distance - found.lower <= 1e-6 + 1e-3 * found.distance
    assert told >= 90


def test_a_mesh_and_a_sphere_in_either_order() -> None:
    """The point of the sphere is on the sphere, that of the mesh on the mesh, both in the world."""
    rng = np.random.default_rng(6)
    mesh, sphere = SOLIDS["mesh"], SOLIDS["sphere"]
    for _ in range(50):
        pose, other = poses(rng, 0.03)
        for swapped in (False, True):
            found = separation(sphere, other, mesh, pose) if swapped else separation(mesh, pose, sphere, other)
            if found.overlap:
                continue
            on_mesh, on_sphere = (found.second, found.first) if swapped else (found.first, found.second)
            centre = other.position + other.rotation @ [0.002, 0.0, 0.0]
            assert np.linalg.norm(on_sphere - centre) == pytest.approx(0.006, abs=1e-12)
            low, high = mesh.shape.bounds  # type: ignore[attr-defined]
            own = pose.rotation.T @ (on_mesh - pose.position)
            assert np.all(own >= low - 1e-12)
            assert np.all(own <= high + 1e-12)


def test_what_is_inside_of_a_mesh_overlaps() -> None:
    """FCL sees a hollow surface; a small sphere, and a small mesh, in the foot of the L."""
    small = Solid(Sphere(0.001))
    inside = Pose(np.array([0.0, 0.005, 0.0075]))
    assert separation(SOLIDS["mesh"], Pose(), small, inside).overlap
    assert separation(small, inside, SOLIDS["mesh"], Pose()).overlap
    notch = Pose(np.array([0.015, 0.018, 0.0075]))
    assert separation(small, notch, SOLIDS["mesh"], Pose()).distance == pytest.approx(0.007, abs=1e-12)


@pytest.mark.parametrize("shape", [Plane(), HalfSpace(), Cone(0.01, 0.02), Disc(0.01), Point(0.0, 0.0, 0.0)])
def test_what_fcl_cannot_hold_is_refused(shape: Any) -> None:
    with pytest.raises(ns.InvalidInput, match=r"FCL must be given a bounded solid.*Known: Box, .*contact kinematics"):
        Solid(shape)


def test_a_cone_over_a_half_space_is_ours(build: Any) -> None:
    """FCL is wrong for half of all orientations of these two; the pair of the engine is the height of the support."""
    cone, rng = Cone(0.005, 0.012, y=0.002, **AXIS), np.random.default_rng(9)
    rig = Rig((HalfSpace(0.003), cone), build.laws())
    for _ in range(300):
        (ground, other), up = poses(rng), np.array([0.0, 0.0, 1.0])
        turns = [np.roll(Rotation.from_matrix(p.rotation).as_quat(), 1) for p in (ground, other)]
        rig.put([(ground.position, turns[0]), (other.position, turns[1])], np.zeros(12))
        normal = ground.rotation @ up
        lowest = other.position + other.rotation @ cone.support(-other.rotation.T @ normal)
        height = normal @ (lowest - ground.position) - 0.003
        assert np.min(rig.geometry[:, 0]) == pytest.approx(height, abs=1e-15)


WRONG = {
    "nan": {"position": np.array([np.nan, 0.0, 0.0])},
    "infinite": {"position": np.array([np.inf, 0.0, 0.0])},
    "two numbers": {"position": np.zeros(2)},
    "nan turn": {"rotation": np.full((3, 3), np.nan)},
    "2 x 2": {"rotation": np.eye(2)},
    "stretched": {"rotation": 1.001 * np.eye(3)},
    "mirrored": {"rotation": np.diag([1.0, 1.0, -1.0])},
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_poses_are_refused(name: str) -> None:
    with pytest.raises(ns.InvalidInput, match=r"Pose\.(position|rotation) must be"):
        Pose(**WRONG[name])


def test_meshes_that_would_end_the_process_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Empty, with vertices that are no numbers or do not exist, with triangles of no area: whoever made the shape."""
    shape = SHAPES["mesh"]
    points, faces = shape.drawing()  # type: ignore[attr-defined]
    broken = points.copy()
    broken[2] = np.nan
    flat = np.concatenate([faces, [[0, 0, 1]]])
    for wrong in ((points, faces[:0]), (points[:0], faces[:0]), (broken, faces), (points, faces + 5), (points, flat)):
        monkeypatch.setattr(type(shape), "drawing", lambda self, fineness=24, wrong=wrong: wrong)
        with pytest.raises(ns.InvalidInput, match=r"^FCL must be given (triangles of finite|no triangle of zero)"):
            Solid(shape)


def test_solids_are_pickled_and_copied() -> None:
    for solid in SOLIDS.values():
        for again in (pickle.loads(pickle.dumps(solid)), copy.deepcopy(solid)):
            assert again.shape == solid.shape
            pose, other = Pose(), Pose(np.array([0.05, 0.01, 0.0]))
            assert (
                separation(again, pose, SOLIDS["box"], other).distance
                == separation(solid, pose, SOLIDS["box"], other).distance
            )


def test_one_solid_at_two_places() -> None:
    ball = SOLIDS["sphere"]
    assert separation(ball, Pose(), ball, Pose(np.array([0.0, 0.02, 0.0]))).distance == pytest.approx(0.008, abs=1e-15)


_OVERLAPS = """
import numpy as np
from scipy.spatial.transform import Rotation
from bodies.distances.separation import DoubtfulDistance, separation
from bodies.distances.pose import Pose
from bodies.fcl.solid import FclSolid as Solid
from tests.bodies.fcl.solids import SHAPES

rng, count, missed = np.random.default_rng(0), 0, 0
for one, two in (("capsule", "box"), ("ellipsoid", "box"), ("cylinder", "cylinder"), ("ellipsoid", "ellipsoid")):
    first, second = SHAPES[one], SHAPES[two]
    a, b = Solid(first), Solid(second)
    for _ in range(500):
        turn = Rotation.random(2, rng).as_matrix()
        n = rng.normal(size=3)
        n /= np.linalg.norm(n)
        depth = 10.0 ** rng.uniform(-9.0, -4.0)
        on_a, on_b = turn[0] @ first.support(turn[0].T @ n), turn[1] @ second.support(turn[1].T @ -n)
        try:
            found = separation(a, Pose(np.zeros(3), turn[0]), b, Pose(on_a - on_b - depth * n, turn[1]))
        except DoubtfulDistance:
            continue
        count += 1
        missed += not found.overlap
ball = Solid(SHAPES["sphere"])
print(count >= 1990, missed, separation(ball, Pose(), ball, Pose()).overlap)
"""


def test_overlaps_do_not_end_the_process() -> None:
    """Depths of 1e-9 to 1e-4 m, for which signed queries abort, and concentric spheres, which they hang on."""
    done = subprocess.run([sys.executable, "-c", _OVERLAPS], capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["True", "0", "True"]


def test_axes_of_capsules_and_cylinders_are_ours() -> None:
    """A probe along the axis finds the end at radius plus half-length, or half-length."""
    axis = np.array([AXIS["axis_x"], 0.0, AXIS["axis_z"]])
    probe = Solid(Sphere(0.001))
    for name, end in (("capsule", 0.01), ("cylinder", 0.007)):
        centre = np.array([0.0, 0.002, 0.0]) if name == "cylinder" else np.zeros(3)
        found = separation(SOLIDS[name], Pose(), probe, Pose(centre + 0.03 * axis))
        assert found.distance == pytest.approx(0.029 - end, abs=1e-12)


def test_a_tree_that_was_not_built_is_refused() -> None:
    """A model of FCL's own, empty or never ended, which ends the process in a query: only shapes are taken."""
    import fcl

    for model in (fcl.BVHModel(), fcl.DynamicAABBTreeCollisionManager(), fcl.Halfspace(np.array([0.0, 0.0, 1.0]), 0.0)):
        with pytest.raises(ns.InvalidInput, match=r"FCL must be given a bounded solid"):
            Solid(model)


_LIVES = """
import gc
import numpy as np
from bodies import Box, Ellipsoid, TriangleMesh, Triangles
from bodies.distances.pose import Pose
from bodies.distances.separation import separation
from bodies.fcl.broad_phase import BroadPhase
from bodies.fcl.solid import FclSolid
from tests.bodies.meshes import parts


def solid(kind):
    if kind % 3 == 0:
        return FclSolid(Box(0.01, 0.02, 0.03))
    return FclSolid(Ellipsoid(0.01, 0.02, 0.03) if kind % 3 == 1 else TriangleMesh(Triangles(*parts.bracket())))


kept = [solid(i) for i in range(30)]
first = [separation(one, Pose(), kept[(i + 1) % 30], Pose(np.array([0.2, 0.01, 0.0]))) for i, one in enumerate(kept)]
tree, places = BroadPhase(np.full(100, 0.05)), np.random.default_rng(0).uniform(-0.3, 0.3, (100, 3))
pairs = tree.pairs(places)
for _ in range(20):
    # others come and go on the same memory
    gone = [solid(i) for i in range(30)]
    separation(gone[0], Pose(), gone[1], Pose(np.array([0.2, 0.0, 0.0])))
    BroadPhase(np.full(50, 0.1)).pairs(places[:50])
    del gone
    gc.collect()
again = [separation(one, Pose(), kept[(i + 1) % 30], Pose(np.array([0.2, 0.01, 0.0]))) for i, one in enumerate(kept)]
same = all(a.distance == b.distance and np.array_equal(a.first, b.first) for a, b in zip(first, again))
print(same, np.array_equal(pairs, tree.pairs(places)))
"""


def test_objects_live_as_long_as_they_are_needed() -> None:
    """Shapes and arrays that nobody else holds, and others made and forgotten between two queries."""
    done = subprocess.run([sys.executable, "-c", _LIVES], capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["True", "True"]
