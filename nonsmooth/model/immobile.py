"""Contacts that no force can move along their normal, because joints hold their points.

The effective inverse mass of a contact is the acceleration of its gap per normal force [1/kg]: W^T K W, where K is the
inverse mass that the joints leave. If it is zero relative to W^T M^-1 W, that of the bodies without their joints, the
joints bear the whole force, and no motion determines it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.layout import SINGULAR
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.interfaces import CompliantNormalLaw
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.laying import place_of_inverse_mass
from nonsmooth.system.contact import Contact, Tie

REMEDY = "Leave a clearance between its bodies there."
"""Remedy for such a contact."""


class ImmobileContact(NamedTuple):
    """A contact that no force can move along its normal.

    Attributes
    ----------
    contact : Contact
        The contact.
    joints : list of Tie
        The joints of its bodies.
    ratio : float
        Its effective inverse mass relative to that without joints.
    """

    contact: Contact
    joints: list[Tie]
    ratio: float


def immobile_contact(model: LaidOut) -> ImmobileContact | None:
    """The first touching rigid contact that joints keep from moving along its normal, or None.

    Joints bear the whole force of such a contact, so that no motion determines it. Evaluates the touching contacts of
    the present state. A compliant contact is left out, because its law gives the force.
    """
    if not model.system.joints:
        return None
    memory = model.memory
    call_entry("find_touching", memory)
    active = model.active
    for index in np.flatnonzero(memory[owners.ContactRecord.is_touching][: len(active)]).tolist():
        contact = model.system.contacts[active[index]]
        if isinstance(contact.normal, CompliantNormalLaw):
            continue
        # effective inverse mass of each side, with joints and without; the contact has the sum
        sides = [_inverse_masses(model, index, side) for side in ("a", "b")]
        held, free = (sum(values) for values in zip(*sides, strict=True))
        # two driven bodies have none, and are left out; below SINGULAR times free, held is round-off
        if free > 0.0 and held <= SINGULAR * free:
            bodies = contact.first, contact.second
            joints = [tie for tie in model.system.joints if tie.first in bodies or tie.second in bodies]
            return ImmobileContact(contact, joints, held / free)
    return None


def held_by(joints: list[Tie]) -> str:
    """Clause that names the joints that hold a contact: "the joint 'a' holds it there"."""
    names = ", ".join(f"the {tie}" for tie in joints)
    return f"{names} {'holds' if len(joints) == 1 else 'hold'} it there"


def _inverse_masses(model: LaidOut, index: int, side: str) -> tuple[float, float]:
    """Effective inverse mass of one side of an active contact along its normal, with and without joints [1/kg].

    ``index`` is that of the neighbour list, ``side`` "a" for the first body or "b". With joints it is W^T K W, where K
    is the inverse mass of all bodies that joints tie together. Without joints it is the sum over these bodies.
    """
    memory = model.memory
    contact, articulation = owners.ContactRecord, owners.Articulation
    fields = {
        "a": (contact.articulation_a, contact.jacobian_a, contact.response_a),
        "b": (contact.articulation_b, contact.jacobian_b, contact.response_b),
    }
    number, *places = (int(memory[field][index]) for field in fields[side])
    sizes = articulation.n_u, articulation.first_body, articulation.n_bodies, articulation.u
    n_u, first, count, start = (int(memory[field][number]) for field in sizes)
    # row n of W^T, and K W: gap rate per velocity of the articulation, and accelerations per normal force
    row, response = (memory.floats[place : place + n_u] for place in places)
    free = sum(_free_inverse_mass(model, body, row, start) for body in range(first, first + count))
    return float(row @ response), free


def inverse_mass(model: LaidOut, number: int) -> np.ndarray:
    """View of the inverse mass matrix of a body without joints, as it was evaluated last, shape [n_u, n_u]."""
    n_u, start = model.system.bodies[number].n_u, place_of_inverse_mass(model.memory, number)
    return np.asarray(model.memory.floats[start : start + n_u**2].reshape(n_u, n_u))


def _free_inverse_mass(model: LaidOut, number: int, row: np.ndarray, start: int) -> float:
    """Effective inverse mass of body ``number`` along the normal of a contact, without joints [1/kg].

    ``row`` has the gap rate per velocity of its articulation, the bodies that joints tie together. The first of these
    velocities is velocity ``start`` of the system.
    """
    body = model.system.bodies[number]
    # a force does not move a driven body
    if body.n_u == 0:
        return 0.0
    u = int(model.memory[owners.BodyRecord.u][number])
    part = row[u - start : u - start + body.n_u]
    return float(part @ inverse_mass(model, number) @ part)
