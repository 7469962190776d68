"""Pairs of bodies near each other at the start, what is said of them, and the warning before a run."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, BallJoint, BoxBody, DrivenBody, HalfSpace, MeshBody, Plate, Rest, Sphere, Triangles
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.histories.distances import distances
from nonsmooth.queries.near import places_at_start
from nonsmooth.queries.undeclared import Undeclared, UndeclaredOverlap
from tests.bodies.meshes.parts import bracket

LAWS: dict[str, Any] = {"normal": Unilateral(), "friction": Coulomb(0.3), "impact": EnergeticImpact(0.5)}


def _row(*gaps: float) -> ns.System:
    """Return balls of 1 cm in a row, with these gaps, over a plate."""
    balls, plate = [Ball(0.01) for _ in range(len(gaps) + 1)], Plate()
    system, x = ns.System([plate, *balls]), 0.0
    for ball, gap in zip(balls, (0.0, *gaps), strict=True):
        x += gap + 0.02
        system.place(ball, position=(x, 0.0, 0.1))
    return system


def test_near_touching_and_overlapping() -> None:
    """The least gap first; what is farther than a tenth of the smaller body is not told."""
    system = _row(5e-4, 0.0, -1e-3, 2e-3)
    found = ns.proximity(system)
    assert [(pair.numbers, pair.state) for pair in found] == [
        ((3, 4), "overlapping"),
        ((2, 3), "touching"),
        ((1, 2), "near"),
    ]
    np.testing.assert_allclose([pair.distance.gap for pair in found], [-1e-3, 0.0, 5e-4], atol=2e-6)
    assert not any(pair.declared or pair.joined or pair.excluded for pair in found)
    assert [pair.numbers for pair in ns.proximity(system, within=3e-3)][-1] == (4, 5)
    assert len(ns.proximity(system, within=0.0)) == 2
    with pytest.raises(ns.InvalidInput, match="within must be finite and not negative"):
        ns.proximity(system, within=-1.0)


def test_planes_meshes_and_bodies_of_several_frames() -> None:
    """A ball in the ground, a mesh in the notch of another, a driven body; pairs of driven ones are left out."""
    ground, wall = Plate(), DrivenBody(Rest(), (HalfSpace(0.5), Sphere(0.01)))
    one, two = (MeshBody(Triangles(*bracket(), "bracket"), density=1e3) for _ in range(2))
    ball = Ball(0.01)
    system = ns.System([ground, wall, one, two, ball])
    system.place(ball, position=(0.0, 0.0, 0.005))
    system.place(one, position=(0.0, 0.0, 1.0))
    system.place(two, position=(0.002, 0.003, 1.001))
    found = {pair.numbers: pair for pair in ns.proximity(system)}
    assert (0, 1) not in found
    assert found[0, 4].distance.gap == pytest.approx(-0.005, abs=1e-15)
    assert found[2, 3].state == "overlapping"
    assert found[1, 4].state == "overlapping"


@pytest.mark.slow
def test_it_is_the_same_in_any_order_and_as_pairs_say() -> None:
    """Against all pairs, asked one by one, with fifteen boxes in a heap."""
    rng = np.random.default_rng(3)
    boxes = [BoxBody(*rng.uniform(0.01, 0.03, 3).tolist()) for _ in range(15)]
    places = rng.uniform(-0.06, 0.06, (15, 3))
    system, back = ns.System(boxes), ns.System(boxes[::-1])
    for box, place in zip(boxes, places, strict=True):
        system.place(box, position=place)
        back.place(box, position=place)
    found = {frozenset(map(id, pair.bodies)): pair.distance.gap for pair in ns.proximity(system, within=5e-3)}
    again = {frozenset(map(id, pair.bodies)): pair.distance.gap for pair in ns.proximity(back, within=5e-3)}
    assert found.keys() == again.keys()
    expected = set()
    for i, one in enumerate(boxes):
        for j in range(i):
            if ns.distance(one, boxes[j], at=(places[i], places[j])).gap <= 5e-3:
                expected.add(frozenset((id(one), id(boxes[j]))))
    assert found.keys() == expected
    assert len(expected) > 5


def test_what_is_said_of_a_pair() -> None:
    system = _row(-1e-3, -1e-3, -1e-3)
    _, one, two, three, _ = system.bodies
    system.contact(one, two, **LAWS)
    system.exclude(two, three)
    said = {pair.numbers: (pair.declared, pair.joined, pair.excluded) for pair in ns.proximity(system)}
    assert said == {(1, 2): (True, False, False), (2, 3): (False, False, True), (3, 4): (False, False, False)}
    assert system.excluded == ((two, three),)


def test_joined_bodies_are_marked() -> None:
    """Over a joint, and over two; what hangs on one ground by different joints is not one mechanism."""
    anchor = DrivenBody(Rest(), (Sphere(0.012, z=0.011),))
    balls = [Ball(0.01) for _ in range(4)]
    system = ns.System([anchor, *balls])
    for i, ball in enumerate(balls):
        system.place(ball, position=(0.004 * i, 0.0, 0.0))
    joint = BallJoint()
    for one, two in ((anchor, balls[0]), (balls[0], balls[1]), (anchor, balls[2])):
        system.joint(joint, one, two)
    joined = {pair.numbers for pair in ns.proximity(system) if pair.joined}
    assert joined == {(0, 1), (0, 2), (0, 3), (1, 2)}


def _warned(system: ns.System) -> list[str]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        Undeclared.of(system).warn_of_start(places_at_start(system))
    return [str(one.message) for one in caught]


def test_an_overlap_that_nobody_declared_is_told_before_a_run() -> None:
    """Once for all pairs, with depth and remedy; and the run goes on."""
    system = _row(-1e-3, 5e-3)
    for ball in system.bodies[1:]:
        system.contact(system.bodies[0], ball, **LAWS)
    with pytest.warns(UndeclaredOverlap, match=r"'ball 1' and 'ball 2' by at least .*system\.exclude"):
        solution = ns.simulate(system, 1e-3)
    assert solution.status == "done"
    (message,) = _warned(_heap(6))
    assert "and 12 more pairs" in message


def test_bodies_that_passed_into_each_other_are_told_after_a_run() -> None:
    """Balls that were given no contact, a ball that fell through a plate; not one that started below it."""
    for forgotten in ((1, 2), (0, 2)):
        system = _row(5e-3)
        two = system.bodies[2]
        system.place(two, position=(0.015, 0.0, 0.045))
        for i, j in {(0, 1), (0, 2), (1, 2)} - {forgotten}:
            system.contact(system.bodies[i], system.bodies[j], **LAWS)
        names = " and ".join(repr(system.names.bodies[i]) for i in forgotten)
        with pytest.warns(UndeclaredOverlap, match=f"pass into each other, the first at t = .*{names} by at least"):
            solution = ns.simulate(system, 0.3)
        assert solution.status == "done"
    system.place(two, position=(0.1, 0.0, -1.0))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ns.simulate(system, 0.01)


def test_bodies_that_passed_through_each_other_are_told_after_a_run() -> None:
    """They are apart at the start and at the end of the run; a pair that was excluded passes without a warning."""
    one, two = Ball(0.01), Ball(0.01)
    system = ns.System([Plate(), one, two], gravity=0.0)
    for ball, side in ((one, -1.0), (two, 1.0)):
        system.contact(system.bodies[0], ball, **LAWS)
        system.place(ball, position=(side * 0.05, 0.0, 0.02), velocity=(-side * 1.0, 0.0, 0.0))
    with pytest.warns(UndeclaredOverlap, match=r"first at t = 0\.04.* s: 'ball 1' and 'ball 2' by at least"):
        ns.simulate(system, 0.1)
    system.exclude(one, two)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ns.simulate(system, 0.1)


def _heap(n: int) -> ns.System:
    """Return balls in one place, with a contact of two others."""
    balls = [Ball(0.01) for _ in range(n + 2)]
    system = ns.System(balls)
    system.contact(balls[-1], balls[-2], **LAWS)
    for i in (1, 2):
        system.place(balls[-i], position=(i * 1.0, 0.0, 0.0))
    return system


def test_nobody_is_warned_of_what_was_meant() -> None:
    """Contacts, of some shapes too, exclusions, joints, driven bodies, planes, touching bodies, no contacts at all."""
    assert not _warned(_row(-1e-3))
    for said in ("contact", "exclude", "contact_all", "joint"):
        system = _row(-1e-3)
        plate, one, two = system.bodies
        system.contact(plate, one, **LAWS)
        assert len(_warned(system)) == 1
        if said == "contact":
            system.contact(one, two, shapes=((0,), (0,)), **LAWS)
        elif said == "exclude":
            system.exclude(two, one)
        elif said == "contact_all":
            laws = ns.ContactLaws(**LAWS)
            system.contact_all(ns.Materials(default=laws), exclude=[(one, two)])
        else:
            system.joint(BallJoint(first=(0.0095, 0.0, 0.0), second=(-0.0095, 0.0, 0.0)), one, two)
        assert not _warned(system), said
    under = _row(1e-3)
    under.contact(under.bodies[1], under.bodies[2], **LAWS)
    under.place(under.bodies[1], position=(0.0, 0.0, -1.0))
    assert not _warned(under)
    touching = _row(0.0, -1e-10)
    touching.contact(*touching.bodies[:2], **LAWS)
    assert not _warned(touching)


def test_what_one_call_leaves_out_another_may_declare() -> None:
    """Exclusions of `contact_all` are its own, those of `exclude` hold for all that follow."""
    system = _row(1e-3, 1e-3)
    _, one, two, three = system.bodies
    laws = ns.Materials(default=ns.ContactLaws(**LAWS))
    system.exclude(two, three)
    system.contact_all(laws, bodies=[one, two, three], exclude=[(one, two)])
    assert len(system.contacts) == 1
    system.contact_all(laws, bodies=[one, two, three])
    assert {frozenset(map(id, (c.first, c.second))) for c in system.contacts} == {
        frozenset(map(id, pair)) for pair in ((one, two), (one, three))
    }
    assert set(system.excluded) == {(two, three), (one, two)}


def test_bodies_through_one_another_are_found_without_a_corner_inside() -> None:
    """Crossed bars, and a ball inside of a mesh."""
    bars = [BoxBody(0.1, 0.01, 0.01), BoxBody(0.01, 0.1, 0.01)]
    mesh, ball, floor = MeshBody(Triangles(*bracket(0.1), "bracket"), density=1e3), Ball(0.002), Plate()
    system = ns.System([floor, *bars, mesh, ball])
    system.contact(floor, ball, **LAWS)
    inside = mesh.frames[0][0].solid.surface.inner[0]  # type: ignore[union-attr]
    system.place(mesh, position=(0.0, 0.0, 1.0))
    system.place(ball, position=np.add(inside, (0.0, 0.0, 1.0)))
    (message,) = _warned(system)
    assert "'box 1' and 'box 2'" in message
    assert "'mesh' and 'ball'" in message


def test_an_exclusion_is_copied_saved_and_loaded(tmp_path: Path) -> None:
    system = _row(-1e-3)
    plate, one, two = system.bodies
    system.contact(plate, one, **LAWS)
    system.exclude(one, two)
    again = ns.with_laws(system, friction=Coulomb(0.1))
    assert again.excluded == ((one, two),)
    ns.save_system(system, tmp_path / "row.toml")
    loaded = ns.load_system(tmp_path / "row.toml").system
    assert loaded.excluded == ((loaded.bodies[1], loaded.bodies[2]),)
    assert not _warned(loaded)
    for first, second, says in ((one, one, "two different bodies"), (one, Ball(0.1), "a body of this system")):
        with pytest.raises(ns.InvalidInput, match=says):
            system.exclude(first, second)


def test_a_history_is_what_single_questions_say() -> None:
    """A ball that falls beside another: gap by the free fall, exact at every sample."""
    system = _row(5e-3)
    plate, one, two = system.bodies
    system.contact(plate, one, **LAWS)
    system.exclude(plate, two)
    system.exclude(one, two)
    solution = ns.simulate(system, 0.1, sample_interval=0.01)
    found = distances(solution, plate, one)
    assert set(found["how"].tolist()) == {"pair"}
    z = solution.of(one)[0][:, 2]
    np.testing.assert_allclose(found["gap"], z - 0.01, atol=1e-15)
    np.testing.assert_allclose(found["second"] - found["first"], found["gap"][:, None] * found["normal"], atol=1e-15)
    between = distances(solution, one, two)
    for i, gap in enumerate(between["gap"]):
        places = [solution.of(body)[0][i] for body in (one, two)]
        assert gap == ns.distance(one, two, at=[(q[:3], q[3:]) for q in places]).gap
    assert found.time.shape == found["gap"].shape == found["lower"].shape
    for bodies, says in (((one, one), "two different"), ((one, Ball(0.01)), "a body of this system")):
        with pytest.raises(ns.InvalidInput, match=says):
            distances(solution, *bodies)
