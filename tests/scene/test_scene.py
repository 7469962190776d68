"""What is seen of bodies, and where it is."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import nonsmooth as ns
from bodies import Ball, DrivenBody, Dumbbell, Hinge, HullBody, PlanarBody, Plate, Point, RigidBody, Rod, Sphere, Spring
from nonsmooth.interfaces.look import Look
from nonsmooth.plugins import registry
from nonsmooth.scene.scene import Scene, knots


def _volume(look: Look) -> float:
    a, b, c = (look.vertices[look.triangles[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


@pytest.mark.slow
@given(st.integers(0, 2**32 - 1))
def test_the_hull_of_points_is_closed_and_faces_outwards(seed: int) -> None:
    points = np.random.default_rng(seed).normal(size=(12, 3))
    look = Look.hull(points)
    from scipy.spatial import ConvexHull

    assert _volume(look) == pytest.approx(ConvexHull(points).volume, rel=1e-9)


def test_points_in_a_plane_on_a_line_and_at_a_place_are_a_face_a_line_and_a_mark() -> None:
    square = Look.hull([(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)])
    assert len(square.triangles) == 4
    assert _volume(square) == pytest.approx(0.0, abs=1e-15)
    line = Look.hull([(0, 0, 0), (1, 1, 1), (0.4, 0.4, 0.4)])
    assert len(line.triangles) == 0
    np.testing.assert_allclose(np.sort(line.vertices, axis=0), [(0, 0, 0), (1, 1, 1)], atol=1e-15)
    assert len(line.lines) == 1
    assert len(Look.hull([(1.0, 2.0, 3.0)]).vertices) == 1


def test_a_solid_without_a_drawing_is_seen_as_its_hull() -> None:
    ball = Ball(0.02)
    solid = ball.shapes[0].solid
    assert solid is not None
    assert _volume(Look.spanned(solid)) == pytest.approx(4.0 / 3.0 * np.pi * 0.02**3, rel=0.05)


def test_corners_of_a_frame_are_seen_as_what_they_span() -> None:
    corners = tuple(Point(x, 0.0, z) for x in (-0.5, 0.5) for z in (-0.2, 0.2))
    scene = Scene.of(ns.System([Plate(), PlanarBody(1.0, 1.0, corners)]))
    sheet, block = scene.parts
    assert sheet.look.sheet
    assert len(block.look.triangles) == 4


def test_ends_that_are_too_small_to_be_seen_are_joined() -> None:
    ends = tuple(Sphere(1e-5, x=x) for x in (-0.1, 0.1))
    (rod,) = Scene.of(ns.System([RigidBody(1.0, np.eye(3).tolist(), ends)])).parts
    np.testing.assert_allclose(rod.look.vertices, [(-0.1, 0, 0), (0.1, 0, 0)], atol=1e-15)
    assert len(rod.look.lines) == 1


def test_the_rod_of_a_dumbbell_joins_its_balls() -> None:
    body = Dumbbell()
    (rod,) = body.sketch
    half = 0.5 * body.centre_distance
    np.testing.assert_allclose(rod.vertices, [(-half, 0, 0), (half, 0, 0)])


def test_springs_and_joints_are_lines_between_what_they_tie() -> None:
    bar, other = Rod(0.2, 0.005), Rod(0.1, 0.005)
    system = ns.System([Plate(), bar, other])
    system.joint(Hinge((0.1, 0.0, 0.0), (-0.05, 0.0, 0.0)), bar, other)
    system.load(Spring(10.0, 0.1, second=(0.0, 0.0, 0.01)), system.bodies[0], other)
    system.place(bar, position=(0.0, 0.0, 0.5))
    system.place(other, position=(0.15, 0.0, 0.5), velocity=(0.0, 0.0, 0.0))
    run = ns.simulate(system, 0.1)
    scene, states = Scene.of(system), run.at()
    origin, axes = scene.places(states.time, states["q"], states["u"])

    def ends(stroke: object) -> np.ndarray:
        frames, points = stroke.frames, stroke.ends  # type: ignore[attr-defined]
        return np.array([origin[:, f] + axes[:, f] @ p for f, p in zip(frames, points, strict=True)])

    # rods end at the hinge: no line goes through them
    (joint,) = (stroke for stroke in scene.strokes if stroke.kind == "joint")
    first, second = ends(joint)
    np.testing.assert_allclose(first, second, atol=1e-8)
    (spring,) = (stroke for stroke in scene.strokes if stroke.kind == "load")
    at_plate, at_rod = ends(spring)
    np.testing.assert_allclose(at_plate, 0.0, atol=1e-15)
    np.testing.assert_allclose(at_rod, origin[:, 2] + axes[:, 2] @ (0.0, 0.0, 0.01))


def test_a_body_that_ends_before_its_joint_is_joined_to_it_by_a_line() -> None:
    base, bob = DrivenBody(), Ball(0.02)
    system = ns.System([base, bob])
    system.joint(Hinge((0.0, 0.0, 0.0), (0.0, 0.0, 0.4)), base, bob)
    between, line = Scene.of(system).strokes
    assert between.frames == (0, 1)
    assert line.frames == (1, 1)
    np.testing.assert_array_equal(line.ends, [(0.0, 0.0, 0.0), (0.0, 0.0, 0.4)])


def test_links_of_a_mechanism_end_where_its_frames_are() -> None:
    scenario = registry.load("scenarios", "two_link_arm")(t_end=0.2)
    system = scenario.build()
    run = ns.simulate(system, scenario.t_end)
    scene, states = Scene.of(system), run.at()
    origin, _ = scene.places(states.time, states["q"], states["u"])
    _, links = (stroke for stroke in scene.strokes if stroke.kind == "link")
    np.testing.assert_allclose(origin[:, links.frames[1]], origin[:, 0], atol=1e-12)


def test_frames_are_where_poses_say() -> None:
    box = HullBody([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    system = ns.System([Plate(), box, RigidBody(1.0, np.eye(3).tolist(), (Point(),))])
    for one, two in itertools.combinations(system.bodies, 2):
        system.exclude(one, two)
    system.place(box, position=(0.0, 0.0, 3.0), angular_velocity=(1.0, 2.0, 3.0))
    run = ns.simulate(system, 0.2)
    scene, states = Scene.of(system), run.at()
    origin, axes = scene.places(states.time, states["q"], states["u"])
    poses = run.history("position", "rotation", of=box)
    np.testing.assert_array_equal(origin[:, 1], poses["position"][:, 0])
    np.testing.assert_array_equal(axes[:, 1], poses["rotation"][:, 0])


def test_a_run_of_few_samples_is_followed_between_them() -> None:
    ball = Ball(0.01)
    system = ns.System([Plate(), ball])
    system.exclude(system.bodies[0], ball)
    system.place(ball, position=(0.0, 0.0, 1.0))
    run = ns.simulate(system, 0.4, sample_interval=0.2)
    times = knots(run, 4000)
    assert len(times) >= 600
    z = run.at(times)["q"][:, 2]
    np.testing.assert_allclose(z, 1.0 - 0.5 * 9.81 * times**2, atol=1e-12)


def test_of_many_samples_so_many_are_left_and_all_instants_of_events() -> None:
    scenario = registry.load("scenarios", "bouncing_ball")(t_end=0.5)
    run = ns.simulate(scenario.build(), 0.5, sample_interval=1e-4)
    times = knots(run, 100)
    assert np.all(np.isin(run.events.time, times))
    assert len(times) <= 103 + len(np.unique(run.events.time))
