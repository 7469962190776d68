"""Contacts of meshes that are not convex: against distances found another way, and what the patches must be."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from bodies import (
    Box,
    Capsule,
    ConvexHull,
    Ellipsoid,
    Point,
    Sphere,
    Superellipsoid,
    SurfacePoint,
    SurfaceSphere,
    TriangleMesh,
    Triangles,
)
from nonsmooth.engine.memory.blocks import FRAME, GEOMETRY
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.interfaces import Shape
from nonsmooth.parameters import SharedNumbers
from nonsmooth.testing.kinematics import check_contact_kinematics
from tests.bodies.carriers import Rig
from tests.bodies.every_pair import pairs_of, parts_of
from tests.bodies.meshes.parts import box, bracket, hills, torus
from tests.bodies.polytopes import random_shapes
from tests.bodies.surfaces import distances, is_inside, segment_distance
from tests.contact_calls import pair_caller

Array = NDArray[Any]
BRACKET = TriangleMesh(Triangles(*bracket(), "bracket"), 2e-3, -1e-3, 3e-3, 0.8, 0.36, -0.48)
TORUS = TriangleMesh(Triangles(*torus(8, 6), "torus"))
PLACE = np.array([0.1, 0.2, 0.3])
UNIT = np.array([1.0, 0.0, 0.0, 0.0])


@pytest.mark.slow
@pytest.mark.parametrize(("name", "n"), [("bracket", 2), ("torus", None)])
def test_the_nearest_patch_has_the_distance_of_the_surface(build: Any, name: str, n: int | None) -> None:
    """At random places outside; past the end of its features a patch is never nearer."""
    mesh, rng = {"bracket": BRACKET, "torus": TORUS}[name], np.random.default_rng(3)
    ball = Sphere(4e-3, x=1e-3)
    rig = Rig((mesh, ball), build.laws())
    assert n is None or len(rig.contacts) == n
    corners = mesh.features.vertices[mesh.features.triangles]
    low, high = mesh.bounds
    faced = 0
    for place in rng.uniform(low - 8e-3, high + 8e-3, (400, 3)):
        if is_inside(place[None], corners)[0]:
            continue
        distance = float(distances(place[None], corners)[0])
        turn = Rotation.random(random_state=rng)
        center = turn.apply(place) + PLACE
        rig.put([(PLACE, np.roll(turn.as_quat(), 1)), (center - [1e-3, 0.0, 0.0], UNIT)], np.zeros(12))
        gaps, past = rig.geometry[:, 0], rig.geometry[:, 30]
        facing = past <= 0.0
        faced += int(np.sum(facing))
        assert np.any(facing)
        assert np.min(gaps[facing]) == pytest.approx(distance - ball.radius, abs=1e-15)
        assert np.all(gaps[~facing] > min(distance - ball.radius, 0.0))
        for block in rig.geometry[facing]:
            # the witness point lies on the surface
            point = turn.inv().apply(block[7:10] - PLACE)
            assert distances(point[None], corners)[0] < 1e-15
    assert faced > 300


def test_a_ball_in_an_inner_corner_has_a_contact_with_either_wall(build: Any) -> None:
    mesh = TriangleMesh(Triangles(*bracket(), "bracket"))
    rig = Rig((mesh, Sphere(2e-3)), build.laws())
    rig.put([(np.zeros(3), UNIT), (np.array([0.012, 0.012, 0.007]), UNIT)], np.zeros(12))
    np.testing.assert_allclose(rig.geometry[:, 0], 0.0, atol=1e-17)
    assert np.all(rig.geometry[:, 30] < 0.0)
    np.testing.assert_allclose(sorted(rig.geometry[:, 1:4].tolist()), [[0, 1, 0], [1, 0, 0]], atol=1e-15)


def test_a_ball_whose_centre_is_inside_overlaps(build: Any) -> None:
    mesh = TriangleMesh(Triangles(*bracket(), "bracket"))
    rig = Rig((mesh, Sphere(2e-3)), build.laws())
    rig.put([(np.zeros(3), UNIT), (np.array([0.02, 0.009, 0.007]), UNIT)], np.zeros(12))
    assert np.min(rig.geometry[:, 0]) == pytest.approx(-3e-3, abs=1e-17)
    # below the flange is outside, though under the plane of its upper face
    rig.put([(np.zeros(3), UNIT), (np.array([0.02, -0.004, 0.007]), UNIT)], np.zeros(12))
    assert np.min(rig.geometry[:, 0]) == pytest.approx(2e-3, abs=1e-17)


@pytest.mark.slow
def test_contacts_with_points_and_balls_have_the_properties_of_the_kit() -> None:
    pairs: list[tuple[Any, Shape, Shape]] = [
        (SurfaceSphere, BRACKET, Sphere(4e-3)),
        (SurfacePoint, BRACKET, Point(1e-3, 2e-3)),
    ]
    for kinematics, first, second in pairs:
        for check in check_contact_kinematics(kinematics, first, second, contacts=[0]):
            check()


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("name", ["box-box", "box-hull", "tetrahedra"])
def test_a_convex_mesh_has_the_contacts_of_its_hull(build: Any, name: str) -> None:
    """At random poses near contact: the gaps of what faces each other are those of the polyhedra."""
    rng = np.random.default_rng(5)
    shapes = random_shapes(rng)[name]
    one, two = (TriangleMesh(Triangles(s.polytope.vertices, s.polytope.triangles)) for s in shapes)
    rigs = Rig(shapes, build.laws()), Rig((one, shapes[1]), build.laws()), Rig((one, two), build.laws())
    compared = 0
    for _ in range(60):
        turn = [np.roll(Rotation.random(random_state=rng).as_quat(), 1) for _ in range(2)]
        way = rng.normal(size=3)
        poses = [(np.zeros(3), turn[0]), (way / np.linalg.norm(way) * rng.uniform(0.012, 0.025), turn[1])]
        least = []
        for rig in rigs:
            rig.put(poses, np.zeros(12))
            block = rig.geometry
            # past the end of its features a contact is below 0 only where the bodies overlap
            nearest = np.min(block[block[:, 30] <= 0.0, 0], initial=np.inf)
            least.append(nearest if np.min(block[:, 0]) > 0.0 else -1.0)
        if 0.0 < least[0] < 5e-3:
            compared += 1
            assert least[1] == pytest.approx(least[0], abs=1e-15)
            assert least[2] == pytest.approx(least[0], abs=1e-15)
    assert compared > 5


def test_a_block_in_an_inner_corner_stands_on_both_walls(build: Any) -> None:
    """Four of its vertices touch the wall, four the flange, two of them both."""
    mesh, block = TriangleMesh(Triangles(*bracket(), "bracket")), Box(3e-3, 2e-3, 4e-3)
    rig = Rig((mesh, block), build.laws())
    rig.put([(np.zeros(3), UNIT), (np.array([0.013, 0.012, 0.007]), UNIT)], np.zeros(12))
    touching = rig.geometry[(np.abs(rig.geometry[:, 0]) < 1e-15) & (rig.geometry[:, 30] <= 0.0)]
    normals = touching[:, 1:4].round(12).tolist()
    assert normals.count([1.0, 0.0, 0.0]) >= 4
    assert normals.count([0.0, 1.0, 0.0]) >= 4
    assert all(normal in ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]) for normal in normals)


@pytest.mark.parametrize("kind", ["ellipsoid", "superellipsoid", "boxy"])
def test_a_smooth_body_has_the_gap_of_a_hull_or_of_a_ball(build: Any, kind: str) -> None:
    """Over a convex mesh that of the hull; a smooth body that is a ball, over any mesh, that of the ball."""
    rng = np.random.default_rng(9)
    smooth: Ellipsoid | Superellipsoid = Superellipsoid(
        *((5e-3, 4e-3, 6e-3, 0.3, 0.6) if kind == "boxy" else (6e-3, 4e-3, 9e-3, 1.5, 1.2))
    )
    smooth = Ellipsoid(6e-3, 4e-3, 9e-3, x=1e-3) if kind == "ellipsoid" else smooth
    round_one = Ellipsoid(4e-3, 4e-3, 4e-3, x=1e-3) if kind == "ellipsoid" else Superellipsoid(4e-3, 4e-3, 4e-3, x=1e-3)
    box_mesh = TriangleMesh(Triangles(*box()))
    hull = ConvexHull(box_mesh.features.vertices.tolist())
    ball = Sphere(4e-3, x=1e-3)
    pairs: list[Any] = [((hull, smooth), (box_mesh, smooth)), ((BRACKET, ball), (BRACKET, round_one))]
    for first, second in pairs[:1] if kind == "boxy" else pairs:
        rigs = Rig(first, build.laws()), Rig(second, build.laws())
        low, high = first[0].bounds
        compared = 0
        for place in rng.uniform(low - 9e-3, high + 9e-3, (120, 3)):
            turn = np.roll(Rotation.random(random_state=rng).as_quat(), 1)
            least = []
            for rig in rigs:
                rig.put([(np.zeros(3), UNIT), (place, turn)], np.zeros(12))
                block = rig.geometry
                least.append(np.min(block[block[:, 30] <= 0.0, 0], initial=np.inf))
            if least[0] > -5e-4:
                compared += 1
                assert least[1] == pytest.approx(least[0], abs=1e-15)
        assert compared > 30


@pytest.mark.slow
def test_a_capsule_has_the_distance_of_its_axis(build: Any) -> None:
    """At random places outside: the nearest of what faces each other, against many points of the axis."""
    capsule, rng = Capsule(2e-3, 8e-3, 1e-3, 0.0, 0.0, 0.6, 0.0, 0.8), np.random.default_rng(11)
    rig = Rig((BRACKET, capsule), build.laws())
    corners = BRACKET.features.vertices[BRACKET.features.triangles]
    low, high = BRACKET.bounds
    part = np.linspace(0.0, 1.0, 401)[:, None]
    axis = (1.0 - part) * capsule.ends[0] + part * capsule.ends[1]
    compared = set[str]()
    for place in rng.uniform(low - 8e-3, high + 8e-3, (150, 3)):
        turn = Rotation.random(random_state=rng)
        points = turn.apply(axis) + place
        distance = float(np.min(distances(points, corners)))
        if distance < 1e-4 or np.any(is_inside(points, corners)):
            continue
        rig.put([(np.zeros(3), UNIT), (place, np.roll(turn.as_quat(), 1))], np.zeros(12))
        facing = np.flatnonzero(rig.geometry[:, 30] <= 0.0)
        nearest = facing[np.argmin(rig.geometry[facing, 0])]
        # a fifth of a tenth of a millimetre between two of the points
        assert -1e-6 < rig.geometry[nearest, 0] - (distance - capsule.radius) < 1e-15
        compared.add(parts_of(rig.contacts[nearest].kinematics, rig.geometry[nearest, 29])[0])
    assert compared == {"face", "edge", "corner"}


@pytest.mark.slow
def test_a_rounded_box_has_the_distance_of_its_core(build: Any) -> None:
    """At random places of cores that are apart: the nearest of what faces each other."""
    box, rng = Box(6e-3, 4e-3, 5e-3, 1e-3, 0.0, 0.0, 0.8, 0.36, -0.48, rounding=1.5e-3), np.random.default_rng(3)
    rig, core = Rig((BRACKET, box), build.laws()), box.core
    corners = BRACKET.features.vertices[BRACKET.features.triangles]
    edges = BRACKET.features.vertices[BRACKET.features.triangles[:, [0, 1, 1, 2, 2, 0]]].reshape(-1, 2, 3)
    part = np.linspace(0.0, 1.0, 21)[:, None, None]
    low, high = BRACKET.bounds
    compared = set[tuple[str, str]]()
    for place in rng.uniform(low - 12e-3, high + 12e-3, (200, 3)):
        turn = Rotation.random(random_state=rng)
        points = turn.apply(core.vertices) + place
        faces, ways = points[list(core.triangles)], points[[edge[:2] for edge in core.edges]]
        rig.put([(np.zeros(3), UNIT), (place, np.roll(turn.as_quat(), 1))], np.zeros(12))
        along = [((1.0 - part) * one[:, 0] + part * one[:, 1]).reshape(-1, 3) for one in (ways, edges)]
        if np.any(is_inside(along[0], corners)) or np.any(is_inside(along[1], faces)):
            continue
        distance = min(segment_distance(ways, edges), float(np.min(distances(points, corners))))
        distance = min(distance, float(np.min(distances(BRACKET.features.vertices, faces))))
        facing = np.flatnonzero(rig.geometry[:, 30] <= 0.0)
        nearest = facing[np.argmin(rig.geometry[facing, 0])]
        assert rig.geometry[nearest, 0] == pytest.approx(distance - box.rounding, abs=1e-15)
        compared.add(parts_of(rig.contacts[nearest].kinematics, rig.geometry[nearest, 29]))
    over = {(part, "corner") for part in ("face", "edge", "corner")}
    assert compared == over | {("edge", "edge"), ("corner", "face"), ("corner", "edge")}


def test_what_is_inside_by_more_than_the_radius_overlaps(build: Any) -> None:
    """However small the radius: a vertex in a face, and a corner of the mesh in a face of the box."""
    mesh, box = TriangleMesh(Triangles(*bracket(), "bracket")), Box(3e-3, 3e-3, 3e-3, rounding=1e-6)
    rig, turn = Rig((mesh, box), build.laws()), Rotation.align_vectors([[0.0, -1.0, 0.0]], [[1.0, 1.0, 1.0]])[0]
    for depth in (1e-8, 1e-6, 2e-6, 1e-4):
        reach = math.sqrt(3.0) * (3e-3 - 1e-6) + 1e-6 - depth
        rig.put(
            [(np.zeros(3), UNIT), (np.array([0.02, 0.01 + reach, 0.007]), np.roll(turn.as_quat(), 1))], np.zeros(12)
        )
        assert np.min(rig.geometry[:, 0]) == pytest.approx(-depth, abs=1e-15)
        tip = np.array([0.03, 0.0, 0.0]) + (3e-3 - depth) * np.array([1.0, -1.0, -1.0]) / math.sqrt(3.0)
        facing = Rotation.align_vectors([[-1.0, 1.0, 1.0]], [[1.0, 0.0, 0.0]])[0]
        rig.put([(np.zeros(3), UNIT), (tip, np.roll(facing.as_quat(), 1))], np.zeros(12))
        assert np.min(rig.geometry[:, 0]) == pytest.approx(-depth, abs=1e-15)


def test_rates_of_the_side_of_a_capsule_are_derivatives(build: Any) -> None:
    """Across an edge and over a corner: gap rate and second-order term against differences."""
    mesh, capsule = TriangleMesh(Triangles(*box())), Capsule(2e-3, 0.05)
    rig, rng = Rig((mesh, capsule), build.laws()), np.random.default_rng(2)
    step, seen = 1e-4, set[str]()
    for way in ((1.0, 1.0, 0.0), (0.3, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, -1.0, 0.8)):
        n = np.array(way) / np.linalg.norm(way)
        across = np.cross(n, [0.0, 0.0, 1.0] if way[2] == 0.0 else [0.6, -0.3, 0.5])
        tilt = Rotation.align_vectors([across / np.linalg.norm(across), n], [[0, 0, 1], [1, 0, 0]])[0]
        touched = np.sign(way) * [0.01, 0.015, 0.025] if way[2] != 0.0 else np.array([0.01, 0.015, 0.004])
        place, u = touched + 3e-3 * n, rng.normal(size=12) * np.repeat([0.02, 1.0, 0.02, 1.0], 3)

        def put(t: float, place: Array = place, tilt: Rotation = tilt, u: Array = u) -> None:
            turns = [Rotation.from_rotvec(t * u[3:6]), Rotation.from_rotvec(t * u[9:12]) * tilt]
            rig.put(
                [
                    (p + t * v, np.roll(turn.as_quat(), 1))
                    for p, v, turn in zip((np.zeros(3), place), (u[:3], u[6:9]), turns, strict=True)
                ],
                np.concatenate([u[:3], turns[0].inv().apply(u[3:6]), u[6:9], turns[1].inv().apply(u[9:12])]),
            )

        put(0.0)
        for i in np.flatnonzero((rig.geometry[:, 30] <= 0.0) & (rig.geometry[:, 0] < 5e-3)):
            part, other = parts_of(rig.contacts[i].kinematics, rig.geometry[i, 29])
            # the side of the capsule is its edge
            if other != "edge":
                continue
            seen.add(part)
            rate, bias = rig.rate[i, 0], rig.bias[i, 0]
            values = {}
            for k in (-2, -1, 1, 2):
                put(k * step)
                values[k] = np.array([rig.geometry[i, 0], rig.rate[i, 0]])
            first = (8.0 * (values[1] - values[-1]) - (values[2] - values[-2])) / (12.0 * step)
            assert rate == pytest.approx(first[0], rel=1e-8, abs=1e-10)
            assert bias == pytest.approx(first[1], rel=1e-6, abs=1e-7)
            put(0.0)
    assert seen == {"edge", "corner"}


@pytest.mark.slow
def test_a_ball_over_many_triangles_has_the_gap_of_the_nearest(build: Any) -> None:
    """Each triangle held against it; the surface is kept once for all patches."""
    points, triangles = hills(40)
    radius, rng = 0.02, np.random.default_rng(12)
    rig = Rig((TriangleMesh(Triangles(points, triangles)), Sphere(radius)), build.laws())
    assert len(rig.contacts) > 10
    surface = rig.contacts[0].kinematics.parameters()["surface_a"]
    assert isinstance(surface, SharedNumbers)
    # and not once for each contact
    assert len(surface) < len(rig._model.memory.floats) < 3 * len(surface)
    for _ in range(60):
        x, y = rng.uniform(-0.9, 0.9, 2)
        center = np.array([x, y, 0.03 * np.sin(9.0 * x) * np.cos(7.0 * y) + rng.uniform(0.018, 0.06)])
        rig.put([(np.zeros(3), UNIT), (center, UNIT)], np.zeros(12))
        blocks = rig.geometry
        gap = np.min(blocks[blocks[:, 30] <= 0.0, 0])
        assert gap == pytest.approx(float(np.min(distances(center[None], points[triangles]))) - radius, abs=1e-14)


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="thousands of searches")
@pytest.mark.parametrize("body", [Sphere(0.03), Ellipsoid(0.03, 0.025, 0.02)], ids=["ball", "ellipsoid"])
def test_a_body_changes_from_face_to_edge_and_on_once_each(body: Any) -> None:
    """Over the border both hold for a margin, with distances that are the same but for round-off: no flicker."""
    rng, seen = np.random.default_rng(5), 0
    ground = TriangleMesh(Triangles(*hills(6)))
    features = ground.features
    contacts = pairs_of(ground, body)
    calls = [pair_caller(one.evaluator, one.parameters(), "contact") for one in contacts]
    a, b, out = np.zeros(FRAME), np.zeros(FRAME), np.zeros(GEOMETRY)
    a[3:12] = np.eye(3).ravel()
    for number in rng.permutation(len(features.edges)):
        one, two, left, right = features.edges[number]
        middle = 0.5 * (features.vertices[one] + features.vertices[two])
        normals = features.planes[[left, right], :3]
        if middle[2] < -0.1 or np.min(normals[:, 2]) < 0.5:
            continue
        # from above the face to above the edge, and a little about the border between them, with the edge's point kept
        along = np.cross(normals[0], features.vertices[two] - features.vertices[one])
        along /= np.linalg.norm(along)
        turn = Rotation.random(random_state=rng).as_matrix()
        b[3:12], lowest = turn.ravel(), turn @ body.solid.support(-turn.T @ normals[0])
        for call in calls:
            last, changes, closed = -1.0, 0, False
            for way in np.linspace(-2e-8, 2e-8, 400) + 1e-12 * rng.normal(size=400):
                b[:3] = middle - lowest + way * along
                out[:] = 0.0
                call(a, b, out)
                changes += out[29] != last and last >= 0.0
                last, closed = out[29], closed or bool(out[30] <= 0.0)
            if closed:
                seen += 1
                assert changes <= 1
    assert seen >= 5
