"""Features of two surfaces that are found near each other: none is left out, and runs are those of all features."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import nullcontext
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import (
    Box,
    BoxBody,
    Capsule,
    CapsuleBody,
    Cone,
    ConeBody,
    ConvexHull,
    Cylinder,
    CylinderBody,
    Disc,
    DiscBody,
    DrivenBody,
    Frustum,
    MeshBody,
    Sphere,
    SurfaceSurface,
    TriangleMesh,
    Triangles,
)
from bodies.contacts.frustum.frustum_surface import FrustumSurface
from bodies.contacts.surface import surface_pairs
from nonsmooth.binding.compile import parameter_names
from nonsmooth.engine.memory.blocks import CANDIDATE, FRAME, GEOMETRY
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.interfaces import Body, ConvexShape, Shape
from tests.benchmarks.contact_gaps import Contacts
from tests.bodies.carriers import Rig
from tests.bodies.every_pair import all_features
from tests.bodies.meshes.parts import box, channel, hills, torus
from tests.contact_calls import candidate_caller, pair_caller

pytestmark = pytest.mark.skipif(PLAIN, reason="compiled runs take seconds, plain ones minutes")

UNIT = np.array([1.0, 0.0, 0.0, 0.0])
HILLS = TriangleMesh(Triangles(*hills(6)))
TORUS = TriangleMesh(Triangles(*torus(10, 6)))
WIDE = TriangleMesh(Triangles(*box(0.9, 0.7, 0.5)))
HALVES = np.array([0.45, 0.35, 0.25])
DOME = np.random.default_rng(5).normal(size=(60, 3))
DOME = np.array([0.6, 0.6, 0.2]) * (DOME / np.linalg.norm(DOME, axis=1)[:, None]) - np.array([0.0, 0.0, 0.2])
HULL = ConvexHull(DOME.tolist(), rounding=0.03)
PAIRS: dict[str, tuple[Shape, Shape, float]] = {
    "box and hills": (HILLS, Box(*HALVES), 0.16),
    "mesh and hills": (HILLS, WIDE, 0.16),
    "rings": (TORUS, TORUS, 0.01),
    "rounded box and hills": (HILLS, Box(0.45, 0.35, 0.25, rounding=0.05), 0.16),
    "capsule and hills": (HILLS, Capsule(0.1, 0.4), 0.16),
    "cylinder and hills": (HILLS, Cylinder(0.2, 0.3), 0.16),
    "feet and hills": (HILLS, Cylinder(0.3, 0.1, foot_height=0.01), 0.08),
    "cone and hills": (HILLS, Cone(0.2, 0.5), 0.08),
    "disc and hills": (HILLS, Disc(0.3), 0.16),
    "rounded cylinder and hills": (HILLS, Cylinder(0.2, 0.3, rounding=0.03), 0.16),
    "rounded cone and hills": (HILLS, Cone(0.3, 0.2, rounding=0.05), 0.16),
    "rounded disc and hills": (HILLS, Disc(0.4, rounding=0.02), 0.08),
    "cylinder and rounded hull": (HULL, Cylinder(0.2, 0.3), 0.16),
    "rounded cylinder and rounded hull": (HULL, Cylinder(0.2, 0.3, rounding=0.03), 0.16),
    "cone and rounded hull": (HULL, Cone(0.2, 0.5), 0.08),
    "disc and rounded hull": (HULL, Disc(0.3), 0.16),
}
"""Two shapes, and how far ahead they are looked for [m]."""
BODIES: dict[str, Callable[[], Body]] = {
    "box": lambda: BoxBody(0.1, 0.07, 0.05, mass=1.0),
    "channel": lambda: MeshBody(Triangles(*channel()), mass=1.0),
    "capsule": lambda: CapsuleBody(0.04, 0.06, 1000.0),
    "rounded box": lambda: BoxBody(0.1, 0.07, 0.05, mass=1.0, rounding=0.01),
    "cylinder": lambda: CylinderBody(0.06, 0.05, 1000.0),
    "cone": lambda: ConeBody(0.06, 0.1, 1000.0),
    "disc": lambda: DiscBody(0.07, mass=1.0),
}


def _turned(angle: Any) -> Any:
    return np.roll(Rotation.from_rotvec(angle).as_quat(), 1)


def _near(name: str, turn: Any, rng: np.random.Generator) -> Any:
    """Return a place of the second body next to the first."""
    if name == "rings":
        way = rng.normal(size=3)
        return rng.uniform(0.03, 0.06) * way / np.linalg.norm(way)
    second, axes = PAIRS[name][1], Rotation.from_rotvec(turn).as_matrix()
    reach = np.abs(axes[2]) @ HALVES
    if isinstance(second, ConvexShape):
        reach = -axes[2] @ second.support(-axes[2])
    return np.array([*rng.uniform(-0.5, 0.5, 2), reach + rng.uniform(-0.03, 0.06)])


def _least(rig: Rig, poses: Any) -> float:
    """Return the least gap of features that face each other."""
    rig.put(poses, np.zeros(12))
    block = rig.geometry
    return float(np.min(block[block[:, 30] <= 0.0, 0], initial=np.inf))


@pytest.mark.slow
@pytest.mark.parametrize("name", PAIRS)
def test_what_is_near_is_found_until_it_is_looked_for_again(name: str, build: Any) -> None:
    """Bodies are listed at random poses, and moved and turned as far as a list may stand: the gap is that of all."""
    first, second, ahead = PAIRS[name]
    rig = Rig((first, second), build.laws(), ahead)
    assert rig.contacts[0].kinematics.candidates is not None
    every = Rig((first, second), build.laws())
    assert len(every.contacts) > 100
    # an edge that overlaps a rim or a side by more than round-off may have another one's normal
    lowest = 0.0 if isinstance(second, Frustum) else -0.1 * ahead
    rng, compared = np.random.default_rng(3), 0
    for _ in range(60):
        turn = rng.normal(size=3)
        place = _near(name, turn, rng)
        rig.put([(np.zeros(3), UNIT), (place, _turned(turn))], np.zeros(12))
        margin = rig.listed()
        # half the way by turning, half along a line, of each body
        angles = rng.normal(size=(2, 3))
        sizes = np.linalg.norm(angles, axis=1) * [first.extent, second.extent]
        angles *= (0.25 * margin / sizes)[:, None]
        ways = rng.normal(size=(2, 3))
        ways *= 0.25 * margin / np.linalg.norm(ways, axis=1)[:, None]
        moved = Rotation.from_rotvec(angles[1]) * Rotation.from_rotvec(turn)
        poses = [(ways[0], _turned(angles[0])), (place + ways[1], _turned(moved.as_rotvec()))]
        least = _least(every, poses)
        if lowest < least < 0.4 * margin:
            compared += 1
            assert _least(rig, poses) == pytest.approx(least, abs=1e-15)
    assert compared >= 8


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("kind", BODIES)
def test_a_run_is_that_of_all_features(kind: str, seed: int, build: Any) -> None:
    """A body falls, tumbles and slides on hills: the same events, whether all pairs of features stand or those near."""
    runs = []
    for is_searched in (True, False):
        rng = np.random.default_rng(seed)
        ground = DrivenBody(carried=(HILLS,))
        body = BODIES[kind]()
        system = ns.System([ground, body])
        with nullcontext() if is_searched else all_features():
            contacts = system.contact(ground, body, **build.laws(0.4, 0.3))
        assert (contacts[0].kinematics.candidates is not None) == is_searched
        turn = rng.normal(size=4)
        system.place(
            body,
            position=(0.1, 0.1, 0.3),
            orientation=turn / np.linalg.norm(turn),
            velocity=rng.normal(size=3),
            angular_velocity=rng.normal(size=3),
        )
        runs.append(ns.simulate(system, 0.39))
    one, two = runs
    assert one.status == two.status == "done"
    assert np.sum(one.events.cause == Cause.IMPACT) >= 2
    assert one.events.cause.tolist() == two.events.cause.tolist()
    np.testing.assert_allclose(one.events.time, two.events.time, rtol=0, atol=1e-8)
    np.testing.assert_allclose(one.q[-1], two.q[-1], rtol=0, atol=1e-7)
    assert one.energy.residual < 1e-8


@pytest.mark.parametrize(("seed", "rounding"), [(1, 0.0), (2, 0.01)])
def test_a_rim_rolls_over_borders_of_faces(seed: int, rounding: float, build: Any) -> None:
    """There face and edge all but repeat one another, and neither opens the other by turns."""
    rng, ground = np.random.default_rng(seed), DrivenBody(carried=(TriangleMesh(Triangles(*hills(10))),))
    body = DiscBody(0.07, mass=1.0, rounding=rounding)
    system = ns.System([ground, body])
    system.contact(ground, body, **build.laws(0.4, 0.3))
    turn = rng.normal(size=4)
    system.place(
        body,
        position=(0.1, 0.1, 0.3),
        orientation=turn / np.linalg.norm(turn),
        velocity=rng.normal(size=3),
        angular_velocity=rng.normal(size=3),
    )
    solution = ns.simulate(system, 0.5)
    assert solution.status == "done"
    assert solution.energy.residual < 1e-8


def _in_order(first: Any, second: Any) -> tuple[Any, tuple[Shape, Shape]]:
    """Return the kinematics of two shapes, and the shapes in its order."""
    if isinstance(second, Frustum):
        return FrustumSurface, (second, first)
    return SurfaceSurface, (first, second)


def _place(frames: Any, name: str, shapes: tuple[Shape, Shape], rng: np.random.Generator) -> None:
    """Write the frame blocks of two shapes: the first one of the pair at the origin, the second one next to it."""
    turn = rng.normal(size=3)
    for frame, shape in zip(frames, shapes, strict=True):
        is_first = shape is PAIRS[name][0]
        frame[:3] = 0.0 if is_first else _near(name, turn, rng)
        frame[3:12] = np.eye(3).ravel() if is_first else Rotation.from_rotvec(turn).as_matrix().ravel()


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in PAIRS if "hills" in name])
def test_python_finds_the_same(name: str) -> None:
    """Searches and evaluators, called as they stand and compiled."""
    first, second, ahead = PAIRS[name]
    kind, shapes = _in_order(first, second)
    one = kind.between(*shapes)[0]
    search, values, rng = one.candidates, one.parameters(), np.random.default_rng(4)
    assert search is not None
    find, call = pair_caller(search.function, search.values, name), candidate_caller(one.evaluator, values, name)
    own = {key: values[key] for key in parameter_names(one.evaluator, "pair")}
    frames, compared = np.zeros((2, FRAME)), 0
    for _ in range(3):
        _place(frames, name, shapes, rng)
        founds = np.zeros((2, 1 + CANDIDATE * (surface_pairs.MOST_NEAR + 1)))
        founds[:, 0] = 0.5 * ahead
        find(frames[0], frames[1], founds[0])
        search.function(frames[0], frames[1], founds[1], **search.values)
        np.testing.assert_array_equal(founds[0], founds[1])
        n = min(int(founds[0, 0]), surface_pairs.MOST_NEAR)
        for row in founds[0, 1 : 1 + CANDIDATE * n].reshape(-1, CANDIDATE):
            blocks, candidate = np.zeros((2, GEOMETRY)), np.append(row, ahead)
            call(frames[0], frames[1], blocks[0], candidate)
            one.evaluator(frames[0], frames[1], blocks[1], **{**own, "candidate": candidate})
            np.testing.assert_allclose(blocks[0], blocks[1], rtol=1e-12, atol=1e-12)
            compared += 1
    assert compared > 0


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("name", [name for name in PAIRS if "hills" in name])
def test_a_search_finds_all_or_says_that_there_are_more(name: str) -> None:
    """With any room for candidates."""
    first, second, ahead = PAIRS[name]
    kind, shapes = _in_order(first, second)
    search, rng = kind.between(*shapes)[0].candidates, np.random.default_rng(7)
    assert search is not None
    frames, tried = np.zeros((2, FRAME)), 0
    for _ in range(5):
        _place(frames, name, shapes, rng)
        every: set[Any] = set()
        for most in (1000, *range(1, 80)):
            values = {**search.values, "most": float(most), "narrow": np.inf}
            found = np.zeros(1 + CANDIDATE * (most + 1))
            found[0] = 0.5 * ahead
            pair_caller(search.function, values, name)(frames[0], frames[1], found)
            n = int(found[0])
            rows = {tuple(row) for row in found[1 : 1 + CANDIDATE * min(n, most)].reshape(-1, CANDIDATE)}
            every = rows if most == 1000 else every
            assert n > most or rows == every
            tried += n > most
    assert tried > 0


def test_with_little_room_less_is_looked_at_ahead(build: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """The margin of the list is halved until what is nearer has room; where nothing helps the system is refused."""
    found = []
    for most in (surface_pairs.MOST_NEAR, 24):
        monkeypatch.setattr(surface_pairs, "MOST_NEAR", most)
        rig = Rig((HILLS, Box(*HALVES)), build.laws(), 0.3)
        rig.put([(np.zeros(3), UNIT), (np.array([0.0, 0.0, 0.5]), _turned([0.4, 0.3, 0.2]))], np.zeros(12))
        found.append(rig.listed())
    assert found[0] > found[1] > 0.0
    rig = Rig((TORUS, TORUS), build.laws(), 0.3)
    rig.put([(np.zeros(3), UNIT), (np.zeros(3), UNIT)], np.zeros(12))
    with pytest.raises(ns.InvalidInput, match=r"enough for the pairs of features.*coarser meshes"):
        rig.listed()


@pytest.mark.slow
def test_a_query_is_that_of_all_features() -> None:
    """Also from afar, where so many features are within reach that less must be looked for."""
    pairs = [(HILLS, Box(*HALVES)), (HILLS, Sphere(0.03)), (HILLS, Capsule(0.1, 0.3)), (HILLS, Cylinder(0.2, 0.3))]
    near = [Contacts(*pair) for pair in pairs]
    every = [Contacts(*pair, of_all=True) for pair in pairs]
    rng, compared = np.random.default_rng(8), 0
    for _ in range(60):
        turn = rng.normal(size=3)
        place = _near("box and hills", turn, rng)
        other = place, Rotation.from_rotvec(turn).as_matrix()
        for one, two in zip(near, every, strict=True):
            found, expected = (contacts.least((np.zeros(3), np.eye(3)), other) for contacts in (one, two))
            if found is not None and found.gap > 0.0:
                assert expected is not None
                assert found.gap == pytest.approx(expected.gap, abs=1e-15)
                compared += 1
    assert compared > 30


@pytest.mark.parametrize("depth", [-1e-3, 1e-4, 1e-3])
def test_a_capsule_across_an_edge_has_the_same_gap_in_either_order(depth: float, build: Any) -> None:
    """Its axis crosses each convex edge of a channel in the middle, above or below it by a small depth."""
    channel_mesh, capsule = TriangleMesh(Triangles(*channel())), Capsule(2e-3, 6e-3)
    rigs = Rig((channel_mesh, capsule), build.laws()), Rig((capsule, channel_mesh), build.laws())
    features = channel_mesh.features
    for one, two, left, right in features.edges:
        n = features.planes[left, :3] + features.planes[right, :3]
        n /= np.linalg.norm(n)
        along = features.vertices[two] - features.vertices[one]
        across = np.cross(n, along) / np.linalg.norm(along)
        # the axis of the capsule is the third one of its body
        turn, _ = Rotation.align_vectors([across, n], [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
        place = 0.5 * (features.vertices[one] + features.vertices[two]) - depth * n
        poses = (np.zeros(3), UNIT), (place, np.roll(turn.as_quat(), 1))
        for rig, order in zip(rigs, (poses, poses[::-1]), strict=True):
            assert _least(rig, order) == pytest.approx(-depth - capsule.radius, abs=1e-12)
