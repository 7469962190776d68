"""The contacts of a system are a sequence that is made from rows, one for each pair of shapes."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, BoxBody, Plate
from laws import Coulomb, EnergeticImpact, Unilateral

LAWS = ns.ContactLaws(Unilateral(), Coulomb(0.3), EnergeticImpact(0.5))


@pytest.fixture
def system() -> ns.System:
    """Two boxes, a ball and a plate, all of them in contact."""
    made = ns.System([Plate(), BoxBody(0.1, 0.1, 0.1), BoxBody(0.1, 0.2, 0.1), Ball(0.1)])
    made.contact_all(LAWS)
    return made


def test_each_contact_is_one_object(system: ns.System) -> None:
    """By index, by a slice, by iteration and in what declares them, also if other contacts follow."""
    other = Ball(0.2)
    more = ns.System([*system.bodies, other])
    first = more.contact(more.bodies[0], more.bodies[1], normal=LAWS.normal, friction=LAWS.friction, impact=LAWS.impact)
    before = more.contacts
    more.contact(more.bodies[0], other, normal=LAWS.normal, friction=LAWS.friction, impact=LAWS.impact)
    assert len(more.contacts) == len(before) + 1 == len(first) + 1
    for i, contact in enumerate(first):
        assert contact is before[i]
        assert contact is more.contacts[i]
        assert contact is more.contacts[np.int64(i)]
        assert contact is more.contacts[: i + 1][-1]
    assert more.contacts[-1] is [*more.contacts][-1]
    with pytest.raises(IndexError):
        more.contacts[len(more.contacts)]


def test_names_and_rows_belong_to_the_contacts(system: ns.System) -> None:
    """Names are unique, and the numbers of the rows count all contacts."""
    contacts = system.contacts
    assert system.names.contacts == tuple(contact.name for contact in contacts)
    assert len({*system.names.contacts}) == len(contacts) == sum(map(len, contacts.rows))
    for row, start in zip(contacts.rows, contacts.starts, strict=False):
        for index in range(len(row)):
            contact = contacts[int(start) + index]
            assert contact is row.contact(index)
            assert (contact.first, contact.second) == row.bodies
            assert contact.kinematics is row.kinematics[index]


def test_copies_have_equal_contacts(system: ns.System) -> None:
    for made in (copy.deepcopy(system), pickle.loads(pickle.dumps(system))):
        assert made.names == system.names
        assert [*map(str, made.contacts)] == [*map(str, system.contacts)]


def test_contacts_are_chosen_as_they_were_declared() -> None:
    """What ``contact`` returns chooses its contacts in a history, like a list of them."""
    plate, one, two = Plate(), Ball(0.1), Ball(0.1)
    system = ns.System([plate, one, two])
    laws: dict[str, Any] = {"normal": LAWS.normal, "friction": LAWS.friction, "impact": LAWS.impact}
    _, declared = (system.contact(plate, ball, **laws) for ball in (one, two))
    system.place(one, position=(0.0, 0.0, 0.2))
    system.place(two, position=(1.0, 0.0, 0.3))
    solution = ns.simulate(system, 0.01)
    for chosen in (declared, [*declared], declared[0]):
        assert solution.history("gap", times=0.0, of=chosen)["gap"] == pytest.approx(0.2)
