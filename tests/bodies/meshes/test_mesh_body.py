"""Bodies with the surface of a mesh: mass properties, motion over a plane, refusals, decomposition."""

from __future__ import annotations

import dataclasses
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import (
    Ball,
    BoxBody,
    Compound,
    ConvexHull,
    Decomposition,
    Dumbbell,
    MeshBody,
    MeshFile,
    Part,
    Plate,
    Point,
    RigidBody,
    TriangleMesh,
    Triangles,
)
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.errors import MissingPackagesError
from nonsmooth.interfaces import Body, Shape
from nonsmooth.model.assembly import assemble
from nonsmooth.parameters import UnusualValue
from scenarios.dumbbell import DumbbellScenario
from scenarios.rocking_block import RockingBlock3D
from tests.bodies.carriers import Carrier
from tests.bodies.meshes import parts

BOX, BRACKET = Triangles(*parts.box(), "box"), Triangles(*parts.bracket(), "bracket")


def test_a_mesh_of_a_box_is_a_box() -> None:
    """Mass and inertia of the closed form; the frame is at the mass centre, wherever the mesh is."""
    away = Triangles(*parts.box(at=(0.1, -0.2, 0.3)))
    body, exact = MeshBody(away, density=2700.0), BoxBody(0.01, 0.015, 0.025, density=2700.0)
    assert body.total_mass == pytest.approx(exact.total_mass, rel=1e-14)
    np.testing.assert_allclose(body.inertia, exact.inertia, rtol=1e-13)
    assert body.products == (0.0, 0.0, 0.0)
    np.testing.assert_allclose(body.centre, [0.1, -0.2, 0.3], rtol=1e-14)
    assert MeshBody(away, mass=0.5).total_mass == 0.5
    np.testing.assert_allclose(MeshBody(away, mass=0.5).inertia, BoxBody(0.01, 0.015, 0.025, mass=0.5).inertia)
    assert MeshBody(away).total_mass == pytest.approx(7800.0 * 3e-5)


def test_an_angle_is_two_boxes() -> None:
    """The L as a mesh and as a compound of two boxes: centre, mass, inertia with its product."""
    body = MeshBody(BRACKET, density=1000.0)
    lying, standing = BoxBody(0.015, 0.005, 0.0075, 1000.0), BoxBody(0.005, 0.005, 0.0075, 1000.0)
    whole = Compound((Part(lying, (0.015, 0.005, 0.0075)), Part(standing, (0.005, 0.015, 0.0075))))
    assert body.total_mass == pytest.approx(whole.total_mass, rel=1e-14)
    np.testing.assert_allclose(body.centre, whole.centre, rtol=1e-13)
    np.testing.assert_allclose(body.inertia, whole.inertia, rtol=1e-12)
    np.testing.assert_allclose(body.products, whole.products, rtol=1e-12, atol=1e-20)


def test_wrong_input() -> None:
    with pytest.raises(ns.InvalidInput, match="mass must not be given together"):
        MeshBody(BOX, density=1000.0, mass=1.0)
    with pytest.raises(ns.InvalidInput, match=r"MeshBody\.surface must be a surface.*MeshFile"):
        MeshBody("part.stl")  # type: ignore[arg-type]
    with pytest.raises(ns.InvalidInput, match=r"left out for a convex mesh.*box, 1\.000000"):
        MeshBody(BOX, decomposition=Decomposition())
    with pytest.raises(ns.InvalidInput, match=r"Decomposition\.pieces must be a whole number"):
        Decomposition(pieces=2.5)


def _dropped(build: Any, body: Body, t_end: float) -> ns.Solution:
    floor = Plate()
    system = ns.System([floor, body])
    system.contact(floor, body, **build.laws())
    turn = np.array([0.9, 0.2, -0.3, 0.1])
    ns.at_height(system, body, 0.01, orientation=turn / np.linalg.norm(turn), angular_velocity=(1.0, 2.0, -3.0))
    return ns.simulate(system, t_end)


def test_a_convex_mesh_is_its_hull() -> None:
    """About the mass centre; with more corners than a hull may have it stays a mesh, which touches planes."""
    (shape,) = MeshBody(Triangles(*parts.box(at=(0.1, -0.2, 0.3)))).shapes
    assert isinstance(shape, ConvexHull)
    np.testing.assert_allclose(sorted(shape.polytope.vertices), sorted(parts.box()[0].tolist()), atol=1e-15)
    trimesh = pytest.importorskip("trimesh")
    ball = trimesh.creation.icosphere(subdivisions=3)
    (shape,) = MeshBody(Triangles(0.01 * ball.vertices, ball.faces, "ball")).shapes
    assert isinstance(shape, TriangleMesh)
    assert "ball is convex but has 642 corners" in shape.advice


@pytest.mark.skipif(PLAIN, reason="minutes in plain mode")
def test_a_mesh_of_a_box_moves_as_a_box(build: Any) -> None:
    """The same corners in another order: the same impacts, at the same times."""
    mesh = _dropped(build, MeshBody(BOX, density=1000.0), 0.12)
    box = _dropped(build, BoxBody(0.01, 0.015, 0.025, density=1000.0), 0.12)
    assert mesh.counters.impacts == box.counters.impacts > 2
    np.testing.assert_allclose(mesh.events.time, box.events.time, rtol=0, atol=1e-9)
    np.testing.assert_allclose(mesh.q_end, box.q_end, rtol=0, atol=1e-9)


@pytest.mark.skipif(PLAIN, reason="minutes in plain mode")
@pytest.mark.parametrize("direction", [0.0, 0.7])
def test_a_mesh_of_a_block_rocks_as_the_block(direction: float) -> None:
    """On an edge and on a corner, through several landings: the same times, the same motion."""
    scenario = RockingBlock3D(direction=direction, t_end=1.5)
    system = scenario.build()
    contact, block = system.contacts[0], system.bodies[1]
    surface = Triangles(*parts.box(scenario.base, scenario.depth, scenario.height, at=(1.0, 0.0, -2.0)), "block")
    ground, body = Plate(), MeshBody(surface, mass=scenario.mass)
    other = ns.System([ground, body])
    assert contact.impact is not None
    other.contact(ground, body, normal=contact.normal, friction=contact.friction, impact=contact.impact)
    other.set_start(body, *system.start(block))
    one, two = ns.simulate(system, scenario.t_end), ns.simulate(other, scenario.t_end)
    assert one.counters.impacts == two.counters.impacts >= 3
    np.testing.assert_allclose(two.events.time, one.events.time, rtol=0, atol=1e-9)
    np.testing.assert_allclose(two.q_end, one.q_end, rtol=0, atol=1e-9)
    np.testing.assert_allclose(two.u_end, one.u_end, rtol=0, atol=1e-9)


def test_a_mesh_that_is_not_convex_meets_a_plane_with_its_hull(build: Any) -> None:
    """Lowest point of the mesh over a turned floor: one gap for each corner of the hull, none for the inner corner."""
    floor, body = Plate(), MeshBody(BRACKET)
    system = ns.System([floor, body])
    assert len(system.contact(floor, body, **build.laws())) == 10
    turn = np.array([0.9, 0.2, -0.3, 0.1]) / np.linalg.norm([0.9, 0.2, -0.3, 0.1])
    ns.touching(system, body, orientation=turn)
    (shape,) = body.shapes
    assert isinstance(shape, TriangleMesh)
    from nonsmooth.rotations import rotation

    heights = shape.drawing()[0] @ rotation(turn)[2]
    assert system.start(body)[0][2] == pytest.approx(-np.min(heights), abs=1e-15)


def test_a_mesh_that_is_not_convex_refuses_other_pairs(build: Any) -> None:
    """With its volume over that of the hull, and what to do."""

    class Unknown(Shape):
        @property
        def length(self) -> float:
            return 1.0

    stranger, body = Carrier((Unknown(),)), MeshBody(BRACKET)
    system = ns.System([stranger, body])
    with pytest.raises(ns.InvalidInput, match=r"bracket has 80\.0% of the volume of its convex hull.*decomposition="):
        system.contact(stranger, body, **build.laws())


def test_shape() -> None:
    """Support, bounds, centre and drawing of a mesh that stands turned in its body."""
    shape = TriangleMesh(BRACKET, 0.1, 0.2, 0.3, 0.8, 0.36, -0.48, 0.0)
    points, faces = shape.drawing()
    np.testing.assert_allclose(shape.bounds, (np.min(points, axis=0), np.max(points, axis=0)), rtol=1e-15)
    for direction in np.random.default_rng(3).normal(size=(20, 3)):
        assert shape.support(direction) @ direction == pytest.approx(np.max(points @ direction), abs=1e-16)
    assert shape.length == pytest.approx(np.max(np.linalg.norm(points, axis=1)), rel=1e-15)
    from bodies.meshes.integrals import mass_properties

    volume, centre, inertia = mass_properties(points, faces)
    assert shape.volume == pytest.approx(volume, rel=1e-13)
    np.testing.assert_allclose(shape.centroid, centre, rtol=1e-12)
    np.testing.assert_allclose(shape.inertia, inertia, atol=1e-12 * np.max(inertia))


def test_a_compound_holds_a_mesh() -> None:
    """Moved within it, corners and all."""
    turn = (0.8, 0.36, -0.48, 0.0)
    compound = Compound((Part(Ball(0.005)), Part(MeshBody(BRACKET), (0.03, 0.0, 0.01), turn)))
    shape = compound.shapes[1]
    assert isinstance(shape, TriangleMesh)
    from nonsmooth.rotations import rotation

    (own,) = MeshBody(BRACKET).shapes
    assert isinstance(own, TriangleMesh)
    expected = own.corners @ rotation(turn).T + np.array([0.03, 0.0, 0.01]) - np.array(compound.centre)
    np.testing.assert_allclose(shape.corners, expected, atol=1e-15)


def test_many_corners_are_warned_of(build: Any) -> None:
    trimesh = pytest.importorskip("trimesh")
    ball = trimesh.creation.icosphere(subdivisions=3)
    floor, body = Plate(), MeshBody(Triangles(0.01 * ball.vertices, ball.faces, "ball"))
    system = ns.System([floor, body])
    with pytest.warns(UnusualValue, match=r"TriangleMesh: its hull has 642 corners.*Sphere"):
        system.contact(floor, body, **build.laws())


def test_a_file_of_a_system_names_the_mesh(tmp_path: Path, build: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """Saved and read, it is the same system, the file of the mesh beside it."""
    monkeypatch.chdir(tmp_path)
    parts.write_stl(Path("part.stl"), parts.bracket())
    floor, body = Plate(), MeshBody(MeshFile("part.stl", unit="m", repair=("merge",)), density=2700.0)
    system = ns.System([floor, body])
    system.contact(floor, body, **build.laws())
    ns.save_system(system, "system.toml", t_end=0.1)
    text = Path("system.toml").read_text(encoding="utf-8")
    assert "part.stl" in text
    again = ns.load_system("system.toml").system.bodies[1]
    assert again == body


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return an empty cache of decompositions."""
    from bodies.meshes import decomposition

    monkeypatch.setattr(decomposition, "_folder", lambda: tmp_path / "cache")
    return tmp_path / "cache"


def test_without_the_package_a_decomposition_says_what_to_install(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "vhacdx", None)
    with pytest.raises(MissingPackagesError, match=r'bracket needs vhacdx: pip install "nonsmooth\[meshes\]"'):
        _ = MeshBody(BRACKET, decomposition=Decomposition()).shapes


def test_a_decomposition_covers_the_body_and_is_kept(cache: Path, monkeypatch: pytest.MonkeyPatch, build: Any) -> None:
    """Pieces have the volume of the body to some percent, the mass is the body's own, and the second time is a look-up.

    A point in the corner of the L is as far from its arms as it is, not inside of a hull.
    """
    pytest.importorskip("vhacdx")
    body = MeshBody(BRACKET, 1000.0, decomposition=Decomposition(pieces=8.0))
    pieces = [shape for shape in body.shapes if isinstance(shape, ConvexHull)]
    assert 2 <= len(pieces) == len(body.shapes) <= 8
    assert sum(piece.volume for piece in pieces) == pytest.approx(BRACKET.mesh.volume, rel=0.05)
    np.testing.assert_allclose(body.inertia, MeshBody(BRACKET, 1000.0).inertia)
    assert len(list(cache.iterdir())) == 1
    monkeypatch.setitem(sys.modules, "vhacdx", None)
    again = MeshBody(BRACKET, 1000.0, decomposition=Decomposition(pieces=8.0))
    assert again.shapes == body.shapes
    probe = RigidBody(0.1, (1e-6, 1e-6, 1e-6), (Point(0.0, 0.0, 0.0),))
    system = ns.System([probe, body])
    system.contact(probe, body, **build.laws())
    # 2 mm over the lying arm and 3 mm from the standing one, well inside of the hull
    place = np.array([0.013, 0.012, 0.0075]) - body.centre
    system.place(probe, position=tuple(place.tolist()))
    assert np.min(assemble(system, ns.EventDriven()).gaps()) == pytest.approx(0.002, abs=3e-4)


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="minutes in plain mode")
def test_a_dumbbell_of_meshes_is_none_of_spheres() -> None:
    """Balls of 20 to 1280 triangles on the paper's plate: the time between two impacts is off, less with more of them.

    A polyhedron is exact as a polyhedron only: the third time differs by milliseconds still.
    """
    trimesh = pytest.importorskip("trimesh")
    scenario = DumbbellScenario(mode="drift")
    system = scenario.build()
    (dumbbell,) = (body for body in system.bodies if isinstance(body, Dumbbell))
    plate, contact = next(body for body in system.bodies if body is not dumbbell), system.contacts[0]
    assert contact.impact is not None

    def impacts(one: ns.System) -> Any:
        events = ns.simulate(one, 0.1).events
        return events.time[events.cause == Cause.IMPACT]

    exact, half, off = impacts(system), 0.5 * dumbbell.centre_distance, []
    for level in (0, 1, 3):
        ball = trimesh.creation.icosphere(subdivisions=level)
        surface = Triangles(dumbbell.radius * ball.vertices, ball.faces, "ball")
        body = RigidBody(
            dumbbell.total_mass, dumbbell.inertia, (TriangleMesh(surface, -half), TriangleMesh(surface, half))
        )
        other = ns.System([plate, body])
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UnusualValue)
            other.contact(plate, body, normal=contact.normal, friction=contact.friction, impact=contact.impact)
        other.set_start(body, *system.start(dumbbell))
        off.append(abs(impacts(other)[1] - exact[1]))
    assert off[0] > off[2]
    assert off[1] > off[2]
    assert 1e-5 < off[2] < 5e-3


def test_fields_of_a_body_are_its_words() -> None:
    assert [f.name for f in dataclasses.fields(MeshBody)] == ["surface", "density", "mass", "decomposition"]
