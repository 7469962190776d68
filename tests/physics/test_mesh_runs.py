"""Whole runs with meshes as surfaces: against planes and polyhedra, and what collisions must keep."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import (
    Ball,
    Box,
    Capsule,
    ConvexHull,
    DrivenBody,
    Ellipsoid,
    Plate,
    Rest,
    Sphere,
    Superellipsoid,
    TriangleMesh,
    Triangles,
)
from nonsmooth.engine.memory.modes import CAUSES
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.interfaces import Body, Shape
from tests.bodies.carriers import Carrier
from tests.bodies.meshes.parts import box, bracket, channel
from tests.bodies.meshes.test_features import finer
from tests.bodies.surfaces import distances, is_inside

Array = NDArray[Any]
Outline = Sequence[tuple[float, float]]
pytestmark = pytest.mark.skipif(PLAIN, reason="compiled runs take seconds, plain ones minutes")

TETRAHEDRON = ConvexHull(
    ((0.0, 0.0, 0.01), (8e-3, 0.0, -4e-3), (-6e-3, 8e-3, -4e-3), (-6e-3, -8e-3, -4e-3)), rounding=2e-3
)
GROOVE = ((-0.05, -0.01), (0.05, -0.01), (0.05, 0.03), (0.0, 0.0), (-0.05, 0.02))
STEP = ((0.0, 0.0), (0.1, 0.0), (0.1, 0.02), (0.02, 0.02), (0.02, 0.08), (0.0, 0.08))
CAPS = {GROOVE: ((0, 1, 3), (1, 2, 3), (0, 3, 4)), STEP: ((0, 1, 3), (1, 2, 3), (0, 3, 5), (3, 4, 5))}


def _prism(outline: Outline, depth: float) -> TriangleMesh:
    """Return a prism along y over an outline in x and z."""
    n, caps = len(outline), CAPS[tuple(outline)]
    points = [(x, y, z) for y in (-0.5 * depth, 0.5 * depth) for x, z in outline]
    faces = [*caps, *((a + n, c + n, b + n) for a, b, c in caps)]
    for i in range(n):
        j = (i + 1) % n
        faces += [(i, j + n, j), (i, i + n, j + n)]
    return TriangleMesh(Triangles(points, faces))


def _ball_on(
    build: Any, grounds: Sequence[Body], place: Any, velocity: Any, t_end: float, friction: float = 0.3
) -> ns.Solution:
    ball = Ball(0.01, 7800.0)
    system = ns.System([*grounds, ball], gravity=9.81)
    for ground in grounds:
        system.contact(ground, ball, **build.laws(friction=friction))
    system.place(ball, position=place, velocity=velocity)
    return ns.simulate(system, t_end)


def _as_one(one: ns.Solution, two: ns.Solution, tolerance: float) -> None:
    assert [CAUSES[c] for c in one.events.cause] == [CAUSES[c] for c in two.events.cause]
    np.testing.assert_allclose(one.events.time, two.events.time, rtol=0, atol=tolerance)
    np.testing.assert_allclose(one.q_end, two.q_end, rtol=0, atol=tolerance)
    np.testing.assert_allclose(one.u_end, two.u_end, rtol=0, atol=tolerance)


def test_a_ball_bounces_and_rolls_over_triangles_as_over_a_plane(build: Any) -> None:
    """Over a dozen edges inside a flat face: none of them is felt."""
    points, triangles = finer(*finer(*box(0.6, 0.4, 0.02, at=(0.0, 0.0, -0.01))))
    ground = DrivenBody(Rest(), (TriangleMesh(Triangles(points, triangles)),))
    start: dict[str, Any] = {"place": (-0.25, 0.013, 0.03), "velocity": (0.8, 0.1, 0.0), "t_end": 0.5}
    plane = _ball_on(build, [Plate()], **start)
    assert plane.q_end[0] > 0.04
    _as_one(_ball_on(build, [ground], **start), plane, 1e-13)


def test_a_ball_in_a_groove_of_a_mesh_is_one_on_two_planes(build: Any) -> None:
    def wall(x: float, z: float) -> Plate:
        half = 0.5 * math.atan2(x, z)
        return Plate(Rest(orientation=(math.cos(half), 0.0, math.sin(half), 0.0)))

    start: dict[str, Any] = {"place": (0.01, 0.0, 0.06), "velocity": (0.0, 0.2, 0.0), "t_end": 0.5}
    planes = _ball_on(build, [wall(0.02, 0.05), wall(-0.03, 0.05)], **start)
    mesh = _ball_on(build, [DrivenBody(Rest(), (_prism(GROOVE, 0.4),))], **start)
    assert np.count_nonzero(mesh.events.impulse[:, :, 0].sum(axis=0) > 0.0) == 2
    _as_one(mesh, planes, 1e-12)


@pytest.mark.parametrize(
    ("velocity", "cause"),
    [((0.0, 0.5, 0.0), "lift-off"), ((0.2, 0.0, 0.0), "end of a feature"), ((-0.5, 0.1, 0.0), "lift-off")],
)
def test_a_ball_rolls_over_the_edge_of_a_step(build: Any, velocity: Any, cause: str) -> None:
    """From one patch to another the contact goes on, energy is kept, and the ball is never inside."""
    step = _prism(STEP, 0.2)
    solution = _ball_on(build, [DrivenBody(Rest(), (step,))], (0.01, 0.0, 0.09), velocity, 0.4)
    corners = step.features.vertices[step.features.triangles]
    assert cause in [CAUSES[c] for c in solution.events.cause]
    assert np.min(distances(solution.q[:, :3], corners)) > 0.01 - 1e-10
    assert not np.any(is_inside(solution.q[:, :3], corners))
    assert solution.energy.residual < 1e-8


def collision(
    build: Any, shapes: Any, seed: int, restitution: float = 1.0, friction: float = 0.0
) -> tuple[ns.Solution, Array]:
    """Return a run of two bodies that fly at each other, and their total momentum before and after."""
    rng, masses = np.random.default_rng(seed), (1.0, 1.5)
    size = 2.0 * max(shape.length for shape in shapes)
    moments = 0.02 * size**2
    bodies = [
        Carrier((shape,), m, (m * moments, 2.0 * m * moments, 1.5 * m * moments))
        for shape, m in zip(shapes, masses, strict=True)
    ]
    system = ns.System(bodies, gravity=0.0)
    system.contact(*bodies, **build.laws(restitution=restitution, friction=friction))
    way = rng.normal(size=3)
    way *= size / np.linalg.norm(way)
    for body, place, velocity in zip(bodies, (np.zeros(3), 1.5 * way), (np.zeros(3), -4.0 * way), strict=True):
        q = rng.normal(size=4)
        system.place(
            body,
            position=tuple((place + 0.1 * rng.normal(size=3) * size).tolist()),
            orientation=tuple((q / np.linalg.norm(q)).tolist()),
            velocity=tuple(velocity.tolist()),
            angular_velocity=tuple((10.0 * rng.normal(size=3)).tolist()),
        )
    solution = ns.simulate(system, 0.6, sample_interval=2e-3)
    return solution, np.array([masses[0] * u[:3] + masses[1] * u[6:9] for u in (solution.u[0], solution.u_end)])


@pytest.mark.parametrize("seed", [0, 1, 6])
def test_meshes_of_boxes_collide_like_boxes(build: Any, seed: int) -> None:
    halves = (0.1, 0.08, 0.12), (0.07, 0.1, 0.09)
    boxes = [Box(*half) for half in halves]
    meshes = [TriangleMesh(Triangles(*box(*(2.0 * np.array(half))))) for half in halves]
    plain, _ = collision(build, boxes, seed)
    assert plain.counters.impacts > 0
    _as_one(collision(build, meshes, seed)[0], plain, 1e-9)
    _as_one(collision(build, (meshes[0], boxes[1]), seed)[0], plain, 1e-9)


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize(("restitution", "friction"), [(1.0, 0.0), (0.5, 0.3)])
@pytest.mark.parametrize("seed", range(4))
def test_brackets_collide_without_passing_into_each_other(
    build: Any, seed: int, restitution: float, friction: float
) -> None:
    """Momentum and energy are kept, and no vertex of one, nor point of its edges, is ever inside of the other."""
    points, triangles = bracket()
    mesh = TriangleMesh(Triangles(points - [0.01, 0.006, 0.0075], triangles))
    solution, momentum = collision(build, (mesh, mesh), seed, restitution, friction)
    assert solution.counters.impacts > 0
    np.testing.assert_allclose(momentum[1], momentum[0], rtol=0, atol=1e-12)
    assert solution.energy.residual < 1e-9
    features = mesh.features
    corners, part = features.vertices[features.triangles], np.linspace(0.0, 1.0, 11)[:, None]
    seen = np.vstack([(1.0 - part) * features.vertices[e[0]] + part * features.vertices[e[1]] for e in features.edges])
    for q in solution.q:
        turn = [Rotation.from_quat(np.roll(q[7 * i + 3 : 7 * i + 7], -1)) for i in range(2)]
        for i in range(2):
            others = turn[1 - i].inv().apply(turn[i].apply(seen) + q[7 * i : 7 * i + 3] - q[7 - 7 * i : 10 - 7 * i])
            inside = is_inside(others, corners)
            assert not np.any(distances(others[inside], corners) > 1e-9)


@pytest.mark.parametrize(
    "shape",
    [
        Sphere(8e-3),
        Ellipsoid(6e-3, 4e-3, 9e-3),
        Superellipsoid(6e-3, 4e-3, 9e-3, 1.5, 1.2),
        Superellipsoid(6e-3, 4e-3, 7e-3, 0.4, 0.6),
        Superellipsoid(6e-3, 4e-3, 7e-3, 1.3, 0.6),
        Capsule(3e-3, 8e-3),
        Box(6e-3, 4e-3, 9e-3, rounding=1e-3),
        Box(6e-3, 4e-3, 9e-3, rounding=1e-6),
        TETRAHEDRON,
    ],
    ids=["Sphere", "Ellipsoid", "Superellipsoid", "boxy", "mixed", "Capsule", "rounded", "hardly rounded", "hull"],
)
@pytest.mark.parametrize("part", [bracket, channel], ids=["L", "U"])
def test_round_bodies_collide_with_a_part(build: Any, part: Any, shape: Shape) -> None:
    """Momentum and energy are kept."""
    points, triangles = part()
    mesh = TriangleMesh(Triangles(points - np.mean(points, axis=0), triangles))
    for seed in range(3):
        solution, momentum = collision(build, (mesh, shape), seed)
        assert solution.counters.impacts > 0
        np.testing.assert_allclose(momentum[1], momentum[0], rtol=0, atol=1e-12)
        assert solution.energy.residual < 1e-9


def test_round_bodies_move_over_triangles_as_over_a_plane(build: Any) -> None:
    """Where a boxy one rolls over the middle of a face its acceleration has no bound, and 1e-12 cannot be had."""
    points, triangles = finer(*box(0.6, 0.4, 0.02, at=(0.0, 0.0, -0.01)))
    mesh = DrivenBody(Rest(), (TriangleMesh(Triangles(points, triangles)),))
    boxy = Superellipsoid(0.01, 0.012, 0.008, 0.8, 0.8)
    for shape in (Ellipsoid(0.01, 0.012, 0.008), boxy, Capsule(6e-3, 8e-3)):
        engine = ns.EventDriven(tolerance=1e-9 if shape is boxy else 1e-12, impact_tolerance=1e-12)
        ends = []
        for ground in (mesh, Plate()):
            body = Carrier((shape,), 0.03, (1e-6, 1.2e-6, 0.8e-6))
            system = ns.System([ground, body], gravity=9.81)
            system.contact(ground, body, **build.laws(friction=0.3))
            system.place(body, position=(0.02, 0.01, 0.03), velocity=(0.3, 0.1, 0.0), angular_velocity=(3.0, 2.0, 1.0))
            ends.append(ns.simulate(system, 0.2, engine=engine))
        assert ends[1].counters.impacts > 1
        assert ends[0].counters.impacts == ends[1].counters.impacts
        np.testing.assert_allclose(ends[0].q_end, ends[1].q_end, rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    "shape",
    [TriangleMesh(Triangles(*box(4e-3, 4e-3, 4e-3))), Box(2e-3, 2e-3, 2e-3, rounding=5e-4)],
    ids=["mesh", "box"],
)
def test_a_block_falls_into_an_inner_corner_and_rests_on_both_walls(build: Any, shape: Shape) -> None:
    """On a slope it slides down until it leans on the wall."""
    points, triangles = bracket()
    # the corner is 1 cm high and wide; turned so that z points up and x down the slope
    turned = points[:, [1, 2, 0]]
    ground = DrivenBody(Rest(-0.4), (TriangleMesh(Triangles(turned, triangles)),))
    half = 2e-3
    block = Carrier((shape,), 0.1, (3e-7, 3e-7, 3e-7))
    system = ns.System([ground, block], gravity=9.81)
    system.contact(ground, block, **build.laws(friction=0.1))
    turn = Rotation.from_euler("y", -0.4)
    system.place(
        block,
        position=tuple(turn.apply([0.015, 0.007, 0.0125]).tolist()),
        orientation=tuple(np.roll(turn.as_quat(), 1).tolist()),
    )
    solution = ns.simulate(system, 0.3)
    place = turn.inv().apply(solution.q_end[:3])
    np.testing.assert_allclose(place, [0.01 + half, 0.007, 0.01 + half], rtol=0, atol=1e-9)
    np.testing.assert_allclose(solution.u_end, 0.0, rtol=0, atol=1e-9)
