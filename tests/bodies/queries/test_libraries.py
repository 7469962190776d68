"""Distances by FCL and coal: bounded by support functions; every known failure is right or told."""

from __future__ import annotations

import itertools
import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import Box, Capsule, Cylinder, Disc, HalfSpace, Plane, Point, Sphere, Superellipsoid
from bodies.queries.coal import Coal
from bodies.queries.fcl import Fcl
from bodies.queries.library import Library
from nonsmooth.errors import DoubtfulDistance
from nonsmooth.interfaces import ConvexShape, Shape
from nonsmooth.interfaces.distance_backend import Place, Separation
from tests.bodies.queries.solids import AXIS, HERE, ROUNDED, SHAPES, at, places

LIBRARIES = {
    "fcl": Fcl(),
    "coal": pytest.param(Coal(), marks=pytest.mark.skipif(not Coal().installed, reason="needs nonsmooth[coal]")),
}
each = pytest.mark.parametrize("library", LIBRARIES.values(), ids=LIBRARIES)
ALL = {**SHAPES, **ROUNDED}


def ask(library: Library, first: Shape, one: Place, second: Shape, two: Place) -> Separation:
    solids = library.solid(first), library.solid(second)
    assert solids[0] is not None
    assert solids[1] is not None
    return library.separation(solids[0], one, solids[1], two)


@pytest.mark.fast_cases(8)
@each
@pytest.mark.parametrize(("one", "two"), list(itertools.combinations_with_replacement(ALL, 2)))
def test_pairs(library: Library, one: str, two: str) -> None:
    """In both orders the same distance; points as far apart, on their own bodies; bounded where both are convex."""
    rng, told = np.random.default_rng([3, len(one), len(two)]), 0
    first, second = ALL[one], ALL[two]
    for _ in range(30):
        here, there = places(rng)
        try:
            found, back = ask(library, first, here, second, there), ask(library, second, there, first, here)
        except DoubtfulDistance:
            continue
        told += 1
        assert found.overlap == back.overlap
        if found.overlap:
            continue
        assert back.distance == pytest.approx(found.distance, abs=3e-8)
        np.testing.assert_allclose(found.second - found.first, found.distance * found.normal, atol=1e-9)
        for shape, (place, axes), point in ((first, here, found.first), (second, there, found.second)):
            if isinstance(shape, ConvexShape):
                # a point of the body is below no support plane
                own = axes.T @ (point - place)
                for direction in rng.normal(size=(20, 3)):
                    assert direction @ own <= direction @ shape.support(direction) + 1e-9
        if isinstance(first, ConvexShape) and isinstance(second, ConvexShape):
            n = found.normal
            low = there[0] + there[1] @ second.support(-there[1].T @ n)
            lower = n @ (low - here[0] - here[1] @ first.support(here[1].T @ n))
            assert lower - 1e-8 <= found.distance <= lower + 1e-3 * (0.01 + abs(found.distance))
    assert told >= 20


@pytest.mark.skipif(not Coal().installed, reason="needs nonsmooth[coal]")
@pytest.mark.parametrize(("one", "two"), list(itertools.combinations_with_replacement(SHAPES, 2)))
def test_both_libraries_agree(one: str, two: str) -> None:
    """To 3e-8 m, where neither is in doubt; overlaps too."""
    rng, compared = np.random.default_rng([7, len(one), len(two)]), 0
    for _ in range(40):
        here, there = places(rng)
        try:
            ours, theirs = (ask(library, SHAPES[one], here, SHAPES[two], there) for library in (Coal(), Fcl()))
        except DoubtfulDistance:
            continue
        compared += 1
        assert ours.overlap == theirs.overlap
        if not ours.overlap:
            assert ours.distance == pytest.approx(theirs.distance, abs=3e-8)
    assert compared >= 30


TURNS = Rotation.create_group("O").as_matrix()
"""All turns of a cube into itself."""


@each
def test_aligned_boxes_are_right(library: Library) -> None:
    """Interval by interval, for all relative turns, grid-aligned, touching and overlapping places."""
    rng = np.random.default_rng(2)
    for turn in TURNS:
        one, two = (rng.integers(1, 5, 3) * 0.25 for _ in range(2))
        place = np.asarray(rng.integers(-6, 7, 3) * 0.5, dtype=float)
        found = ask(library, Box(*one), HERE, Box(*two), (place, turn))
        away = np.maximum(np.abs(place) - one - np.abs(turn) @ two, 0.0)
        exact = float(np.linalg.norm(away))
        assert found.overlap == (exact == 0.0)
        if exact > 0.0:
            assert found.distance == pytest.approx(exact, abs=1e-15)


@pytest.mark.fast_cases(6)
@each
@pytest.mark.parametrize(
    "other", [Capsule(0.2, 0.5), Cylinder(0.3, 0.5), Box(0.3, 0.4, 0.5)], ids=["cap", "cyl", "box"]
)
@pytest.mark.parametrize("lean", [0.0, 1e-12, 1e-8, 1e-4])
def test_symmetric_poses_are_right_or_doubted(library: Library, other: Any, lean: float) -> None:
    """Centred, nearly aligned, on a grid: an answer is what our planes say, and most poses have one."""
    rng, told = np.random.default_rng(4), 0
    box = Box(0.5, 0.25, 0.75)
    tilt = Rotation.from_rotvec([lean, 0.0, -lean]).as_matrix()
    for _ in range(50):
        place = np.asarray(rng.integers(-4, 5, 3) * 0.5, dtype=float)
        turn = TURNS[rng.integers(len(TURNS))] @ tilt
        try:
            found = ask(library, box, HERE, other, (place, turn))
        except DoubtfulDistance:
            continue
        told += 1
        quaternion = np.roll(Rotation.from_matrix(turn).as_quat(), 1)
        ours = ns.distance(box, other, at=(None, (place, quaternion)))
        assert found.overlap == (ours.gap <= 1e-12)
        if not found.overlap:
            assert found.distance == pytest.approx(ours.gap, abs=1e-5)
    assert told >= 45


@each
def test_a_mesh_and_a_sphere_in_either_order(library: Library) -> None:
    """The point of the sphere is on the sphere, that of the mesh on the mesh, both in the world."""
    rng = np.random.default_rng(6)
    mesh, sphere = SHAPES["mesh"], SHAPES["sphere"]
    for _ in range(50):
        here, there = places(rng, 0.03)
        for swapped in (False, True):
            found = ask(library, sphere, there, mesh, here) if swapped else ask(library, mesh, here, sphere, there)
            if found.overlap:
                continue
            on_mesh, on_sphere = (found.second, found.first) if swapped else (found.first, found.second)
            centre = there[0] + there[1] @ [0.002, 0.0, 0.0]
            assert np.linalg.norm(on_sphere - centre) == pytest.approx(0.006, abs=1e-12)
            low, high = mesh.bounds  # type: ignore[attr-defined]
            own = here[1].T @ (on_mesh - here[0])
            assert np.all(own >= low - 1e-12)
            assert np.all(own <= high + 1e-12)


@each
def test_what_is_inside_of_a_mesh_overlaps(library: Library) -> None:
    """Libraries see a hollow surface; a small sphere in the foot of the L, and in its notch."""
    mesh, small = SHAPES["mesh"], Sphere(0.001)
    inside = at(0.0, 0.005, 0.0075)
    assert ask(library, mesh, HERE, small, inside).overlap
    assert ask(library, small, inside, mesh, HERE).overlap
    found = ask(library, small, at(0.015, 0.018, 0.0075), mesh, HERE)
    assert found.distance == pytest.approx(0.007, abs=1e-12)


@each
@pytest.mark.parametrize(
    "shape", [Plane(), HalfSpace(), Disc(0.01), Point(), Superellipsoid(0.01, 0.01, 0.01, 0.5, 0.5)]
)
def test_a_kind_that_a_library_lacks_is_none_of_its_solids(library: Library, shape: Any) -> None:
    assert library.solid(shape) is None


@each
def test_meshes_that_would_end_the_process_are_refused(library: Library, monkeypatch: pytest.MonkeyPatch) -> None:
    """Empty, with vertices that are no numbers or do not exist, with triangles of no area: whoever made the shape."""
    shape = SHAPES["mesh"]
    points, faces = shape.drawing()  # type: ignore[attr-defined]
    broken = points.copy()
    broken[2] = np.nan
    flat = np.concatenate([faces, [[0, 0, 1]]])
    for wrong in ((points, faces[:0]), (points[:0], faces[:0]), (broken, faces), (points, faces + 5), (points, flat)):
        monkeypatch.setattr(type(shape), "drawing", lambda self, fineness=24, wrong=wrong: wrong)
        with pytest.raises(ns.InvalidInput, match=r"must be given (triangles of finite|no triangle of zero)"):
            library.solid(shape)


def test_a_tree_that_was_not_built_is_none_of_its_solids() -> None:
    """A model of FCL's own, empty or never ended, which ends the process in a query: only shapes are taken."""
    import fcl

    for model in (fcl.BVHModel(), fcl.DynamicAABBTreeCollisionManager(), fcl.Halfspace(np.array([0.0, 0.0, 1.0]), 0.0)):
        assert Fcl().solid(model) is None
        with pytest.raises(ns.InvalidInput, match="must be asked of bodies or shapes"):
            ns.distance(model, Sphere(0.01))


@each
def test_axes_of_round_solids_are_ours(library: Library) -> None:
    """A probe along the axis finds the end at radius plus half-length, or half-length, or the apex."""
    axis = np.array([AXIS["axis_x"], 0.0, AXIS["axis_z"]])
    for name, end in (("capsule", 0.01), ("cylinder", 0.007), ("rounded cylinder", 0.007), ("cone", 0.012)):
        centre = np.array([ALL[name].x, ALL[name].y, ALL[name].z])  # type: ignore[attr-defined]
        found = ask(library, ALL[name], HERE, Sphere(0.001), (centre + 0.03 * axis, np.eye(3)))
        assert found.distance == pytest.approx(0.029 - end, abs=1e-9)


_OVERLAPS = """
import numpy as np
from scipy.spatial.transform import Rotation
from nonsmooth.errors import DoubtfulDistance
from bodies.queries.{name} import {kind}
from tests.bodies.queries.solids import HERE, SHAPES

library, rng, count, missed = {kind}(), np.random.default_rng(0), 0, 0
for one, two in (("capsule", "box"), ("ellipsoid", "box"), ("cylinder", "cylinder"), ("ellipsoid", "ellipsoid")):
    first, second = SHAPES[one], SHAPES[two]
    a, b = library.solid(first), library.solid(second)
    for _ in range(500):
        turn = Rotation.random(2, rng).as_matrix()
        n = rng.normal(size=3)
        n /= np.linalg.norm(n)
        depth = 10.0 ** rng.uniform(-9.0, -4.0)
        on_a, on_b = turn[0] @ first.support(turn[0].T @ n), turn[1] @ second.support(turn[1].T @ -n)
        try:
            found = library.separation(a, (np.zeros(3), turn[0]), b, (on_a - on_b - depth * n, turn[1]))
        except DoubtfulDistance:
            continue
        count += 1
        missed += not found.overlap
ball = library.solid(SHAPES["sphere"])
print(count >= 1700, missed, library.separation(ball, HERE, ball, HERE).overlap)
"""


@pytest.mark.slow
@each
def test_overlaps_do_not_end_the_process(library: Library) -> None:
    """Depths of 1e-9 to 1e-4 m, for which signed queries abort, and concentric spheres, which they hang on."""
    kind = type(library).__name__
    code = _OVERLAPS.format(name=kind.lower(), kind=kind)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["True", "0", "True"]


_LIVES = """
import gc
import numpy as np
from bodies import Box, Ellipsoid, TriangleMesh, Triangles
from bodies.queries.fcl import Fcl
from tests.bodies.meshes import parts
from tests.bodies.queries.solids import HERE, at

library = Fcl()


def solid(kind):
    if kind % 3 == 0:
        return library.solid(Box(0.01, 0.02, 0.03))
    return library.solid(Ellipsoid(0.01, 0.02, 0.03) if kind % 3 == 1 else TriangleMesh(Triangles(*parts.bracket())))


kept, there = [solid(i) for i in range(30)], at(0.2, 0.01, 0.0)
first = [library.separation(one, HERE, kept[(i + 1) % 30], there) for i, one in enumerate(kept)]
for _ in range(20):
    # others come and go on the same memory
    gone = [solid(i) for i in range(30)]
    library.separation(gone[0], HERE, gone[1], there)
    del gone
    gc.collect()
again = [library.separation(one, HERE, kept[(i + 1) % 30], there) for i, one in enumerate(kept)]
print(all(a.distance == b.distance and np.array_equal(a.first, b.first) for a, b in zip(first, again)))
"""


@pytest.mark.slow
def test_objects_live_as_long_as_they_are_needed() -> None:
    """Shapes and arrays that nobody else holds, and others made and forgotten between two queries."""
    done = subprocess.run([sys.executable, "-c", _LIVES], capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["True"]
