"""The look at pairs of bodies: a run in which they pass into each other ends by name, whatever their contacts say."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest
import trimesh

import nonsmooth as ns
from bodies import (
    Ball,
    BoxBody,
    CapsuleBody,
    ConeBody,
    CylinderBody,
    DiscBody,
    EllipsoidBody,
    HullBody,
    MeshBody,
    Plate,
    SuperellipsoidBody,
    Triangles,
)
from laws import Coulomb, EnergeticImpact, LinearCompliant, Unilateral
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import (
    GAP,
    NORMAL,
    PAST_END,
    POINT_A,
    POINT_B,
    SIDE_A,
    SIDE_B,
    SLIDE_MATRIX,
    TANGENT,
    TURN_MATRIX,
)
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.interfaces import Body, ContactKinematics, FeaturePair, Shape
from nonsmooth.model.assembly import lay
from nonsmooth.plugins import registry
from nonsmooth.queries.undeclared import UndeclaredContact
from nonsmooth.solution.checks import contacts_without_body_check
from nonsmooth.solution.solution import Solution
from tests.solids.depth import penetration
from tests.solids.separation import Piece, nearest, piece_of


def _mesh(mesh: Any) -> Body:
    return MeshBody(Triangles(mesh.vertices.tolist(), mesh.faces.tolist(), "of the test"))


CONVEX: dict[str, Callable[[], Body]] = {
    "box": lambda: BoxBody(0.05, 0.03, 0.02),
    "rounded box": lambda: BoxBody(0.05, 0.03, 0.02, rounding=0.004),
    "hull": lambda: HullBody(((0.05, 0.05, 0.05), (-0.05, -0.05, 0.05), (-0.05, 0.05, -0.05), (0.05, -0.05, -0.05))),
    "mesh": lambda: _mesh(trimesh.creation.cylinder(0.05, 0.1, sections=6)),
    "cylinder": lambda: CylinderBody(0.05, 0.07, foot_height=0.0),
    "rounded cylinder": lambda: CylinderBody(0.05, 0.07, rounding=0.005, foot_height=0.0),
    "cone": lambda: ConeBody(0.05, 0.1, foot_height=0.0),
    "capsule": lambda: CapsuleBody(0.03, 0.05),
    "ellipsoid": lambda: EllipsoidBody(0.05, 0.03, 0.02),
    "superellipsoid": lambda: SuperellipsoidBody(0.05, 0.04, 0.03, 0.5, 0.5),
    "ball": lambda: Ball(0.04),
}
"""Without feet, which the solids leave out."""
HOLLOW = {"hollow box": lambda: _mesh(trimesh.creation.annulus(0.03, 0.05, 0.1, sections=4))}


def _blind(a: Sequence[float], b: Sequence[float], out: Any) -> None:
    for i in range(PAST_END + 1):
        out[i] = 0.0
    out[GAP] = 1.0
    out[NORMAL + 2] = out[TANGENT] = 1.0
    for side in (SIDE_A, SIDE_B):
        out[side + SLIDE_MATRIX] = out[side + SLIDE_MATRIX + 3] = 1.0
        out[side + TURN_MATRIX] = 0.0
    for i in range(3):
        out[POINT_A + i], out[POINT_B + i] = a[i], b[i]


class Blind(ContactKinematics):
    """Contacts of any two shapes that never see them near."""

    pair = (Shape, Shape)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        return 2 * (FeaturePair(_blind, {}, ("none",)),)


@pytest.fixture
def blind(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let no contact be seen."""
    known = registry.load_all

    def load_all(group: str, some: object = None) -> dict[str, Any]:
        return {"blind": Blind} if group == "kinematics" else known(group)

    monkeypatch.setattr(registry, "load_all", load_all)


def _system(one: Body, two: Body, **laws: Any) -> ns.System:
    system = ns.System([one, two], gravity=0.0)
    rigid = {"normal": Unilateral(), "friction": Coulomb(0.0), "impact": EnergeticImpact(0.5)}
    system.contact(one, two, **(laws or rigid))
    return system


@pytest.mark.usefixtures("blind")
@pytest.mark.fast_cases(12)
@pytest.mark.parametrize("shift", [(0.0, 0.0), (1e-9, 0.0), (1e-3, 2e-3)], ids=str)
@pytest.mark.parametrize("turn", [0.0, 1e-6, 0.3])
@pytest.mark.parametrize("make", [*CONVEX.values(), *HOLLOW.values()], ids=[*CONVEX, *HOLLOW])
def test_bodies_whose_contacts_see_nothing_do_not_pass_in_silence(
    make: Callable[[], Body], turn: float, shift: tuple[float, float]
) -> None:
    """Flush, shifted and turned: the run ends by name and keeps what it computed."""
    system = _system(make(), make())
    one, two = system.bodies
    system.place(one, velocity=(1.0, 0.0, 0.0))
    system.place(two, position=(0.3, *shift), orientation=ns.turned_about((1.0, 0.0, 0.0), turn))
    with pytest.raises(ns.RunFailed, match="bodies passed into each other") as failed:
        ns.simulate(system, 0.25, engine=ns.EventDriven(largest_step=0.01))
    assert all(name in str(failed.value) for name in system.names.bodies)
    solution = failed.value.solution
    assert isinstance(solution, Solution)
    assert len(solution.t) > 1


@pytest.mark.usefixtures("blind")
def test_a_floor_that_is_not_seen() -> None:
    """A half-space is a side of a pair like any other."""
    plate, box = Plate(), BoxBody(0.05, 0.03, 0.02)
    system = ns.System([plate, box])
    system.contact(plate, box, normal=Unilateral(), friction=Coulomb(0.0), impact=EnergeticImpact(0.5))
    system.place(box, position=(0.0, 0.0, 0.03))
    with pytest.raises(ns.RunFailed, match="bodies passed into each other"):
        ns.simulate(system, 0.5, engine=ns.EventDriven(largest_step=0.01))


@pytest.mark.parametrize("kind", ["box", "ellipsoid", "capsule"])
def test_springs_let_bodies_overlap_as_deep_as_their_contacts_say(kind: str) -> None:
    """Soft bodies that meet head on go into each other and come back."""
    system = _system(CONVEX[kind](), CONVEX[kind](), normal=LinearCompliant(2e4, 0.0), friction=Coulomb(0.0))
    one, two = system.bodies
    system.place(one, velocity=(1.0, 0.0, 0.0))
    system.place(two, position=(0.07 if kind == "capsule" else 0.11, 0.0, 0.0))
    solution = ns.simulate(system, 0.2)
    assert solution.status == "done"
    assert solution.of(two)[1][-1, 0] == pytest.approx(1.0, abs=1e-3)


@pytest.mark.usefixtures("blind")
@pytest.mark.parametrize("way", [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.6, 0.0, 0.8)], ids=str)
@pytest.mark.parametrize(("turn", "shift"), [(0.0, 0.0), (0.0, 0.06), (1e-6, 0.0), (0.3, 0.01)])
def test_discs_without_thickness_do_not_pass_through_each_other_in_silence(
    way: tuple[float, float, float], turn: float, shift: float
) -> None:
    """They never overlap by a depth; one crosses the plane of the other within the disc."""
    disc, other = DiscBody(0.05, foot_height=0.0), DiscBody(0.05, foot_height=0.0)
    system = _system(disc, other)
    system.place(disc, velocity=way)
    start = 0.2 * np.array(way) + (0.0, shift, 0.0)
    system.place(other, position=tuple(start), orientation=ns.turned_about((1.0, 0.0, 0.0), turn))
    with pytest.raises(ns.RunFailed, match="bodies passed into each other"):
        ns.simulate(system, 0.4)


@pytest.mark.usefixtures("blind")
@pytest.mark.parametrize("radii", [(0.05, 0.01), (0.01, 0.05)])
def test_a_small_disc_does_not_pass_through_a_large_one_in_silence(radii: tuple[float, float]) -> None:
    """Far from the centre and tilted, whichever is declared first."""
    disc, other = (DiscBody(radius, foot_height=0.0) for radius in radii)
    system = _system(disc, other)
    small = other if radii[1] < radii[0] else disc
    large = disc if small is other else other
    system.place(large)
    tilted = ns.turned_about((1.0, 0.0, 0.0), 0.2)
    system.place(small, position=(0.03, 0.0, 0.1), velocity=(0.0, 0.0, -1.0), orientation=tilted)
    with pytest.raises(ns.RunFailed, match="bodies passed into each other"):
        ns.simulate(system, 0.4)


@pytest.mark.usefixtures("blind")
def test_discs_that_pass_beside_each_other_end_no_run() -> None:
    """Past the rim, at a distance, and in one plane side by side."""
    for start, velocity in (
        ((0.11, 0.0, 0.2), (0.0, 0.0, 1.0)),
        ((0.2, 0.0, 0.01), (1.0, 0.0, 0.0)),
        ((0.2, 0.101, 0.0), (1.0, 0.0, 0.0)),
    ):
        disc, other = DiscBody(0.05, foot_height=0.0), DiscBody(0.05, foot_height=0.0)
        system = _system(disc, other)
        system.place(disc, velocity=velocity)
        system.place(other, position=start)
        assert ns.simulate(system, 0.4).status == "done"


def test_contacts_of_shapes_that_have_no_parts_are_listed_as_unchecked(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of a shape with neither convex parts nor a solid nothing but gaps tells; a ball next to it is looked at."""
    ball, bean, plate = Ball(0.05), EllipsoidBody(0.03, 0.02, 0.01), Plate()
    monkeypatch.setattr(type(bean.shapes[0]), "parts", ())
    monkeypatch.setattr(type(bean.shapes[0]), "solid", None)
    system = ns.System([ball, bean, plate])
    laws: dict[str, Any] = {"normal": Unilateral(), "friction": Coulomb(0.0), "impact": EnergeticImpact(0.5)}
    system.contact(plate, bean, name="bean", **laws)
    system.contact(plate, ball, name="ball", **laws)
    system.exclude(ball, bean)
    system.place(ball, position=(0.0, 0.0, 0.2))
    system.place(bean, position=(0.2, 0.0, 0.2))
    solution = ns.simulate(system, 0.01)
    assert contacts_without_body_check(solution) == ("bean",)
    assert "1 contacts whose bodies are not checked for overlap" in repr(solution)


def _poses(rng: np.random.Generator, n: int) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Return orientations of both, and a direction from the first to the second: random ones, and aligned."""
    found = []
    for i in range(n):
        one, two = rng.normal(size=(2, 4))
        way = rng.normal(size=3)
        if i % 2 == 0:
            one, way = np.array([1.0, 0.0, 0.0, 0.0]), np.eye(3)[i % 6 // 2]
            two = one if i % 4 == 0 else np.array([1.0, 1.0, 0.0, 0.0])
        found.append((one / np.linalg.norm(one), two / np.linalg.norm(two), way / np.linalg.norm(way)))
    return found


@pytest.mark.fast_cases(10)
@pytest.mark.parametrize("kinds", [*itertools.combinations_with_replacement(CONVEX, 2)], ids=" ".join)
def test_an_overlap_is_told_where_there_is_one_and_nowhere_else(kinds: tuple[str, str]) -> None:
    """Against the expanding polytopes of the solids, apart and overlapping by 1e-9 to 0.2 of the size."""
    system = _system(*(CONVEX[kind]() for kind in kinds))
    model, rng = lay(system, ns.EventDriven()), np.random.default_rng(7)
    memory = model.memory
    n = int(memory[owners.ModelNumbers.n_pairs])
    if kinds == ("ball", "ball"):
        assert n == 0
        return
    shapes = [body.frames[0][0] for body in system.bodies]
    y = memory[owners.Island.y][:14]

    def at(distance: float, pose: tuple[np.ndarray, np.ndarray, np.ndarray]) -> tuple[Piece, Piece]:
        y[:3], y[3:7], y[7:10], y[10:14] = 0.0, pose[0], distance * pose[2], pose[1]
        memory[owners.Island.time] = rng.uniform()
        model.list_contacts()
        model.evaluate()
        one, two = (piece_of(shape, *place[0]) for shape, place in zip(shapes, model.places(), strict=True))
        return one, two

    for pose in _poses(rng, 4):
        low, high = 0.0, 0.3
        while high - low > 1e-13:
            middle = 0.5 * (low + high)
            apart = nearest(*at(middle, pose), 1e-13).lower > 0.0
            low, high = (low, middle) if apart else (middle, high)
        for depth in (-1e-3, -1e-9, 1e-9, 1e-6, 1e-4, 3e-3, 1e-2):
            found = penetration(*at(high - depth, pose), 1e-12)
            lower, upper = (0.0, 0.0) if found is None else (found.lower, found.upper)
            memory[owners.Pair.direction][:n] = 0.0
            memory[owners.Run.passed_depth] = 0.0
            call_entry("check_pairs", memory)
            allowed = memory[owners.Pair.allowed][:n][0]
            told = memory[owners.Run.passed_depth] if memory[owners.Run.passed_pair] >= 0 else 0.0
            assert told <= 1.002 * upper + 1e-12
            assert told > 0.0 or lower <= 1.01 * allowed


@pytest.mark.parametrize("far", [0.5, 3.0])
def test_a_forgotten_contact_is_warned_of(far: float) -> None:
    """A body that moves by itself and has no contact, however far it is; excluded or tied, it is meant so."""
    plate, ball, other = Plate(), Ball(0.02), Ball(0.02)
    system = ns.System([plate, ball, other])
    system.place(ball, position=(0.0, 0.0, far))
    system.place(other, position=(0.2, 0.0, far))
    system.contact(plate, other, normal=Unilateral(), friction=Coulomb(0.0), impact=EnergeticImpact(0.5))
    with pytest.warns(UndeclaredContact, match=r"Bodies without any contact .*'ball.*system\.exclude"):
        ns.simulate(system, 0.01)
    for body in (plate, other):
        system.exclude(ball, body)
    assert ns.simulate(system, 0.01).status == "done"
