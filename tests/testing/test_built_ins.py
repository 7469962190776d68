"""All built-ins have the properties that plug-ins must have.

That ``nonsmooth check`` finds and runs them by their names is looked at in tests/cli, of one name for each group.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from bodies import (
    Ball,
    Box,
    BoxBody,
    Bushing,
    Capsule,
    CapsuleBody,
    Compound,
    Cone,
    ConeBody,
    ConstantVelocity,
    ConvexHull,
    Cylinder,
    CylinderBody,
    DiscBody,
    DrivenBody,
    Dumbbell,
    Egg,
    Ellipsoid,
    EllipsoidBody,
    FunctionLoad,
    FunctionMotion,
    HalfSpace,
    Harmonic,
    HullBody,
    LineBody,
    MeshBody,
    MovedShape,
    OpenBox,
    Part,
    PlanarBody,
    Plane,
    Plate,
    Point,
    Rest,
    RigidBody,
    Rod,
    Sphere,
    Spring,
    SuperellipsoidBody,
    SupportBody,
    Table,
    TorsionSpring,
    TriangleMesh,
    Triangles,
    TurningFrame,
    Wall,
)
from laws import (
    Anisotropic,
    Bristle,
    Cohesive,
    Coulomb,
    CoulombContensou,
    Directional,
    EnergeticImpact,
    Frictionless,
    HertzCompliant,
    HuntCrossley,
    JohnsonImpact,
    LankaraniNikravesh,
    LinearCompliant,
    MonoStiffnessImpact,
    MoreauImpact,
    NewtonImpact,
    PlasticImpact,
    PoissonImpact,
    RateAndState,
    Stribeck,
    StrongeImpact,
    Unilateral,
    ViscoelasticImpact,
    Viscous,
)
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.interfaces import (
    Body,
    ContactKinematics,
    FrictionLaw,
    ImpactLaw,
    Load,
    Motion,
    NormalLaw,
    Shape,
    TractionLaw,
)
from nonsmooth.plugins import registry
from nonsmooth.system.pairing import nearest_pair
from nonsmooth.testing import (
    Property,
    check_body,
    check_contact_kinematics,
    check_friction_law,
    check_impact_law,
    check_joint,
    check_load,
    check_motion,
    check_normal_law,
    check_shape,
    check_traction_law,
)
from nonsmooth.testing.make import make
from nonsmooth.testing.registered import check_class
from scenarios.rolling_disc.air_film import AirFilm
from scenarios.tippe_top.friction import SpinningCoulomb
from tests.bodies.meshes import parts
from tests.bodies.planar_functions import PART, planar
from tests.bodies.test_contact_pairs import AXIS, PAIRS
from tests.bodies.test_joints import JOINTS

WEDGE = ((0.0, 0.0, 0.0), (0.03, 0.0, 0.0), (0.0, 0.04, 0.0), (0.01, 0.0, 0.05), (0.02, 0.03, 0.04))
TENSOR = ((0.03, -0.004, 0.002), (-0.004, 0.025, 0.005), (0.002, 0.005, 0.04))
LAWS: list[tuple[Callable[[Any], list[Property]], Any]] = [
    (check_friction_law, Coulomb(0.2, 0.3)),
    (check_friction_law, Stribeck(0.3, 2.0, 0.1)),
    (check_friction_law, Frictionless()),
    (check_normal_law, Unilateral()),
    (check_impact_law, EnergeticImpact(0.65)),
    (check_impact_law, EnergeticImpact(0.5, exponent=1.0)),
    (check_friction_law, Viscous(0.2, 0.1)),
    (check_friction_law, SpinningCoulomb(0.3, 0.1)),
    (check_friction_law, Anisotropic(0.5, 0.3, (0.0, 1.0, 1.0), "first")),
    (check_friction_law, Directional(0.2, 0.5, 0.3)),
    (check_friction_law, RateAndState(0.3, 0.01, 0.015, 1e-3, 1e-4)),
    (check_normal_law, LinearCompliant(1e4, 3.0)),
    (check_normal_law, HertzCompliant(1e8)),
    (check_normal_law, HuntCrossley(1e8, 0.3)),
    (check_normal_law, LankaraniNikravesh(1e8, 0.7)),
    (check_normal_law, Cohesive(1e4, 1.0, 2.0)),
    (check_traction_law, Bristle(0.3, 0.4, damping=1.0, viscosity=0.5)),
    (check_traction_law, CoulombContensou(0.3, 0.01, 1e-3, relaxation=1e-4)),
    (check_impact_law, MonoStiffnessImpact(0.6)),
    (check_impact_law, JohnsonImpact()),
    (check_impact_law, ViscoelasticImpact()),
    (check_impact_law, NewtonImpact(0.5)),
    (check_impact_law, PlasticImpact()),
    (check_impact_law, MoreauImpact(0.5)),
    (check_impact_law, PoissonImpact(0.5)),
    (check_impact_law, StrongeImpact(0.6)),
]
BODIES: list[Body] = [
    Ball(0.02),
    BoxBody(0.01, 0.02, 0.035),
    BoxBody(0.01, 0.02, 0.035, rounding=0.002),
    CapsuleBody(0.01, 0.03, density=900.0),
    Compound((Part(BoxBody(0.01, 0.02, 0.03), (0.02, 0.0, -0.01)), Part(CylinderBody(0.01, 0.04)))),
    ConeBody(0.02, 0.05, mass=0.2),
    CylinderBody(0.02, 0.03, mass=0.2),
    DiscBody(0.05, mass=0.1),
    DrivenBody(Harmonic(1e-3, 25.0), (Sphere(0.1),)),
    Dumbbell(),
    EllipsoidBody(0.01, 0.02, 0.03),
    HullBody(WEDGE, mass=0.2),
    HullBody(WEDGE, rounding=0.005),
    SuperellipsoidBody(0.02, 0.03, 0.04, 0.5, 0.6),
    SupportBody(Egg()),
    SuperellipsoidBody(0.02, 0.03, 0.04, 1.4, 1.2, 0.01),
    OpenBox(0.1, 0.2, (0.0, 0.1, 0.2), (0.5, 0.5, -0.5, 0.5)),
    planar((TurningFrame(carried=(Sphere(0.1),), **PART),), 2.0, 0.5),
    LineBody(1.0, carried=(Sphere(0.1),)),
    MeshBody(Triangles(*parts.bracket())),
    PlanarBody(2.0, 1.0, (Point(),)),
    Plate(),
    Plate(ConstantVelocity((0.3, 0.1, -0.2), 0.7, centre=(0.2, 0.1, 0.0))),
    RigidBody(2.0, TENSOR, (Sphere(0.05, x=0.1), Sphere(0.04, y=-0.1))),
    Rod(0.2, 0.005),
    Wall((0.6, 0.0, -0.8), (0.1, 0.2, 0.3)),
]
"""One of every kind that is installed, and some more."""
LOADS: list[Load] = [
    AirFilm(2e-5, 0.1),
    Bushing(50.0, 1.0, second=(0.0, 0.08, 0.0)),
    make(FunctionLoad, "function_load", {}),
    Spring(stiffness=50.0, length=0.2, damping=1.0, first=(0.05, 0.0, 0.0)),
    TorsionSpring(2.0, 0.3, 0.5, axis=(0.6, 0.0, 0.8)),
]
MOTIONS: list[Motion] = [
    ConstantVelocity((0.3, 0.1, -0.2)),
    ConstantVelocity((0.3, 0.1, -0.2), 0.7, (0.6, 0.0, 0.8), (0.1, 0.2, 0.3), (0.5, 0.5, 0.5, 0.5), (0.2, 0.1, 0.0)),
    make(FunctionMotion, "function_motion", {}),
    Harmonic(1e-3, 25.0, 0.3, 0.6, 0.0, 0.8),
    Rest(0.3, (1.0, 2.0, 3.0), (0.5, 0.5, 0.5, 0.5)),
    Table((0.0, 0.1, 0.3), ((0.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.0, 0.0, 0.1)), orientation=(0.5, 0.5, 0.5, 0.5)),
    make(Table, "table", {}),
]
CUBOID = TriangleMesh(Triangles(*parts.box(0.6, 0.4, 0.8)), 0.1, -0.05, 0.07, 0.8, 0.36, -0.48)
TETRAHEDRON = TriangleMesh(
    Triangles(0.3 * (np.eye(4, 3) - 0.25), ((0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2))), 0.01, 0.02
)
SHAPES: list[tuple[Shape, Shape]] = [
    *((a, b) for a, b, _ in PAIRS.values()),
    (Plane(0.1), Point(0.1, -0.05, 0.07)),
    (Egg(0.2, 0.2, 0.1), Ellipsoid(0.1, 0.12, 0.15)),
    (Box(0.3, 0.4, 0.5), MovedShape(Egg(0.2, 0.2, 0.1), 0.1, -0.05, 0.07, 0.8, 0.36, -0.48)),
    (HalfSpace(0.1), Point(0.1, -0.05, 0.07)),
    (Box(0.3, 0.4, 0.5, rounding=0.1), Sphere(0.1)),
    # so long that its side crosses each of the edges at some of the places drawn
    (Box(0.3, 0.4, 0.5), Capsule(0.05, 1.0)),
    (Plane(0.1), TriangleMesh(Triangles(*parts.bracket()), 0.1, -0.05, 0.07, 0.8, 0.36, -0.48)),
    (CUBOID, Sphere(0.2, x=-0.05, y=0.1, z=0.02)),
    (CUBOID, Ellipsoid(0.2, 0.35, 0.5)),
    (CUBOID, Capsule(0.15, 0.4, axis_y=-0.6, axis_z=0.8)),
    (CUBOID, Point(0.1, -0.05, 0.07)),
    (Cylinder(0.1, 0.15, **AXIS), CUBOID),
    (TETRAHEDRON, ConvexHull(WEDGE)),
    (TETRAHEDRON, ConvexHull(WEDGE, rounding=0.01)),
    (TETRAHEDRON, TETRAHEDRON),
    (Plane(0.1), ConvexHull(WEDGE)),
    (Box(0.3, 0.4, 0.5), Point(0.1, -0.05, 0.07)),
    (Box(0.3, 0.4, 0.5), Box(0.01, 0.02, 0.03)),
    (Cone(0.3, 0.5, axis_x=0.48, axis_y=-0.6, axis_z=0.64), Box(0.3, 0.4, 0.5)),
    (Cone(0.3, 0.5, axis_x=0.48, axis_y=-0.6, axis_z=0.64), Capsule(0.1, 0.3)),
    (Cone(0.3, 0.5, axis_x=0.48, axis_y=-0.6, axis_z=0.64), Cylinder(0.2, 0.3)),
    # a face that looks down exactly, where round-off must not choose the tangent
    (Box(1.0, 1.0, 1.0), Sphere(1.0)),
]


def _of_pairs() -> Iterator[Property]:
    for first, second in SHAPES:
        owner = _owner(first, second)
        contacts = [contact for contact in owner.between(first, second) if type(contact) is owner]
        # of a class that departs from what depends on the pose, a contact may well have it
        kept = {"gap rate", "second-order terms"} - set(owner.departures)
        for prop in check_contact_kinematics(contacts[-1], first, second):
            if prop.name not in owner.departures:
                yield prop
        for contact in contacts[:-1] if kept else ():
            yield from (p for p in check_contact_kinematics(contact, first, second) if p.name in kept)


def _owner(first: Shape, second: Shape) -> type[ContactKinematics]:
    found = nearest_pair(registry.load_all("kinematics").values(), first, second)
    assert found is not None
    assert found[1]
    return found[0]


def _all() -> Iterator[Property]:
    for check, law in LAWS:
        yield from check(law)
    for body in BODIES:
        yield from check_body(body)
    for joint in JOINTS:
        yield from check_joint(joint)
    for load in LOADS:
        yield from check_load(load)
    for motion in MOTIONS:
        yield from check_motion(motion)
    yield from _of_pairs()
    for group in ("distances", "guards", "scenarios"):
        for name in registry.names(group):
            yield from check_class(registry.load(group, name), name, {})
    for shape in {type(one): one for pair in SHAPES for one in pair}.values():
        yield from check_shape(shape)


@pytest.mark.skipif(PLAIN, reason="some minutes in plain mode")
@pytest.mark.parametrize("prop", list(_all()), ids=str)
def test_built_in(prop: Property) -> None:
    """What the kit asks of a plug-in holds of ours."""
    prop()


@pytest.mark.parametrize(("group", "name"), [(g, n) for g in registry.GROUPS for n in registry.names(g)])
def test_every_built_in_can_be_checked(group: str, name: str) -> None:
    """There are properties of it by its name alone: what numbers cannot give is in the example of its class."""
    assert len(check_class(registry.load(group, name), name, {})) > 3


def test_all_are_there() -> None:
    """One of every class that is installed."""
    given = {type(law) for _, law in LAWS} | {type(body) for body in BODIES}
    for group, base in (("laws", (FrictionLaw, ImpactLaw, NormalLaw, TractionLaw)), ("bodies", (Body,))):
        installed = set(registry.load_all(group).values())
        assert all(issubclass(owner, base) for owner in installed)
        assert installed <= given
    others: list[tuple[str, list[Any]]] = [("joints", JOINTS), ("loads", LOADS), ("motions", MOTIONS)]
    for group, objects in others:
        assert {type(one) for one in objects} == set(registry.load_all(group).values())
    assert {type(one) for pair in SHAPES for one in pair} == set(registry.load_all("shapes").values())
    assert {_owner(first, second) for first, second in SHAPES} == set(registry.load_all("kinematics").values())
