"""Names: once each in a system, chosen or made, the same in copies, files and messages."""

from __future__ import annotations

import copy
import itertools
from typing import Any

import pytest

import nonsmooth as ns
from bodies import Ball, BoxBody, Dumbbell, Fixed, Plate, Spring
from laws import Coulomb, EnergeticImpact, Unilateral

LAWS: Any = {"normal": Unilateral(), "friction": Coulomb(0.1), "impact": EnergeticImpact(0.7)}


def _system() -> ns.System:
    bodies = [Plate(), *(Ball(0.1) for _ in range(3))]
    system = ns.System(bodies)
    system.name(bodies[1], "ball 2")
    for one, other in itertools.combinations(bodies, 2):
        system.contact(other, one, **LAWS)
    for _ in range(2):
        system.load(Spring(1.0, 1.0), bodies[0], bodies[1])
    system.joint(Fixed(), bodies[2], bodies[3], name="weld")
    return system


def test_all_parts_have_names_of_their_own() -> None:
    """Those that are made keep out of the way of the chosen ones."""
    names = _system().names
    assert names.bodies == ("plate", "ball 2", "ball 1", "ball 3")
    assert names.contacts[0] == "plate - ball 2"
    assert names.loads == ("spring plate - ball 2", "spring plate - ball 2 (2)")
    assert names.joints == ("weld",)
    assert len(set(names.contacts)) == 6


@pytest.mark.parametrize(
    ("number", "chosen", "names"),
    [
        (0, "floor", ("floor", "ball 1", "ball 2")),
        (1, "red", ("plate", "red", "ball")),
        (2, "ball 1", ("plate", "ball", "ball 1")),
        (1, "ball", ("plate", "ball", "ball 1")),
        (1, "plate", ("plate 1", "plate", "ball")),
        (1, "plate 1", ("plate", "plate 1", "ball")),
    ],
)
def test_made_names_count_what_has_none_chosen(number: int, chosen: str, names: tuple[str, ...]) -> None:
    """They yield to a chosen one only where it is theirs."""
    system = ns.System([Plate(), Ball(0.1), Ball(0.1)])
    system.name(system.bodies[number], chosen)
    assert system.names.bodies == names


def test_several_contacts_of_two_bodies_are_numbered_from_1_through_all_calls() -> None:
    plate, dumbbell = Plate(), Dumbbell(0.005, 4.0)
    system = ns.System([plate, dumbbell])
    for shape in (0, 1):
        system.contact(plate, dumbbell, shapes=(None, (shape,)), **LAWS)
    assert system.names.contacts == ("plate - dumbbell", "plate - dumbbell (2)")
    box = BoxBody(0.1, 0.1, 0.1)
    system = ns.System([plate, box])
    system.contact(plate, box, **LAWS, name="corner")
    assert system.names.contacts == tuple(f"corner ({i})" for i in range(1, 9))


def test_copies_have_the_same_names_and_go_on_with_them() -> None:
    system = _system()
    for made in (copy.copy(system), copy.deepcopy(system), ns.with_laws(system, friction=Coulomb(0.2))):
        assert made.names == system.names
        made.load(Spring(1.0, 1.0), *made.bodies[:2])
        assert made.names.loads[-1] == "spring plate - ball 2 (3)"
    assert len(system.names.loads) == 2


def test_a_system_that_refuses_keeps_its_names() -> None:
    """What contact_all takes back leaves no numbers behind."""
    plate, balls = Plate(), [Ball(0.1), Ball(0.1)]
    system = ns.System([plate, *balls])
    laws = ns.ContactLaws(**LAWS)
    with pytest.raises(ns.InvalidInput, match="laws"):
        system.contact_all(ns.Materials({("a", "b"): laws}), {"a": [plate], "b": [balls[0]]})
    system.contact_all(ns.Materials(default=laws))
    assert system.names.contacts == ("plate - ball 1", "plate - ball 2", "ball 1 - ball 2")


@pytest.mark.parametrize(
    ("name", "said"),
    [("", "single blanks"), ("a - b", "must not have"), ("a (1)", "must not have"), ("b", "nothing of")],
)
def test_names_that_are_refused(name: str, said: str) -> None:
    system = ns.System([Ball(0.1), Ball(0.1)])
    system.name(system.bodies[1], "b")
    with pytest.raises(ns.InvalidInput, match=said):
        system.name(system.bodies[0], name)


def test_a_body_that_others_are_named_after_keeps_its_name() -> None:
    system = _system()
    with pytest.raises(ns.InvalidInput, match="before contacts"):
        system.name(system.bodies[0], "floor")
    with pytest.raises(ns.InvalidInput, match="nothing of its kind"):
        system.joint(Fixed(), *system.bodies[1:3], name="weld")
