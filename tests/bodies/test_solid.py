"""Solid: any shape with a volume, filled evenly; the named bodies are the reference."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import (
    Ball,
    Box,
    BoxBody,
    Capsule,
    CapsuleBody,
    Compound,
    Cone,
    ConeBody,
    ConvexHull,
    Cylinder,
    CylinderBody,
    Disc,
    DiscBody,
    Egg,
    Ellipsoid,
    EllipsoidBody,
    FreeBody,
    HullBody,
    MeshBody,
    MovedShape,
    Part,
    Plane,
    Plate,
    Point,
    RigidBody,
    Solid,
    Sphere,
    Superellipsoid,
    SuperellipsoidBody,
    SupportBody,
    TriangleMesh,
    Triangles,
)
from bodies.inertia import tensor_of
from bodies.shapes.moved_shape import moved
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import ConvexShape, Shape
from tests.bodies.meshes import parts

DENSITY = 2700.0
CORNERS = ((0.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.0, 0.2, 0.0), (0.0, 0.0, 0.3), (0.09, 0.1, 0.2))
BRACKET = Triangles(*parts.bracket())
KNOWN: dict[str, tuple[Any, FreeBody]] = {
    "sphere": (Sphere(0.02), Ball(0.02, DENSITY)),
    "box": (Box(0.01, 0.02, 0.035), BoxBody(0.01, 0.02, 0.035, DENSITY)),
    "rounded box": (Box(0.01, 0.02, 0.035, rounding=4e-3), BoxBody(0.01, 0.02, 0.035, DENSITY, rounding=4e-3)),
    "capsule": (Capsule(0.01, 0.03), CapsuleBody(0.01, 0.03, DENSITY)),
    "cone": (Cone(0.02, 0.05), ConeBody(0.02, 0.05, DENSITY, foot_height=0.0)),
    "rounded cone": (Cone(0.02, 0.05, rounding=2e-3), ConeBody(0.02, 0.05, DENSITY, foot_height=0.0, rounding=2e-3)),
    "cylinder": (Cylinder(0.02, 0.03), CylinderBody(0.02, 0.03, DENSITY)),
    "rounded disc": (Disc(0.05, rounding=1e-6), DiscBody(0.05, 2e-6 * DENSITY, rounding=1e-6)),
    "ellipsoid": (Ellipsoid(0.01, 0.02, 0.03), EllipsoidBody(0.01, 0.02, 0.03, DENSITY)),
    "hull": (ConvexHull(CORNERS), HullBody(CORNERS, DENSITY)),
    "rounded hull": (ConvexHull(CORNERS, rounding=0.01), HullBody(CORNERS, DENSITY, rounding=0.01)),
    "superellipsoid": (
        Superellipsoid(0.02, 0.03, 0.04, 0.5, 0.6),
        SuperellipsoidBody(0.02, 0.03, 0.04, 0.5, 0.6, density=DENSITY),
    ),
    "egg": (Egg(), SupportBody(Egg(), DENSITY)),
    "mesh": (TriangleMesh(BRACKET), MeshBody(BRACKET, DENSITY)),
}
"""A shape, and the named body that fills the same shape."""
each_shape = pytest.mark.parametrize(("shape", "named"), KNOWN.values(), ids=KNOWN)
numbers = st.floats(-2.0, 2.0)
vectors = st.tuples(numbers, numbers, numbers).map(np.array)
turns = vectors.map(lambda v: np.roll(Rotation.from_rotvec(v).as_quat(), 1))


def _matrix(quaternion: Any) -> Any:
    return Rotation.from_quat(np.roll(quaternion, -1)).as_matrix()


def _tensor(body: FreeBody) -> Any:
    return tensor_of(body.inertia, body.products)


@each_shape
def test_it_equals_the_named_body(shape: Any, named: FreeBody) -> None:
    """Mass, inertia tensor, and the points of the surface about the mass centre; for a thin disc, to its thickness."""
    body, part = Solid(shape, density=DENSITY), 1e-4 if isinstance(named, DiscBody) else 1e-12
    assert body.total_mass == pytest.approx(named.total_mass, rel=part)
    tensor = _tensor(named)
    np.testing.assert_allclose(_tensor(body), tensor, rtol=0, atol=part * np.max(tensor))
    own, other = body.shapes[0], named.shapes[0]
    assert isinstance(own, type(other)) or isinstance(named, MeshBody)
    if not isinstance(named, MeshBody):
        assert isinstance(own, ConvexShape)
        assert isinstance(other, ConvexShape)
        for direction in np.vstack([np.eye(3), -np.eye(3), [[0.6, 0.0, 0.8], [0.5, -0.7, 0.5]]]):
            heights = [one.support(direction) @ direction for one in (own, other)]
            assert heights[0] == pytest.approx(heights[1], abs=1e-9)


@each_shape
@settings(max_examples=8, deadline=None)
@given(place=vectors, turn=turns, orientation=turns)
def test_place_and_turn_of_the_shape(shape: Any, named: FreeBody, place: Any, turn: Any, orientation: Any) -> None:
    """The place of the shape in its own axes does not matter; turns of the shape and of the body turn the tensor."""
    body = Solid(moved(shape, place, turn), density=DENSITY, orientation=tuple(orientation))
    whole = _matrix(orientation) @ _matrix(turn)
    straight = _tensor(Solid(shape, density=DENSITY))
    np.testing.assert_allclose(_tensor(body), whole @ straight @ whole.T, rtol=0, atol=1e-8 * np.max(straight))
    np.testing.assert_allclose(body.centred_shape.centroid, 0.0, atol=1e-12)
    np.testing.assert_allclose(body.centre, place + _matrix(turn) @ shape.centroid, rtol=0, atol=1e-12)
    assert body.total_mass == pytest.approx(named.total_mass, rel=1e-4)


@each_shape
def test_density_and_mass_agree(shape: Any, named: FreeBody) -> None:
    """The mass that follows from a density gives the same body, and twice the mass twice the inertia."""
    body = Solid(shape, density=DENSITY)
    same, heavier = (Solid(shape, mass=factor * body.total_mass) for factor in (1.0, 2.0))
    assert same.total_mass == body.total_mass == pytest.approx(DENSITY * shape.volume, rel=1e-12)
    assert (same.inertia, same.products) == (body.inertia, body.products)
    np.testing.assert_allclose(_tensor(heavier), 2.0 * _tensor(body), rtol=1e-15)


def test_principal_axes_stay_principal() -> None:
    """Products of inertia of a turned cube are round-off; without them the body has a closed form of free motion."""
    cube = Solid(Box(0.01, 0.01, 0.01), density=DENSITY, orientation=(math.cos(0.4), math.sin(0.4), 0.0, 0.0))
    assert cube.products == (0.0, 0.0, 0.0)
    assert Solid(Egg(), density=DENSITY).flight is not None


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({}, ("Solid: density or mass", "exactly one of the two", "'density': None, 'mass': None")),
        ({"density": 100.0, "mass": 2.0}, ("Solid: density or mass", "exactly one", "'density': 100.0, 'mass': 2.0")),
        ({"density": -1.0}, ("Solid.density", "> 0")),
        ({"mass": 0.0}, ("Solid.mass", "> 0")),
        ({"mass": 1.0, "orientation": (1.0, 1.0, 0.0, 0.0)}, ("Solid.orientation", "unit quaternion")),
        *(
            ({"mass": 1.0, "shape": shape}, ("Solid.shape", "must be a shape with a volume", "DiscBody"))
            for shape in (Plane(), Point(), Disc(0.1), BRACKET, Ball(0.1), 3.0)
        ),
    ],
)
def test_mistakes(values: dict[str, Any], words: tuple[str, ...]) -> None:
    """A mistake is named, with the rule and the value."""
    with pytest.raises(InvalidInput) as caught:
        Solid(**{"shape": Box(0.1, 0.1, 0.1)} | values)
    assert all(word in str(caught.value) for word in words), str(caught.value)


@pytest.mark.parametrize("name", ["box", "egg", "mesh"])
def test_a_shape_that_is_moved_can_be_moved_again(name: str) -> None:
    """The shape of a solid fills another solid."""
    again = Solid(Solid(KNOWN[name][0], density=DENSITY).centred_shape, density=DENSITY)
    np.testing.assert_allclose(again.centre, 0.0, atol=1e-12)
    assert isinstance(again.shapes[0], (Box, MovedShape, TriangleMesh))


def test_a_compound_moves_a_shape_known_by_its_farthest_points() -> None:
    """Such a shape has no numbers that say where it is."""
    carrier = RigidBody(1.0, (1e-4, 1e-4, 1e-4), (Egg(),))
    turn = (math.cos(0.3), 0.0, math.sin(0.3), 0.0)
    body = Compound((Part(carrier, (0.1, 0.0, 0.0), turn), Part(carrier, (-0.1, 0.0, 0.0))))
    moved_egg, direction = body.shapes[0], np.array([0.3, -0.5, 0.8])
    assert isinstance(moved_egg, MovedShape)
    expected = np.array([0.1, 0.0, 0.0]) + _matrix(turn) @ Egg().support(_matrix(turn).T @ direction)
    np.testing.assert_allclose(moved_egg.support(direction), expected, atol=1e-12)


def _bounce(body: FreeBody) -> Any:
    plate = Plate()
    system = ns.System([plate, body], 9.81)
    system.contact(plate, body, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.6))
    system.place(body, position=(0.0, 0.0, 0.1), orientation=(0.5, 0.5, -0.5, 0.5), angular_velocity=(3.0, 2.0, 1.0))
    return ns.simulate(system, 0.2)


@pytest.mark.parametrize(
    ("shape", "named"),
    [(KNOWN[name][0], KNOWN[name][1]) for name in ("box", "ellipsoid", "hull")],
    ids=["box", "ellipsoid", "hull"],
)
def test_it_moves_as_the_named_body(shape: Shape, named: FreeBody) -> None:
    """Free motion and impacts with friction on a plate."""
    own, other = (_bounce(body) for body in (Solid(shape, density=DENSITY), named))
    assert own.status == other.status == "done"
    assert len(own.events) == len(other.events) > 0
    np.testing.assert_allclose(own.q_end, other.q_end, rtol=0, atol=1e-5)
