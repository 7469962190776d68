"""All built-ins have the properties that plug-ins must have.

That ``nonsmooth check`` finds and runs them by their names is looked at in tests/cli, of one name for each group.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
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
    Solid,
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
from nonsmooth.testing.component import make
from nonsmooth.testing.features import every_pair
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
COSTLY = (
    "Bristle",
    "CoulombContensou",
    "JohnsonImpact",
    "LankaraniNikravesh",
    "MonoStiffnessImpact",
    "RateAndState",
    "StrongeImpact",
    "ViscoelasticImpact",
    "generalised body",
)
"""Components whose properties take seconds, because their forces or impacts are integrated."""
BODIES: dict[str, Callable[[], Body]] = {
    "ball": lambda: Ball(0.02),
    "box": lambda: BoxBody(0.01, 0.02, 0.035),
    "rounded box": lambda: BoxBody(0.01, 0.02, 0.035, rounding=0.002),
    "capsule": lambda: CapsuleBody(0.01, 0.03, density=900.0),
    "compound": lambda: Compound((Part(BoxBody(0.01, 0.02, 0.03), (0.02, 0.0, -0.01)), Part(CylinderBody(0.01, 0.04)))),
    "cone": lambda: ConeBody(0.02, 0.05, mass=0.2),
    "cylinder": lambda: CylinderBody(0.02, 0.03, mass=0.2),
    "disc": lambda: DiscBody(0.05, mass=0.1),
    "driven body": lambda: DrivenBody(Harmonic(1e-3, 25.0), (Sphere(0.1),)),
    "dumbbell": Dumbbell,
    "ellipsoid": lambda: EllipsoidBody(0.01, 0.02, 0.03),
    "hull": lambda: HullBody(WEDGE, mass=0.2),
    "rounded hull": lambda: HullBody(WEDGE, rounding=0.005),
    "superellipsoid": lambda: SuperellipsoidBody(0.02, 0.03, 0.04, 0.5, 0.6),
    "rounded superellipsoid": lambda: SuperellipsoidBody(0.02, 0.03, 0.04, 1.4, 1.2, 0.01),
    "solid": lambda: Solid(Cylinder(0.02, 0.03, x=0.1), density=2700.0, orientation=(0.5, 0.5, 0.5, 0.5)),
    "solid of a mesh": lambda: Solid(TriangleMesh(Triangles(*parts.bracket())), mass=0.2),
    "support body": lambda: SupportBody(Egg()),
    "open box": lambda: OpenBox(0.1, 0.2, (0.0, 0.1, 0.2), (0.5, 0.5, -0.5, 0.5)),
    "generalised body": lambda: planar((TurningFrame(carried=(Sphere(0.1),), **PART),), 2.0, 0.5),
    "line body": lambda: LineBody(1.0, carried=(Sphere(0.1),)),
    "mesh body": lambda: MeshBody(Triangles(*parts.bracket())),
    "planar body": lambda: PlanarBody(2.0, 1.0, (Point(),)),
    "plate": Plate,
    "moving plate": lambda: Plate(ConstantVelocity((0.3, 0.1, -0.2), 0.7, centre=(0.2, 0.1, 0.0))),
    "rigid body": lambda: RigidBody(2.0, TENSOR, (Sphere(0.05, x=0.1), Sphere(0.04, y=-0.1))),
    "rod": lambda: Rod(0.2, 0.005),
    "wall": lambda: Wall((0.6, 0.0, -0.8), (0.1, 0.2, 0.3)),
}
"""One body of every installed kind, and some more."""
LOADS: dict[str, Callable[[], Load]] = {
    "air film": lambda: AirFilm(2e-5, 0.1),
    "bushing": lambda: Bushing(50.0, 1.0, second=(0.0, 0.08, 0.0)),
    "function load": lambda: make(FunctionLoad, "function_load", {}),
    "spring": lambda: Spring(stiffness=50.0, length=0.2, damping=1.0, first=(0.05, 0.0, 0.0)),
    "torsion spring": lambda: TorsionSpring(2.0, 0.3, 0.5, axis=(0.6, 0.0, 0.8)),
}
QUARTER_TURN = (0.5, 0.5, 0.5, 0.5)
MOTIONS: dict[str, Callable[[], Motion]] = {
    "constant velocity": lambda: ConstantVelocity((0.3, 0.1, -0.2)),
    "constant turning": lambda: ConstantVelocity(
        (0.3, 0.1, -0.2), 0.7, (0.6, 0.0, 0.8), (0.1, 0.2, 0.3), QUARTER_TURN, (0.2, 0.1, 0.0)
    ),
    "function motion": lambda: make(FunctionMotion, "function_motion", {}),
    "harmonic": lambda: Harmonic(1e-3, 25.0, 0.3, 0.6, 0.0, 0.8),
    "rest": lambda: Rest(0.3, (1.0, 2.0, 3.0), QUARTER_TURN),
    "table": lambda: Table(
        (0.0, 0.1, 0.3), ((0.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.0, 0.0, 0.1)), orientation=QUARTER_TURN
    ),
    "table of the example": lambda: make(Table, "table", {}),
}
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


def _of_pair(first: Shape, second: Shape) -> list[Property]:
    """Return the properties of the contacts of a pair of shapes."""
    owner = _owner(first, second)
    # of each evaluator, and of each kind of pair that it has, the first contact, one in the middle and the last
    by_evaluator: dict[Any, list[int]] = {}
    for number, contact in enumerate(every_pair(owner.between(first, second))):
        kind = contact.values.get("candidate", (0.0,))
        by_evaluator.setdefault((contact.evaluator, kind[0] if isinstance(kind, tuple) else 0.0), []).append(number)
    chosen = {numbers[place] for numbers in by_evaluator.values() for place in (0, len(numbers) // 2, -1)}
    return check_contact_kinematics(owner, first, second, contacts=sorted(chosen))


def _owner(first: Shape, second: Shape) -> type[ContactKinematics]:
    found = nearest_pair(registry.load_all("kinematics").values(), first, second)
    assert found is not None
    assert found[1]
    return found[0]


def _components() -> Iterator[tuple[str, Callable[[], list[Property]]]]:
    """Yield the name of each component, and a function that makes it and returns its properties."""
    for check, law in LAWS:
        yield type(law).__name__, partial(check, law)
    makers: tuple[tuple[Callable[[Any], list[Property]], dict[str, Callable[[], Any]]], ...] = (
        (check_body, BODIES),
        (check_load, LOADS),
        (check_motion, MOTIONS),
    )
    for check, named in makers:
        for name, made in named.items():
            yield name, partial(_of_made, check, made)
    for joint in JOINTS:
        yield type(joint).__name__, partial(check_joint, joint)
    for shape in {type(one): one for pair in SHAPES for one in pair}.values():
        yield type(shape).__name__, partial(check_shape, shape)
    for group in ("distances", "guards", "scenarios"):
        for name in registry.names(group):
            yield name, partial(_of_name, group, name)


def _cases() -> Iterator[Any]:
    """Yield the components as cases of a test: slow are the costly ones, and all pairs of a kind but the first."""
    costly = {*registry.names("scenarios"), *COSTLY} - {"dumbbell"}
    for name, find in _components():
        yield pytest.param(find, id=name, marks=[pytest.mark.slow] if name in costly else [])
    kinds: set[type[ContactKinematics]] = set()
    for first, second in SHAPES:
        kind, name = _owner(first, second), f"{type(first).__name__} and {type(second).__name__}"
        marks = [pytest.mark.slow] if kind in kinds else []
        yield pytest.param(partial(_of_pair, first, second), id=name, marks=marks)
        kinds.add(kind)


def _of_made(check: Callable[[Any], list[Property]], make_one: Callable[[], Any]) -> list[Property]:
    return check(make_one())


def _of_name(group: str, name: str) -> list[Property]:
    return check_class(registry.load(group, name), name, {})


@pytest.mark.skipif(PLAIN, reason="some minutes in plain mode")
@pytest.mark.parametrize("find", list(_cases()))
def test_built_in(find: Callable[[], list[Property]], subtests: pytest.Subtests) -> None:
    """The kit's properties hold of a component, each a subtest."""
    found = find()
    assert found
    for prop in found:
        with subtests.test(str(prop)):
            prop()


@pytest.mark.parametrize("group", registry.GROUPS)
def test_every_built_in_can_be_checked(group: str, subtests: pytest.Subtests) -> None:
    """There are properties of it by its name alone: what numbers cannot give is in the example of its class."""
    for name in registry.names(group):
        with subtests.test(name):
            assert len(_of_name(group, name)) > 3


def test_all_are_there() -> None:
    """One of every class that is installed."""
    given = {type(law) for _, law in LAWS} | {type(make_body()) for make_body in BODIES.values()}
    for group, base in (("laws", (FrictionLaw, ImpactLaw, NormalLaw, TractionLaw)), ("bodies", (Body,))):
        installed = set(registry.load_all(group).values())
        assert all(issubclass(owner, base) for owner in installed)
        assert installed <= given
    others: dict[str, list[Any]] = {
        "joints": JOINTS,
        "loads": [made() for made in LOADS.values()],
        "motions": [made() for made in MOTIONS.values()],
    }
    for group, objects in others.items():
        assert {type(one) for one in objects} == set(registry.load_all(group).values())
    assert {type(one) for pair in SHAPES for one in pair} == set(registry.load_all("shapes").values())
    assert {_owner(first, second) for first, second in SHAPES} == set(registry.load_all("kinematics").values())
