"""ns.distance: closed forms, symmetry, frame invariance and bounds for every pair of kinds; every error by its name."""

from __future__ import annotations

import itertools
import math
import subprocess
import sys
from typing import Any

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import (
    Ball,
    Box,
    Capsule,
    Compound,
    Cylinder,
    CylinderBody,
    DrivenBody,
    Egg,
    Ellipsoid,
    HalfSpace,
    MovedShape,
    Part,
    Plane,
    Plate,
    Point,
    Rest,
    Sphere,
    TriangleMesh,
    Triangles,
)
from bodies.queries.coal import Coal
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.errors import MissingPackagesError
from nonsmooth.histories.distances import distances
from nonsmooth.interfaces import ConvexShape
from nonsmooth.plugins import registry
from nonsmooth.rotations import rotation
from tests.bodies.given_shapes import EllipsoidSum, Lens
from tests.bodies.meshes.parts import bracket, hills
from tests.queries.shapes import SHAPES, UNBOUNDED, Pose, pose
from tests.solids.separation import nearest, piece_of

PAIRS = [pair for pair in itertools.combinations_with_replacement(SHAPES, 2) if not set(pair) <= set(UNBOUNDED)]


def test_shapes_of_all_kinds_are_asked_of() -> None:
    """Those known by their farthest points below, with shapes of users."""
    by_points = {Egg, MovedShape}
    assert {type(shape) for shape in SHAPES.values()} | by_points == set(registry.load_all("shapes").values())


def _turned(one: Pose, turn: Rotation, shift: np.ndarray) -> Pose:
    own = Rotation.from_quat(np.roll(one[1], -1))
    return turn.apply(one[0]) + shift, np.roll((turn * own).as_quat(), 1)


@pytest.mark.fast_cases(12)
@pytest.mark.parametrize(("one", "two"), PAIRS)
def test_every_pair_has_an_answer(one: str, two: str) -> None:
    """Near, far and overlapping: it says how, lies between its bounds, and depends on no order and no frame."""
    rng = np.random.default_rng([5, *f"{one}-{two}".encode()])
    first, second = SHAPES[one], SHAPES[two]
    turn, shift = Rotation.random(random_state=rng), rng.uniform(-0.1, 0.1, 3)
    for reach in (0.004, 0.012, 0.05):
        at = pose(rng, reach), pose(rng, reach)
        found = ns.distance(first, second, at=at)
        assert found.how == "pair"
        assert found.lower <= found.gap <= found.upper
        assert np.linalg.norm(found.normal) == pytest.approx(1.0, abs=1e-12)
        # what is told of a deep overlap lies between bounds, and what answers is the search's affair
        slack = 1e-8 + (found.upper - found.lower)
        back = ns.distance(second, first, at=at[::-1])
        moved = ns.distance(first, second, at=[_turned(one, turn, shift) for one in at])
        for other in (back, moved):
            assert other.lower - slack <= found.gap <= other.upper + slack
        if found.gap > 1e-6:
            np.testing.assert_allclose(found.second - found.first, found.gap * found.normal, atol=1e-9)
            np.testing.assert_allclose(back.normal, -found.normal, atol=1e-4)
            np.testing.assert_allclose(moved.normal, turn.apply(found.normal), atol=1e-4)


CONVEX = [pair for pair in PAIRS if "mesh" not in pair and pair[0] not in UNBOUNDED and pair != ("point", "point")]
SHARP = "point", "box", "hull", "cylinder", "cylinder on feet", "cone", "disc"


@pytest.mark.fast_cases(12)
@pytest.mark.parametrize(("one", "two"), CONVEX)
def test_along_the_normal_the_gap_is_the_way(one: str, two: str) -> None:
    """Convex bodies moved along the normal come as near as they are moved, to either side of touching.

    Where neither has a sharp place, the way back is the shortest way out; where one has, another may be shorter.
    """
    rng = np.random.default_rng([6, *f"{one}-{two}".encode()])
    first, second = SHAPES[one], SHAPES[two]
    at = pose(rng, 0.03), pose(rng, 0.03)
    found = ns.distance(first, second, at=at)
    while found.gap <= 0.0:
        at = pose(rng, 0.03), pose(rng, 0.03)
        found = ns.distance(first, second, at=at)
    feet = 2e-6 if "cylinder on feet" in (one, two) else 0.0
    for gap in (1e-3, 1e-6, 1e-9, -1e-9, -1e-7, -1e-6):
        place = at[1][0] + (gap - found.gap) * found.normal
        near = ns.distance(first, second, at=(at[0], (place, at[1][1])))
        slack = 1e-12 + 2e-3 * max(-gap, 0.0) + feet
        assert near.gap >= gap - slack
        if gap > 0.0 or not {one, two} & set(SHARP):
            assert near.gap <= gap + slack
            assert near.lower - slack <= gap <= near.upper + slack


lengths = st.floats(1e-3, 0.1)
numbers = st.floats(-0.2, 0.2)


@pytest.mark.slow
@given(lengths, lengths, numbers, numbers, numbers)
def test_two_spheres(r: float, s: float, x: float, y: float, z: float) -> None:
    """|x| - r - s, whatever overlaps, both in one place too."""
    found = ns.distance(Sphere(r), Sphere(s), at=(None, (x, y, z)))
    assert found.gap == pytest.approx(math.hypot(x, y, z) - r - s, abs=1e-9 if math.hypot(x, y, z) < 1e-6 else 1e-15)


@pytest.mark.slow
@given(st.tuples(lengths, lengths, lengths), st.tuples(lengths, lengths, lengths), st.tuples(numbers, numbers, numbers))
@settings(max_examples=60)
def test_two_boxes_along_the_axes(one: Any, two: Any, place: Any) -> None:
    """Interval by interval: the distance, or the least of the ways along the axes."""
    over = np.abs(place) - one - np.array(two)
    found = ns.distance(Box(*one), Box(*two), at=(None, place))
    exact = np.linalg.norm(np.maximum(over, 0.0)) if np.any(over > 0.0) else np.max(over)
    assert found.gap == pytest.approx(exact, abs=1e-13)


@pytest.mark.slow
@given(st.tuples(numbers, numbers, numbers), st.tuples(lengths, lengths, lengths))
def test_a_point_and_a_box(place: Any, halves: Any) -> None:
    """A point has no contacts with spheres and cylinders, but a distance."""
    over = np.abs(place) - np.array(halves)
    exact = np.linalg.norm(np.maximum(over, 0.0)) if np.any(over > 0.0) else np.max(over)
    found = ns.distance(Point(*place), Box(*halves))
    assert found.gap == pytest.approx(exact, abs=1e-13)
    assert ns.distance(Point(*place), Sphere(0.01)).gap == pytest.approx(math.hypot(*place) - 0.01, abs=1e-5)


def test_ways_agree_where_each_tells() -> None:
    """Convex parts and libraries, at a place where each of them answers."""
    box, ellipsoid, at = Box(0.01, 0.02, 0.03), Ellipsoid(0.01, 0.01, 0.02), (None, (0.025, 0.005, 0.01))
    exact = ns.distance(box, ellipsoid, at=at)
    assert exact.how == "pair"
    assert exact.error <= 1e-13
    ways = ["pair", "fcl", *(["coal"] if Coal().installed else [])]
    for by in ways:
        found = ns.distance(box, ellipsoid, at=at, by=by)
        assert found.how == by
        assert found.gap == pytest.approx(exact.gap, abs=1e-9)
        np.testing.assert_allclose(found.normal, exact.normal, atol=1e-6)


def test_a_cylinder_on_its_feet_touches_a_surface(build: Any) -> None:
    """The solid is deeper than the feet by their height: contacts hold all the same, not the way out of the hulls."""
    ground = DrivenBody(carried=(TriangleMesh(Triangles(*hills(10))),))
    cylinder = CylinderBody(0.05, 0.04, 1000.0)
    system = ns.System([ground, cylinder])
    system.contact(ground, cylinder, **build.laws(0.2, 0.5))
    system.place(cylinder, position=(0.1, 0.1, 0.1))
    history = distances(ns.simulate(system, 0.5, sample_interval=0.01), ground, cylinder)
    assert np.count_nonzero(history["gap"] < 1e-9) > 5
    assert np.min(history["gap"]) > -1e-9
    assert set(history["how"].tolist()) == {"pair"}


def test_corners_may_be_nearest() -> None:
    """Two cubes corner to corner, whose contacts do not face each other."""
    one, two = Box(0.01, 0.01, 0.01), Box(0.01, 0.01, 0.01)
    found = ns.distance(one, two, at=(None, (0.03, 0.04, 0.05)))
    assert found.gap == pytest.approx(math.hypot(0.01, 0.02, 0.03), abs=1e-15)


def test_crossed_bars_have_a_way_out_though_nothing_faces() -> None:
    """Bars across each other with no corner inside: the way out is proved from both sides."""
    bar, turn = Box(0.1, 0.01, 0.01), (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))
    found = ns.distance(bar, bar, at=(None, ((0.0, 0.0, 0.004), turn)))
    assert found.gap == pytest.approx(-0.016, abs=1e-15)
    assert found.upper == pytest.approx(-0.016, rel=1e-2)
    assert found.normal[2] == pytest.approx(1.0)


def test_a_solid_holds_what_is_inside() -> None:
    """A ball inside of a mesh that it touches nowhere, a ball inside of a box, a box inside of a box."""
    mesh = TriangleMesh(Triangles(*bracket(0.1), "bracket"))
    centre = mesh.solid.inner[0]
    held = ns.distance(mesh, Sphere(0.001), at=(None, centre))
    assert held.upper < 0.0
    assert held.gap <= held.upper
    assert ns.distance(Box(0.1, 0.1, 0.1), Sphere(0.01)).gap == pytest.approx(-0.11, abs=1e-12)
    assert ns.distance(Box(0.1, 0.2, 0.3), Box(0.01, 0.01, 0.01)).gap == pytest.approx(-0.11, abs=1e-12)


def test_bodies_and_their_shapes() -> None:
    """The nearest shape of a body is told by number; a driven body stands where its motion has it."""
    first = Compound((Part(Ball(0.01), position=(-0.05, 0.0, 0.0)), Part(Ball(0.02), position=(0.05, 0.0, 0.0))))
    centres = [np.array([shape.x, shape.y, shape.z]) for shape in first.shapes]  # type: ignore[attr-defined]
    found = ns.distance(first, Ball(0.01), at=(None, (0.1, 0.0, 0.0)))
    assert found.gap == pytest.approx(0.1 - centres[1][0] - 0.03, abs=1e-15)
    assert found.shapes == (1, 0)
    assert ns.distance(Ball(0.01), first, at=((0.1, 0.0, 0.0), None)).shapes == (0, 1)
    two = DrivenBody(Rest(), (Box(0.01, 0.01, 0.01), Sphere(0.01, z=0.03)))
    corner = Box(0.01, 0.01, 0.01, x=0.03, y=0.03, z=0.03)
    # the sphere reaches up to 0.04 m, but only beside the corner, and so is farther from it than the box
    apart = [ns.distance(shape, corner).gap for shape in two.frames[0]]
    found = ns.distance(two, corner)
    assert found.gap == min(apart)
    assert found.shapes == (apart.index(min(apart)), 0)
    wall = DrivenBody(Rest(position=(0.0, 0.0, -1.0)), (HalfSpace(),))
    assert ns.distance(wall, Ball(0.25)).gap == pytest.approx(0.75, abs=1e-15)
    assert ns.distance(wall, Ball(0.25), at=((0.0, 0.0, 0.0), None)).gap == pytest.approx(-0.25, abs=1e-15)
    # planes of two bodies have no distance, their other shapes have
    held = DrivenBody(Rest(position=(0.0, 0.0, 1.0)), (HalfSpace(-3.0), Sphere(0.5)))
    assert ns.distance(wall, held).gap == pytest.approx(1.5, abs=1e-15)
    assert ns.distance(wall, held).shapes == (0, 1)


@pytest.mark.slow
def test_a_mesh_with_too_many_features_for_contacts() -> None:
    """It has a distance all the same, that which a library finds."""
    import trimesh

    solid = trimesh.creation.icosphere(3, 0.01)
    ball = TriangleMesh(Triangles(solid.vertices, solid.faces, "ball"))
    found = ns.distance(ball, ball, at=(None, (0.03, 0.001, 0.002)))
    assert found.how == "pair"
    assert math.hypot(0.03, 0.001, 0.002) - 0.02 <= found.gap <= math.hypot(0.03, 0.001, 0.002) - 0.0195
    assert 0.0 <= found.error < 1e-7
    library = ns.distance(ball, ball, at=(None, (0.03, 0.001, 0.002)), by="fcl")
    assert library.lower <= found.gap <= library.upper


WRONG: dict[str, tuple[Any, Any, dict[str, Any], str]] = {
    "no body": (3.0, Sphere(0.1), {}, "must be asked of bodies or shapes"),
    "one pose": (Sphere(0.1), Sphere(0.1), {"at": [None]}, "must be two poses"),
    "no pose": (Sphere(0.1), Sphere(0.1), {"at": (None, 3.0)}, r"at\[1\] must be a position, or a position and"),
    "two numbers": (Sphere(0.1), Sphere(0.1), {"at": (None, (0.0, 0.0))}, r"at\[1\]: position must be 3 finite"),
    "nan": (Sphere(0.1), Box(0.1, 0.1, 0.1), {"at": (None, (0.0, math.nan, 0.0))}, "must be 3 finite numbers"),
    "infinite": (Sphere(0.1), Box(0.1, 0.1, 0.1), {"at": ((math.inf, 0.0, 0.0), None)}, "must be 3 finite numbers"),
    "long quaternion": (Sphere(0.1), Sphere(0.1), {"at": (None, ((0, 0, 0), (1, 1, 0, 0)))}, "must have unit length"),
    "nan quaternion": (Sphere(0.1), Sphere(0.1), {"at": (None, ((0, 0, 0), (math.nan, 0, 0, 0)))}, "4 finite numbers"),
    "two planes": (Plane(), HalfSpace(), {}, "Two planes have no nearest points"),
    "two plates": (Plate(), Plate(), {}, "Two planes have no nearest points"),
    "unknown way": (Sphere(0.1), Sphere(0.1), {"by": "pairs"}, "Did you mean 'pair'"),
    "plane by a library": (Plane(), Sphere(0.1), {"by": "fcl"}, "must be asked of shapes that it has a kind for"),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_questions_are_refused(name: str) -> None:
    first, second, words, says = WRONG[name]
    with pytest.raises(ns.InvalidInput, match=says):
        ns.distance(first, second, **words)


def test_a_library_tells_no_depth() -> None:
    with pytest.raises(ns.NoDistance, match="they overlap, and it tells no depth"):
        ns.distance(Sphere(0.1), Box(0.1, 0.1, 0.1), by="fcl")


def test_a_missing_library_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Coal, "installed", False)
    with pytest.raises(MissingPackagesError, match=r'pip install "nonsmooth\[coal\]"'):
        ns.distance(Sphere(0.1), Sphere(0.1), by="coal")


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize(
    "shape", [EllipsoidSum(), Lens(), Lens(rounding=1e-3), Egg(), MovedShape(Egg(), x=2e-3)], ids=repr
)
@pytest.mark.parametrize("other", ["plane", "point", "box", "cylinder", "ellipsoid", "mesh"])
def test_shapes_of_users(shape: ConvexShape, other: str) -> None:
    """What has nothing but farthest points is asked like all others; a search in Python agrees."""
    rng = np.random.default_rng([9, *other.encode()])
    for reach in (0.01, 0.02, 0.05):
        at = pose(rng, reach), pose(rng, reach)
        found = ns.distance(shape, SHAPES[other], at=at)
        assert found.lower <= found.gap <= found.upper
        if found.gap > 0.0 and other not in ("plane", "mesh"):
            one, two = (piece_of(each, p, rotation(q)) for each, (p, q) in zip((shape, SHAPES[other]), at, strict=True))
            assert found.gap == pytest.approx(nearest(one, two, 1e-15).lower, abs=1e-12)


def test_aligned_boxes_on_a_grid() -> None:
    """Where FCL is wrong: centred, on a grid, turned by quarters, touching and overlapping."""
    rng = np.random.default_rng(2)
    for turn in Rotation.create_group("O"):
        one, two = (rng.integers(1, 5, 3) * 0.25 for _ in range(2))
        place = np.asarray(rng.integers(-6, 7, 3) * 0.5, dtype=float)
        over = np.abs(place) - one - np.abs(turn.as_matrix()) @ two
        exact = np.linalg.norm(np.maximum(over, 0.0)) if np.any(over > 0.0) else np.max(over)
        found = ns.distance(Box(*one), Box(*two), at=(None, (place, np.roll(turn.as_quat(), 1))))
        assert found.gap == pytest.approx(exact, abs=1e-12)
        assert found.lower - 1e-12 <= exact <= found.upper + 1e-12


@pytest.mark.parametrize("one", [Sphere(0.01), Box(0.01, 0.01, 0.01), Capsule(0.01, 0.02), Cylinder(0.01, 0.01)])
def test_concentric_bodies(one: Any) -> None:
    """A body out of itself: by its least width, 2 cm."""
    depth, found = 0.02, ns.distance(one, one)
    assert found.gap == pytest.approx(-depth, rel=2e-2)
    assert -found.upper <= depth * (1.0 + 1e-12)
    assert -found.lower >= depth * (1.0 - 1e-12)
    assert np.all(np.isfinite(found.normal))


_CODE = """
import numpy as np
import nonsmooth as ns
from nonsmooth.histories.distances import distances
from tests.solids.separation import nearest, piece_of
from tests.queries.shapes import SHAPES, UNBOUNDED, pose
from tests.benchmarks.random_queries import ask

tally = ask(600, seed=3)
print(tally.asked, tally.wrong)
"""


@pytest.mark.slow
def test_a_ball_at_rest_in_a_bowl_of_single_precision_touches_it() -> None:
    """Contacts see faces that digits have bent as flat ones; the way out through the wall is no answer then."""
    arc = np.linspace(0.0, -math.pi / 2.0, 9)
    hollow = [(0.1 * math.cos(a), 0.1 * math.sin(a)) for a in arc[:-1]] + [(0.0, -0.1)]
    outline = np.array([(0.0, -0.11), (0.11, -0.11), (0.11, 0.0), *hollow])
    made = trimesh.creation.revolve(outline, sections=24)
    vertices = np.asarray(made.vertices, np.float32).astype(float)
    shape = TriangleMesh(Triangles(vertices.tolist(), made.faces.tolist(), "bowl"))
    base, ball = DrivenBody(Rest(), (shape,)), Ball(0.02)
    system = ns.System([base, ball])
    system.contact(base, ball, normal=Unilateral(), friction=Coulomb(0.0), impact=EnergeticImpact(0.3))
    system.place(ball, position=(0.05, 0.01, 0.03))
    solution = ns.simulate(system, 5.0)
    gaps = distances(solution, base, ball, np.linspace(0.0, 5.0, 41))["gap"]
    assert np.min(gaps) > -1e-9


def test_the_process_survives_random_queries() -> None:
    """Every pair, every way, poses wrong and right, deep and far: answers between bounds or errors by name."""
    done = subprocess.run([sys.executable, "-c", _CODE], capture_output=True, text=True, timeout=200, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["600", "0"]
