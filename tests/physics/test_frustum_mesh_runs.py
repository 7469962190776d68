"""Cylinders, cones and discs in motion against meshes that are not convex: closed forms, rest, conservation."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import Cone, Cylinder, CylinderBody, Disc, DrivenBody, Frustum, Rest, TriangleMesh, Triangles
from bodies.contacts.frustum.frustum import nearest_part
from bodies.shapes.frustum import AXIS, CENTER, FEET
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.memory.modes import CAUSES
from nonsmooth.engine.native.kernel import PLAIN
from tests.bodies.meshes.parts import bracket, channel
from tests.bodies.round_distances import core_distance
from tests.bodies.surfaces import distances, is_inside
from tests.physics.test_mesh_runs import collision

Array = NDArray[Any]
pytestmark = pytest.mark.skipif(PLAIN, reason="compiled runs take seconds, plain ones minutes")

SHAPES = {
    "cylinder": Cylinder(6e-3, 8e-3),
    "flat cylinder": Cylinder(8e-3, 3e-3, foot_height=8e-7),
    "log": Cylinder(4e-3, 0.03),
    "cone": Cone(6e-3, 0.016),
    "disc": Disc(9e-3),
}
ROUNDED = {
    "cylinder": Cylinder(6e-3, 8e-3, foot_height=6e-7, rounding=1e-3),
    "cone": Cone(6e-3, 0.016, rounding=1e-3),
    "disc": Disc(9e-3, rounding=1e-3),
}
PARTS = {"L": bracket, "U": channel}


def _mesh(part: Any) -> TriangleMesh:
    """Return a part about the middle of its corners, whose outline is drawn in x and z, along y."""
    points, triangles = part()
    # a turn, not a reflection
    placed = (points - np.mean(points, axis=0))[:, [0, 2, 1]] * [1.0, -1.0, 1.0]
    return TriangleMesh(Triangles(placed, triangles))


def _deepest(mesh: TriangleMesh, shape: Frustum, q: Array) -> float:
    """Return how far a point of a rim, of a line of the side or of an edge of the mesh is inside of the other [m]."""
    own, numbers = mesh.features, shape.frustum
    corners, part = own.vertices[own.triangles], np.linspace(0.0, 1.0, 11)[:, None]
    edges = np.vstack([(1.0 - part) * own.vertices[e[0]] + part * own.vertices[e[1]] for e in own.edges])
    center, axes = np.array(numbers[CENTER : CENTER + 3]), np.array(numbers[AXIS - 2 : AXIS + 7]).reshape(3, 3)
    angles = np.linspace(0.0, 2.0 * np.pi, 37)
    rings = [
        np.stack([radius * np.cos(angles), radius * np.sin(angles), np.full_like(angles, height)], axis=1)
        for radius, height in np.linspace(numbers[:4:2], numbers[1:4:2], 7)
    ]
    turns = [Rotation.from_quat(np.roll(q[7 * i + 3 : 7 * i + 7], -1)) for i in range(2)]
    apart = q[7:10] - q[:3]
    points = turns[0].inv().apply(turns[1].apply(center + np.vstack(rings) @ axes.T) + apart)
    inside = is_inside(points, corners)
    deepest = float(np.max(distances(points[inside], corners), initial=0.0))
    local = turns[1].inv().apply(turns[0].apply(edges) - apart) - center
    along = local @ axes[:, 2]
    away = np.linalg.norm(local - along[:, None] * axes[:, 2], axis=1)
    heights = [nearest_part(numbers, float(a), float(r))[0] for a, r in zip(along, away, strict=True)]
    return float(max(deepest, -min(heights)))


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize("name", SHAPES)
def test_collisions_keep_momentum_and_energy(build: Any, name: str, part: str) -> None:
    """Without friction and with e = 1, in three collisions; and neither is ever inside of the other."""
    mesh, shape = _mesh(PARTS[part]), SHAPES[name]
    for seed in range(3):
        solution, momentum = collision(build, (mesh, shape), seed)
        assert solution.counters.impacts > 0
        np.testing.assert_allclose(momentum[1], momentum[0], rtol=0, atol=1e-12)
        assert solution.energy.residual < 1e-9
        assert max(_deepest(mesh, shape, q) for q in solution.q[::10]) < 1e-9


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize("name", ROUNDED)
def test_collisions_of_rounded_ones_keep_momentum_and_energy(build: Any, name: str, part: str) -> None:
    """Their cores are never nearer than the radius."""
    mesh, shape = _mesh(PARTS[part]), ROUNDED[name]
    for seed in range(3):
        solution, momentum = collision(build, (mesh, shape), seed)
        assert solution.counters.impacts > 0
        np.testing.assert_allclose(momentum[1], momentum[0], rtol=0, atol=1e-12)
        assert solution.energy.residual < 1e-9
        for q in solution.q[::30]:
            turns = [Rotation.from_quat(np.roll(q[7 * i + 3 : 7 * i + 7], -1)) for i in range(2)]
            place = turns[0].inv().apply(q[7:10] - q[:3])
            distance = core_distance(mesh, shape, place, turns[0].inv() * turns[1])
            assert distance > shape.rounding - shape.frustum[FEET] - 1e-9


@pytest.mark.parametrize("name", ["cylinder", "cone"])
def test_collisions_with_friction_keep_them_apart(build: Any, name: str) -> None:
    mesh, shape = _mesh(channel), SHAPES[name]
    solution, momentum = collision(build, (mesh, shape), 4, 0.5, 0.3)
    assert solution.counters.impacts > 0
    np.testing.assert_allclose(momentum[1], momentum[0], rtol=0, atol=1e-12)
    assert max(_deepest(mesh, shape, q) for q in solution.q[::5]) < 1e-9


def _system(part: Any, body: CylinderBody, slope: float, place: Any, friction: float, restitution: float) -> ns.System:
    """Return a cylinder along y, at a place in the axes of a part that stands on a slope, down along x."""
    ground = DrivenBody(Rest(slope), (_mesh(part),))
    system = ns.System([ground, body])
    impact = EnergeticImpact(restitution=restitution)
    system.contact(ground, body, normal=Unilateral(), friction=Coulomb(friction), impact=impact)
    turn = Rotation.from_euler("y", slope)
    lying = turn * Rotation.from_euler("x", 0.5 * np.pi)
    system.place(body, position=tuple(turn.apply(place).tolist()), orientation=tuple(np.roll(lying.as_quat(), 1)))
    return system


def test_a_cylinder_rolls_down_inside_a_channel_until_it_strikes_the_wall() -> None:
    """At 2/3 g sin(slope), over the floor of a U on a slope; the wall stops it after sqrt(2 way / acceleration)."""
    radius, slope = 3e-3, 0.2
    wall, mesh = 0.01, _mesh(channel)
    floor = float(np.unique(mesh.features.vertices[:, 2].round(12))[1])
    start = -6e-3
    system = _system(channel, CylinderBody(radius, 8e-3), slope, (start, 0.0, floor + radius), 0.5, 0.5)
    acceleration = 2.0 / 3.0 * 9.81 * math.sin(slope)
    meets = math.sqrt(2.0 * (wall - radius - start) / acceleration)
    solution = ns.simulate(system, 1.2 * meets, sample_interval=meets / 20.0)
    assert [CAUSES[c] for c in solution.events.cause][:2] == ["start", "impact"]
    assert solution.events.time[1] == pytest.approx(meets, abs=1e-9)
    turn = Rotation.from_euler("y", slope)
    rolling = solution.t < meets
    places = turn.inv().apply(solution.q[rolling, :3])
    np.testing.assert_allclose(places[:, 0], start + 0.5 * acceleration * solution.t[rolling] ** 2, rtol=0, atol=1e-9)
    np.testing.assert_allclose(places[:, 2], floor + radius, rtol=0, atol=1e-11)
    assert abs(turn.inv().apply(solution.q_end[:3])[1]) < 1e-9


@pytest.mark.parametrize("rounding", [0.0, 5e-4])
def test_a_cylinder_comes_to_rest_in_the_corner_of_an_l(rounding: float) -> None:
    """It rolls down the slope and lies against the wall at last, on both rims at either."""
    radius, mesh = 2e-3, _mesh(bracket)
    # the wall of the L stands at low x: down along -x
    x, z = (float(np.unique(mesh.features.vertices[:, i].round(12))[1]) for i in (0, 2))
    body = CylinderBody(radius, 5e-3, rounding=rounding)
    solution = ns.simulate(_system(bracket, body, -0.3, (x + 8e-3, 1e-3, z + radius + 1e-3), 0.3, 0.3), 1.0)
    place = Rotation.from_euler("y", -0.3).inv().apply(solution.q_end[:3])
    assert solution.status == "done"
    np.testing.assert_allclose(place[[0, 2]], [x + radius, z + radius], rtol=0, atol=1e-9)
    assert np.max(np.abs(solution.u_end)) < 1e-8
    assert np.count_nonzero(solution.events.after[-1]) == 4


@pytest.mark.parametrize("seed", [0, 40])
def test_a_cylinder_that_falls_spinning_onto_a_channel_does_not_pass_into_it(seed: int) -> None:
    """In one of the two a rim leans over the edge of the floor on two contacts that all but repeat each other."""
    mesh, body, rng = _mesh(channel), CylinderBody(5e-3, 4e-3), np.random.default_rng(seed)
    ground = DrivenBody(Rest(), (mesh,))
    system = ns.System([ground, body])
    system.contact(ground, body, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(restitution=0.3))
    turn = rng.normal(size=4)
    system.place(
        body,
        position=tuple((np.array([0.0, 0.0, 0.03]) + rng.uniform(-2e-3, 2e-3, 3)).tolist()),
        orientation=tuple((turn / np.linalg.norm(turn)).tolist()),
        velocity=tuple((0.05 * rng.normal(size=3)).tolist()),
        angular_velocity=tuple((10.0 * rng.normal(size=3)).tolist()),
    )
    solution = ns.simulate(system, 0.3)
    assert solution.status == "done"
    assert solution.energy.residual < 1e-8
    (shape,) = body.shapes
    assert isinstance(shape, Cylinder)
    stands = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
    # caps are no contacts between their feet
    assert max(_deepest(mesh, shape, np.concatenate([stands, q])) for q in solution.q[::10]) < shape.foot_height + 1e-9


@pytest.mark.parametrize("rounding", [0.0, 1e-3])
def test_a_cylinder_stands_in_a_channel_on_its_feet(rounding: float) -> None:
    """On three feet on the floor between the walls."""
    mesh = _mesh(channel)
    floor = float(np.unique(mesh.features.vertices[:, 2].round(12))[1])
    ground, body = DrivenBody(Rest(), (mesh,)), CylinderBody(6e-3, 8e-3, rounding=rounding)
    system = ns.System([ground, body])
    system.contact(ground, body, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(restitution=0.3))
    system.place(body, position=(1e-3, 5e-4, floor + 8e-3))
    solution = ns.simulate(system, 0.2)
    assert np.count_nonzero(solution.events.after[-1]) == 3
    np.testing.assert_allclose(solution.q_end, solution.q[0], rtol=0, atol=1e-10)
