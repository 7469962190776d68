"""Shapes of users: known by their farthest points, they touch everything, exactly."""

from __future__ import annotations

import copy
import math
import pickle
from dataclasses import dataclass
from pathlib import Path
from typing import Any, final

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import (
    Box,
    Capsule,
    Cone,
    ConvexHull,
    Cylinder,
    Disc,
    DrivenBody,
    Egg,
    Ellipsoid,
    EllipsoidBody,
    HalfSpace,
    MovedShape,
    Plane,
    RigidBody,
    Sphere,
    Superellipsoid,
    SupportBody,
    SupportShape,
    TriangleMesh,
)
from bodies.meshes.triangles import Triangles
from bodies.shapes.drawing import solid_of
from bodies.shapes.support_shape import spiral
from laws import EnergeticImpact, Frictionless, HertzCompliant, Unilateral
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter
from nonsmooth.rotations import rotation
from nonsmooth.system.pairing import installed_pair
from nonsmooth.testing.kinematics import check_contact_kinematics
from tests.bodies.carriers import Rig
from tests.bodies.given_shapes import EllipsoidSum, Lens, SameEllipsoid, Spindle, Sum
from tests.bodies.polytopes import random_hull

HULL = random_hull(np.random.default_rng(4), 9, 8e-3)
MESH = TriangleMesh(Triangles(*HULL.drawing()))
KNOWN = SameEllipsoid(), Ellipsoid(8e-3, 14e-3, 11e-3)
OTHERS: dict[str, Any] = {
    "sphere": Sphere(5e-3),
    "box": Box(8e-3, 5e-3, 4e-3),
    "rounded hull": ConvexHull(HULL.points, rounding=2e-3),
    "capsule": Capsule(2e-3, 7e-3),
    "cylinder": Cylinder(6e-3, 8e-3),
    "cone": Cone(7e-3, 1.2e-2),
    "disc": Disc(8e-3),
    "rounded cylinder": Cylinder(6e-3, 8e-3, rounding=2e-3),
    "ellipsoid": Ellipsoid(4e-3, 6e-3, 8e-3),
    "superellipsoid": Superellipsoid(5e-3, 6e-3, 8e-3, 1.3, 1.2),
    "boxy superellipsoid": Superellipsoid(5e-3, 6e-3, 8e-3, 0.7, 0.8),
}
GIVEN: dict[str, Any] = {
    "sum": EllipsoidSum(),
    "lens": Lens(),
    "rounded lens": Lens(rounding=1e-3),
    "egg": MovedShape(Egg(), 1e-3, -2e-3, 5e-4, 0.8, 0.36, -0.48),
}
POSES = 5 if PLAIN else 30


def _poses(rng: np.random.Generator) -> list[Any]:
    way = rng.normal(size=3)
    turns = [np.roll(q, 1) for q in Rotation.random(2, random_state=rng).as_quat()]
    return [(np.zeros(3), turns[0]), (0.04 * way / np.linalg.norm(way), turns[1])]


def _slab(shapes: Any, poses: Any, n: Any) -> float:
    (p, a), (q, b) = [(place, rotation(turn)) for place, turn in poses]
    return float(n @ (q + b @ shapes[1].support(-n @ b) - p - a @ shapes[0].support(n @ a)))


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize("name", OTHERS)
def test_an_ellipsoid_that_is_not_known_has_the_contacts_of_one_that_is(build: Any, name: str) -> None:
    """Apart, all but touching, and in each other by a little."""
    one, two = (Rig((shape, OTHERS[name]), build.laws()) for shape in KNOWN)
    rng = np.random.default_rng(6)
    for _ in range(POSES):
        poses, u = _poses(rng), rng.normal(size=12)
        for gap in (None, 1e-6, -1e-6):
            for rig in (one, two):
                rig.put(poses, u)
            ours, known = one.geometry[0], two.geometry[0]
            n = known[1:4] if two.contacts[0].shapes[0] is KNOWN[1] else -known[1:4]
            np.testing.assert_allclose(ours[:4], known[:4], rtol=0, atol=1e-12)
            np.testing.assert_allclose(ours[7:13], known[7:13], rtol=0, atol=1e-12)
            np.testing.assert_allclose(one.rate, two.rate, rtol=0, atol=1e-12)
            np.testing.assert_allclose(one.bias, two.bias, rtol=1e-8, atol=1e-8)
            if gap is None:
                poses = [poses[0], (poses[1][0] + (1e-6 - known[0]) * n, poses[1][1])]
            else:
                poses = [poses[0], (poses[1][0] - 2e-6 * n, poses[1][1])]


PAIRS = [(one, two) for one in GIVEN for two in (*OTHERS, *GIVEN)]


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize(("one", "two"), PAIRS, ids=["-".join(pair) for pair in PAIRS])
def test_the_gap_is_that_of_the_bodies(build: Any, one: str, two: str) -> None:
    """No slab between them is wider than they are apart, and this one is as wide as the gap."""
    shapes = GIVEN[one], (OTHERS | GIVEN)[two]
    rig, rng = Rig(shapes, build.laws()), np.random.default_rng(7)
    for _ in range(POSES):
        poses = _poses(rng)
        for gap in (None, 1e-3, 1e-6, 1e-9):
            rig.put(poses, np.zeros(12))
            block = rig.geometry[0]
            n = block[1:4] if rig.contacts[0].shapes[0] is shapes[0] else -block[1:4]
            assert block[0] == pytest.approx(_slab(shapes, poses, n), abs=1e-14), gap
            np.testing.assert_allclose(block[10:13] - block[7:10], block[0] * block[1:4], rtol=0, atol=1e-14)
            if gap is not None:
                assert block[0] == pytest.approx(gap, abs=1e-12)
            aim = 1e-3 if gap is None else 1e-3 * gap
            poses = [poses[0], (poses[1][0] + (aim - block[0]) * n, poses[1][1])]


@pytest.mark.parametrize("name", GIVEN)
def test_over_a_mesh_and_a_plane(build: Any, name: str) -> None:
    """The least gap of the faces, edges and corners of a mesh is that of its hull; a plane has that of the support."""
    shape, rng = GIVEN[name], np.random.default_rng(8)
    mesh, hull, plane = (Rig((other, shape), build.laws()) for other in (MESH, HULL, Plane()))
    for _ in range(POSES):
        poses = _poses(rng)
        for rig in (mesh, hull, plane):
            rig.put(poses, np.zeros(12))
        blocks = mesh.geometry
        least = np.min(blocks[blocks[:, 30] <= 0.0, 0])
        assert least == pytest.approx(hull.geometry[0, 0], abs=1e-13)
        up, (place, turn) = rotation(poses[0][1])[:, 2], poses[1]
        axes = rotation(turn)
        assert plane.geometry[0, 0] == pytest.approx(float(up @ (place + axes @ shape.support(-up @ axes))), abs=1e-15)


EDGES: dict[str, tuple[Any, list[float], float]] = {
    "lens": (Lens(), [0.01, 0.0, 0.0], 0.0),
    "disc": (Disc(8e-3), [8e-3, 0.0, 0.0], 0.0),
    "cylinder": (Cylinder(6e-3, 8e-3), [6e-3, 0.0, 8e-3], 0.25 * math.pi),
    "cone": (Cone(7e-3, 1.2e-2), [7e-3, 0.0, 0.0], -0.5),
    "box": (Box(8e-3, 5e-3, 4e-3), [8e-3, 1e-3, 4e-3], 0.25 * math.pi),
    "rounded box": (Box(8e-3, 5e-3, 4e-3, rounding=1e-3), [7e-3, 1e-3, 3e-3], 0.25 * math.pi),
    "mesh": (TriangleMesh(Triangles(*Box(8e-3, 5e-3, 4e-3).drawing())), [8e-3, 1e-3, 4e-3], 0.25 * math.pi),
}
"""Shapes, a point of an edge that runs along y there, and the elevation of a normal of this edge."""


@pytest.mark.parametrize("name", EDGES)
def test_a_sharp_rim_across_another_edge(build: Any, name: str) -> None:
    """The gap and the normal go on through contact, as far as the edges cross each other."""
    shape, place, elevation = EDGES[name]
    rig, rng = Rig((Lens(), shape), build.laws()), np.random.default_rng(9)
    sweep = 1e-3 if name == "rounded box" else 0.0
    for _ in range(POSES):
        tilt, other = rng.uniform(-0.5, 0.5, 2)
        other += elevation
        n = np.array([math.cos(tilt), 0.0, math.sin(tilt)])
        # the edge of the other body crosses the rim at an angle, and its normal faces that of the rim
        own = np.array([[math.cos(other), 0.0, math.sin(other)], [0.0, 1.0, 0.0]])
        across = rng.uniform(0.4, math.pi - 0.4)
        along = math.cos(across) * np.array([0.0, 1.0, 0.0]) + math.sin(across) * np.cross(n, [0.0, 1.0, 0.0])
        frames = [np.column_stack([u, v, np.cross(u, v)]) for u, v in (own, (-n, along))]
        turn = Rotation.from_matrix(frames[1] @ frames[0].T)
        for gap in (1e-3, 1e-6, 1e-9, 0.0, -1e-9, -1e-7, -1e-6):
            center = np.array([0.01, 0.0, 0.0]) + (gap + sweep) * n - turn.apply(place)
            poses = [(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])), (center, np.roll(turn.as_quat(), 1))]
            rig.put(poses, np.zeros(12))
            blocks = rig.geometry[rig.geometry[:, 30] <= 0.0]
            block = blocks[np.argmin(blocks[:, 0])]
            sign = 1.0 if isinstance(rig.contacts[0].shapes[0], Lens) else -1.0
            assert block[0] == pytest.approx(gap, abs=1e-13), gap
            np.testing.assert_allclose(sign * block[1:4], n, rtol=0, atol=1e-7, err_msg=str(gap))


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="the checks call compiled functions")
@pytest.mark.parametrize(("one", "two"), [("sum", "box"), ("egg", "ellipsoid")])
def test_rates_and_second_order_terms_are_the_derivatives(one: str, two: str) -> None:
    """The checks of the conformance kit; they hold of any pair."""
    shapes = GIVEN[one], (OTHERS | GIVEN)[two]
    system = ns.System([DrivenBody(carried=(shape,)) for shape in shapes])
    contacts = system.contact(*system.bodies, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(0.5))
    found = installed_pair(*contacts[0].shapes)
    assert found is not None
    for row in check_contact_kinematics(found[0], *contacts[0].shapes, contacts=[0]):
        row.check()


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="a minute in plain mode")
@pytest.mark.parametrize(
    ("name", "other"), [("sum", "plate"), ("lens", "box"), ("rounded lens", "mesh"), ("egg", "ellipsoid")]
)
def test_bouncing_keeps_the_energy(name: str, other: str) -> None:
    """Two hundred impacts without loss."""
    grounds = {
        "plate": Plane(),
        "box": Box(0.5, 0.5, 0.02),
        "ellipsoid": Ellipsoid(5.0, 5.0, 0.05),
        "mesh": TriangleMesh(Triangles(*Box(0.5, 0.5, 0.02).drawing())),
    }
    shape = GIVEN[name]
    body = SupportBody(shape.shape if name == "egg" else shape)
    ground = DrivenBody(carried=(grounds[other],))
    system = ns.System([ground, body], 9.81)
    system.contact(ground, body, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(1.0))
    system.place(body, position=(1e-3, 2e-3, 0.1), orientation=(0.5, 0.5, 0.5, 0.5), angular_velocity=(3.0, 2.0, 1.0))
    solution = ns.simulate(system, 45.0)
    assert solution.status == "done"
    assert np.count_nonzero(solution.events.cause == Cause.IMPACT) >= 200
    assert solution.energy.residual <= 1e-9


@pytest.mark.parametrize("ground", [Plane(), Box(0.05, 0.05, 0.02, z=-0.02)], ids=["plate", "box"])
def test_the_run_of_an_ellipsoid_that_is_not_known(build: Any, ground: Shape) -> None:
    """Impacts, slip and stick at the times of the known one."""
    # a slip below the velocity tolerance has stopped: at 3 m/s^2 its end is located within 3e-10 s
    engine = ns.EventDriven(tolerance=1e-12, velocity_tolerance=1e-9)
    events = []
    for body in (SupportBody(KNOWN[0]), EllipsoidBody(8e-3, 14e-3, 11e-3)):
        carrier = DrivenBody(carried=(ground,))
        system = ns.System([carrier, body])
        system.contact(carrier, body, **build.laws(0.6, 0.3))
        system.place(
            body, position=(0.0, 0.0, 0.03), orientation=(0.5, 0.5, 0.5, 0.5), angular_velocity=(3.0, 2.0, 1.0)
        )
        events.append(ns.simulate(system, 0.05 if PLAIN else 0.3, engine=engine).events)
    np.testing.assert_array_equal(events[0].cause, events[1].cause)
    np.testing.assert_allclose(events[0].time, events[1].time, rtol=0, atol=1e-9)


@pytest.mark.slow
def test_mass_properties() -> None:
    """Against closed forms: the ellipsoid's, and J. Steiner's formula for a body with a ball rolled over it."""
    ours, known = KNOWN
    assert ours.volume == pytest.approx(known.volume, rel=1e-8)
    np.testing.assert_allclose(ours.inertia, known.inertia, rtol=0, atol=1e-8 * known.inertia[1, 1])
    lens = Lens(rounding=1e-3)
    big, rim, r = lens.radius, lens.rim, lens.rounding
    height = big - math.sqrt(big**2 - rim**2)
    volume, area = 2.0 * math.pi * height**2 * (3.0 * big - height) / 3.0, 4.0 * math.pi * big * height
    bend = 4.0 * math.pi * height + math.pi * rim * (math.pi - 2.0 * math.asin(rim / big))
    assert lens.volume == pytest.approx(volume + area * r + bend * r**2 + 4.0 / 3.0 * math.pi * r**3, rel=1e-4)
    egg, moved = Egg(), GIVEN["egg"]
    for one in (egg, Egg(0.03, -0.3, 0.0), Egg(0.02, 0.3, -0.15)):
        assert one.volume == pytest.approx(one._integrals[0], rel=1e-8)
    turn = rotation([0.8, 0.36, -0.48, 0.0])
    np.testing.assert_allclose(moved.centroid, turn @ egg.centroid + [1e-3, -2e-3, 5e-4], rtol=0, atol=1e-15)
    np.testing.assert_allclose(moved.inertia, turn @ egg.inertia @ turn.T, rtol=0, atol=1e-20)
    # the frame of a body of its own is at its centroid
    own = SupportBody(egg).shapes[0]
    assert isinstance(own, MovedShape)
    assert np.linalg.norm(own.centroid) < 1e-12


@pytest.mark.parametrize("name", GIVEN)
def test_drawing_length_and_bounds(name: str) -> None:
    shape = GIVEN[name]
    vertices, triangles = shape.drawing(96)
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    assert np.all(np.unique(edges, axis=0, return_counts=True)[1] == 2)
    assert solid_of(vertices, triangles)[0] == pytest.approx(shape.volume, rel=2e-2)
    farthest = np.max(np.linalg.norm(vertices, axis=1))
    assert farthest <= shape.length <= 1.15 * farthest
    low, high = shape.bounds
    assert np.all(vertices >= low - 1e-12)
    assert np.all(vertices <= high + 1e-12)


def test_the_spiral_leaves_no_gap() -> None:
    """Nowhere is a direction farther from all others than it says."""
    for count in (50, 400):
        directions, reach = spiral(count)
        others = np.random.default_rng(1).normal(size=(20000, 3))
        others /= np.linalg.norm(others, axis=1)[:, None]
        assert np.min(np.max(others @ directions.T, axis=1)) >= math.cos(reach)


@pytest.mark.slow
def test_copies_and_pickles(build: Any) -> None:
    """What the engine knows of a shape is of one process, and is not kept."""
    egg = Egg()
    assert egg.core == egg.core
    for other in (copy.deepcopy(egg), pickle.loads(pickle.dumps(egg))):
        assert other == egg
        assert vars(other) == {"radius": 0.01, "longer": 0.1, "pointed": 0.05}
        assert Rig((other, Sphere(5e-3)), build.laws()).contacts


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="everything runs in Python")
def test_what_numba_does_not_know_runs_in_python(build: Any) -> None:
    """With a warning that says why; the numbers are the same."""
    slow = Sum(Ellipsoid(6e-3, 4e-3, 3e-3), Ellipsoid(2e-3, 5e-3, 3e-3))
    fast = EllipsoidSum(turn=0.0)
    with pytest.warns(ns.RunsInPython, match=r"Sum: Sum\.support .*self\.first\.support"):
        rig = Rig((slow, Sphere(5e-3)), build.laws())
    other, rng = Rig((fast, Sphere(5e-3)), build.laws()), np.random.default_rng(3)
    for _ in range(10):
        poses = _poses(rng)
        for one in (rig, other):
            one.put(poses, np.ones(12))
        np.testing.assert_allclose(rig.geometry[:, :13], other.geometry[:, :13], rtol=0, atol=1e-15)
        np.testing.assert_allclose(rig.bias, other.bias, rtol=1e-9, atol=1e-9)


@final
@dataclass(frozen=True)
class Wrong(SupportShape):
    """A shape that is wrong in a way of the test's choice."""

    kind: str = "flat"
    size: float = parameter(0.01, doc="size", unit="m", above=0.0)

    def support(self, direction: Vector) -> Vector:
        """Return a point that is wrong [m]."""
        n = direction / np.linalg.norm(direction)
        if self.kind == "flat":
            across = max(math.hypot(n[0], n[1]), 1e-300)
            return self.size * np.array([n[0] / across, n[1] / across, np.sign(n[2])]) + 0.1 * self.size * n
        if self.kind == "half a ball":
            along = np.array([0.48, -0.6, 0.64])
            below = n - min(float(n @ along), 0.0) * along
            return self.size * below / np.linalg.norm(below) + 0.1 * self.size * n
        if self.kind == "not a number":
            return np.full(3, math.nan)
        if self.kind == "two numbers":
            return n[:2]
        if self.kind == "not convex":
            return self.size * (1.0 + 0.5 * math.cos(6.0 * n[2])) * n
        if self.kind == "by length":
            return self.size * n + 0.1 * self.size * direction
        raise RuntimeError("no idea")


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize(
    ("shape", "message"),
    [
        (Wrong("flat"), "at most.*flat place"),
        (Wrong("half a ball"), "at most.*flat place"),
        (Wrong("not a number"), "three finite numbers"),
        (Wrong("two numbers"), "three finite numbers"),
        (Wrong("not convex"), "farthest of the points"),
        (Wrong("by length"), "length of the direction"),
        (Wrong("no idea"), r"three finite numbers.*RuntimeError\('no idea'\).*asked along \[.*\(line \d+\)"),
        (Spindle(), "corner: roll a ball over it"),
    ],
)
def test_what_is_wrong_is_refused_by_name(shape: SupportShape, message: str) -> None:
    with pytest.raises(ns.InvalidInput, match=rf"(?s){type(shape).__name__}\.support.*{message}"):
        SupportBody(shape)


@final
@dataclass(frozen=True)
class Blind(SupportShape):
    """A ball that is wrong within a milliradian of one direction, which no look round meets."""

    number: float = parameter(0.0, doc="in which way")

    def support(self, direction: Vector) -> Vector:
        """Return what is wrong, or the point of a ball of 1 cm [m]."""
        n = direction / math.sqrt(np.sum(direction * direction))
        if 0.48 * n[0] - 0.6 * n[1] + 0.64 * n[2] > 1.0 - 1e-6:
            if self.number == 0.0:
                raise ValueError("no such direction")
            return np.full(3, math.nan) if self.number == 1.0 else n[:2]
        return np.asarray(0.01 * n)


SOFT: dict[str, Any] = {"normal": HertzCompliant(1e6), "friction": Frictionless()}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("other", "laws", "number"),
    [
        (Plane(), {}, 0.0),
        (Plane(), {}, 1.0),
        (Plane(), {}, 2.0),
        (Plane(), SOFT, 1.0),
        (HalfSpace(), {}, 2.0),
        (Sphere(0.02), {}, 0.0),
        (Sphere(0.02), SOFT, 1.0),
        (Box(0.05, 0.05, 0.01), {}, 2.0),
        (KNOWN[0], {}, 0.0),
        (KNOWN[0], {}, 1.0),
    ],
)
def test_what_is_wrong_along_one_direction_is_refused_at_the_start(
    build: Any, other: Any, laws: dict[str, Any], number: float
) -> None:
    """With the direction, and what was raised as its cause, whatever the engine makes of it."""
    turn = np.roll(Rotation.align_vectors([[0.0, 0.0, -1.0]], [[0.48, -0.6, 0.64]])[0].as_quat(), 1)
    ground, body = DrivenBody(carried=(other,)), SupportBody(Blind(number))
    system = ns.System([ground, body])
    system.contact(ground, body, **(laws or build.laws()))
    system.place(body, position=(0.0, 0.0, 0.05), orientation=turn)
    says = r"(?s)Blind\.support .*three finite numbers.*but it is (ValueError|\[nan|\[0\.).*asked along \[0\.4"
    with pytest.raises(ns.InvalidInput, match=says) as refused:
        ns.simulate(system, 0.01)
    assert isinstance(refused.value.__cause__, ValueError) is (number == 0.0)


@pytest.mark.parametrize(("longer", "pointed"), [(1.0, 0.0), (-0.5, 0.0), (0.2, 0.45), (0.2, -0.45)])
def test_eggs_that_are_not_convex_are_refused(longer: float, pointed: float) -> None:
    """Just beyond the bound of the radii of curvature, all of which those within it have."""
    with pytest.raises(ns.InvalidInput, match=r"Egg must have radii of curvature.*less long or flat"):
        Egg(0.01, longer, pointed)
    assert SupportBody(Egg(0.01, 0.85 * longer, 0.85 * pointed)).total_mass > 0.0


@pytest.mark.slow
@pytest.mark.parametrize(
    "body",
    [
        SupportBody(Egg(0.012, 0.2, 0.1), density=1100.0),
        RigidBody(0.01, np.diag([1e-6, 1e-6, 1e-6]).tolist(), (MovedShape(Egg(0.012, 0.2, 0.1), z=2e-3),)),
    ],
    ids=["support body", "rigid body"],
)
def test_a_body_of_farthest_points_is_saved(build: Any, tmp_path: Path, body: Any) -> None:
    """And read again: the same run to the last bit."""
    system, path = build.over(body), tmp_path / "egg.toml"
    system.place(body, position=(0.0, 0.0, 0.03), orientation=(0.5, 0.5, -0.5, 0.5), velocity=(0.3, 0.0, 0.0))
    ns.save_system(system, path)
    one, two = (ns.simulate(known, 0.1) for known in (system, ns.load_system(path).system))
    assert len(one.events) > 0
    np.testing.assert_array_equal(one.q_end, two.q_end)


def test_a_pair_that_cannot_be_found_is_refused(build: Any) -> None:
    with pytest.raises(ns.InvalidInput, match="exponents both up to 1"):
        Rig((Egg(), Superellipsoid(5e-3, 6e-3, 8e-3, 0.7, 1.3)), build.laws())
    with pytest.raises(ns.InvalidInput, match=r"SupportBody\.shape.*SupportShape"):
        SupportBody(Sphere(0.01))  # type: ignore[arg-type]


def test_only_shapes_given_by_their_points_are_moved() -> None:
    with pytest.raises(ns.InvalidInput, match=r"MovedShape\.shape must be a shape .*SupportShape, but it is 'Box'"):
        MovedShape(Box(0.1, 0.1, 0.1), x=0.1)  # type: ignore[arg-type]
