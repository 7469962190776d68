"""Laws by pair of materials: which pairs get which laws, and what is refused."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

import nonsmooth as ns
from bodies import Ball, BallJoint, Dumbbell, Plate
from laws import Coulomb, EnergeticImpact, NewtonImpact, Unilateral


def _laws(friction: float, restitution: float = 0.5) -> ns.ContactLaws:
    return ns.ContactLaws(Unilateral(), Coulomb(friction), EnergeticImpact(restitution))


STEEL, MIXED, GLASS, OTHER = (_laws(mu) for mu in (0.1, 0.2, 0.3, 0.4))
TABLE = ns.Materials({("steel", "steel"): STEEL, ("glass", "steel"): MIXED, ("glass", "glass"): GLASS})


def _raises(words: tuple[str, ...], action: Callable[[], Any]) -> None:
    with pytest.raises(ns.InvalidInput) as caught:
        action()
    for word in words:
        assert word in str(caught.value)


def _scene() -> tuple[ns.System, list[Any], list[Any]]:
    """Two plates and three equal balls."""
    plates, balls = [Plate(), Plate()], [Ball(0.01) for _ in range(3)]
    return ns.System([*plates, *balls]), plates, balls


def _friction(system: ns.System, one: Any, other: Any) -> list[Any]:
    return [c.friction for c in system.contacts if {id(c.first), id(c.second)} == {id(one), id(other)}]


def test_materials_choose_the_laws() -> None:
    """In either order, for equal bodies of different materials; driven pairs are left out."""
    system, plates, balls = _scene()
    added = system.contact_all(TABLE, {"steel": [*plates, balls[0]], "glass": balls[1:]})
    assert added == system.contacts
    assert len(added) == 2 * 3 + 3
    assert balls[0] == balls[1]
    for plate in plates:
        assert [_friction(system, plate, ball) for ball in balls] == [[STEEL.friction], *[[MIXED.friction]] * 2]
    assert _friction(system, balls[0], balls[2]) == [MIXED.friction]
    assert _friction(system, balls[1], balls[2]) == [GLASS.friction]
    assert _friction(system, *plates) == []


def test_the_default_fills_gaps() -> None:
    """For pairs that are not in the table, and for bodies without a material."""
    system, plates, balls = _scene()
    table = ns.Materials({("steel", "steel"): STEEL, ("glass", "glass"): GLASS}, default=OTHER)
    system.contact_all(table, {"steel": plates, "glass": balls[:2]})
    assert _friction(system, plates[0], balls[0]) == [OTHER.friction]
    assert _friction(system, balls[0], balls[1]) == [GLASS.friction]
    assert _friction(system, balls[0], balls[2]) == [OTHER.friction]
    everything, _, _ = _scene()
    assert len(everything.contact_all(OTHER)) == 9
    assert {contact.impact for contact in everything.contacts} == {OTHER.impact}


def test_pairs_of_their_own() -> None:
    """A pair declared before keeps its laws; excluded pairs and those of a joint do not touch."""
    system, plates, balls = _scene()
    own = _laws(0.9)
    system.contact(balls[0], plates[0], normal=own.normal, friction=own.friction, impact=own.impact)
    system.joint(BallJoint(), balls[0], balls[1])
    added = system.contact_all(ns.Materials(default=OTHER), exclude=[(plates[1], balls[2])])
    assert len(added) == 9 - 3
    assert _friction(system, plates[0], balls[0]) == [own.friction]
    assert _friction(system, balls[0], balls[1]) == []
    assert _friction(system, balls[2], plates[1]) == []


def test_a_pair_with_contacts_of_some_shapes_keeps_them() -> None:
    """It gets no more, so that shapes left out stay left out."""
    plate, bodies = Plate(), [Dumbbell(), Dumbbell()]
    system = ns.System([plate, *bodies])
    own = _laws(0.9)
    chosen = (None, (1,))
    system.contact(plate, bodies[0], normal=own.normal, friction=own.friction, impact=own.impact, shapes=chosen)
    assert len(system.contact_all(ns.Materials(default=OTHER))) == 2 + 4
    assert _friction(system, plate, bodies[0]) == [own.friction]


def test_some_of_the_bodies() -> None:
    """Only they touch each other; a second call adds the rest."""
    system, plates, balls = _scene()
    assert len(system.contact_all(ns.Materials(default=OTHER), bodies=[plates[0], *balls[:2]])) == 3
    assert len(system.contact_all(ns.Materials(default=STEEL))) == 9 - 3
    assert _friction(system, balls[0], balls[1]) == [OTHER.friction]


def test_a_pair_is_declared_once() -> None:
    """A second declaration would count its forces twice."""
    system, plates, balls = _scene()
    laws: Any = {"normal": STEEL.normal, "friction": STEEL.friction, "impact": STEEL.impact}
    system.contact(plates[0], balls[0], **laws)
    system.contact(plates[1], balls[0], **laws)
    words = ("System.contact", "'ball 1'", "no contact with each other yet")
    _raises(words, lambda: system.contact(plates[0], balls[0], **laws))
    _raises(words, lambda: system.contact(balls[0], plates[0], **laws))
    assert len(system.contacts) == 2


def test_pairs_without_laws() -> None:
    """The two materials and the remedy are named, and nothing is added."""
    system, plates, balls = _scene()
    table = ns.Materials({("steel", "steel"): STEEL, ("glass", "steel"): MIXED})
    of = {"steel": plates, "glass": balls}
    _raises(("'glass' and 'glass'", "Add pairs['glass', 'glass'] or a default"), lambda: system.contact_all(table, of))
    _raises(("'steel' and no material", "Give every body"), lambda: system.contact_all(table, {"steel": plates}))
    assert system.contacts == ()
    assert len(system.contact_all(TABLE, of)) == 9


def test_wrong_materials_and_bodies() -> None:
    """Unknown names, strangers, two materials for one body."""
    system, plates, balls = _scene()
    of: Any = {"steel": plates, "glass": balls}
    every = ns.Materials(default=OTHER)
    _raises(("Unknown material", "'glas'", "Did you mean 'glass'"), lambda: system.contact_all(TABLE, {"glas": balls}))
    _raises(("Unknown material", "Known: none"), lambda: system.contact_all(every, of))
    _raises(("body of this system",), lambda: system.contact_all(TABLE, of | {"glass": [*balls, Ball(0.01)]}))
    _raises(("bodies", "body of this system"), lambda: system.contact_all(every, bodies=[*balls, Ball(0.01)]))
    _raises(("exclude", "body of this system"), lambda: system.contact_all(every, exclude=[(balls[0], Ball(0.01))]))
    _raises(("two different bodies",), lambda: system.contact_all(every, bodies=[balls[0], balls[0]]))
    twice = {"steel": [*plates, balls[0]], "glass": balls}
    _raises(("one material", "ball 1 of 'steel' and 'glass'", "Take it out"), lambda: system.contact_all(TABLE, twice))
    assert system.contacts == ()


def test_wrong_tables() -> None:
    """A pair twice, keys that are not pairs of names, laws that are none, impact laws of two kinds."""
    wrong: Any
    for wrong in ("steel", ("steel",), ("steel", 1), ("steel", "")):
        _raises(("Materials.pairs", "two names"), lambda wrong=wrong: ns.Materials({wrong: STEEL}))  # type: ignore[misc]
    both = {("steel", "glass"): STEEL, ("glass", "steel"): STEEL}
    _raises(("hold a pair once", "Keep one"), lambda: ns.Materials(both))
    wrong = {("steel", "glass"): Coulomb(0.2)}
    _raises(("Materials.pairs['steel', 'glass']", "must be ContactLaws"), lambda: ns.Materials(wrong))
    wrong = EnergeticImpact(0.5)
    _raises(("Materials.default", "must be ContactLaws"), lambda: ns.Materials(default=wrong))
    _raises(("ContactLaws", "needs a FrictionLaw"), lambda: ns.ContactLaws(Unilateral(), wrong, wrong))
    system, plates, balls = _scene()
    newton = ns.ContactLaws(Unilateral(), Coulomb(0.1), NewtonImpact(0.5))
    mixed = ns.Materials({("steel", "glass"): STEEL}, default=newton)
    _raises(("kind of",), lambda: system.contact_all(mixed, {"steel": plates, "glass": balls}))
    assert system.contacts == ()
