"""Contacts whose gap no force changes, as joints hold their points along the normal."""

from __future__ import annotations

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.engine.numerics.linear import SINGULAR
from nonsmooth.interfaces import CompliantNormalLaw
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.system.contact import Contact, Tie

REMEDY = "Leave a clearance between its bodies there."
"""What to do about such a contact."""


def immobile_contact(model: LaidOut) -> tuple[Contact, list[Tie], float] | None:
    """Return the first rigid contact that touches and has no mobility along its normal, None if there is none.

    The mobility of a contact is its gap acceleration per normal force [1/kg]: W^T K W, K being the inverse mass that
    joints leave.  Where it vanishes next to W^T M^-1 W, that of the bodies without their joints, the force is not
    determined by any motion: the joints take all of it.

    Returns
    -------
    tuple or None
        The contact, the joints of its bodies, and its mobility over that without joints.
    """
    if not model.system.joints:
        return None
    memory = model.memory
    call_entry("touch", memory)
    n = int(memory[owners.Island.n_contacts])
    touching, identity = memory[owners.Contact.is_touching][:n], memory[owners.Contact.declared][:n]
    for slot in np.flatnonzero(touching == 1).tolist():
        contact = model.system.contacts[int(identity[slot])]
        if isinstance(contact.normal, CompliantNormalLaw):
            continue
        held = free = 0.0
        for side in ("a", "b"):
            with_joints, without = _mobilities(model, slot, side)
            held, free = held + with_joints, free + without
        # between driven bodies there is nothing to move, with or without joints
        if free > 0.0 and held <= SINGULAR * free:
            bodies = contact.first, contact.second
            joints = [tie for tie in model.system.joints if tie.first in bodies or tie.second in bodies]
            return contact, joints, held / free
    return None


def held_by(joints: list[Tie]) -> str:
    """Return what holds a contact, in words: the joints of its bodies."""
    names = ", ".join(f"the {tie}" for tie in joints)
    return f"{names} {'holds' if len(joints) == 1 else 'hold'} it there"


def _mobilities(model: LaidOut, slot: int, side: str) -> tuple[float, float]:
    """Return the mobility along the normal that one side of a contact gives it, with and without joints [1/kg]."""
    memory = model.memory
    contact, articulation = owners.Contact, owners.Articulation
    fields = {
        "a": (contact.articulation_a, contact.jacobian_a, contact.response_a),
        "b": (contact.articulation_b, contact.jacobian_b, contact.response_b),
    }
    number, *places = (int(memory[field][slot]) for field in fields[side])
    n_u, first, count, start = (
        int(memory[field][number])
        for field in (articulation.n_u, articulation.first_body, articulation.n_bodies, articulation.u)
    )
    row, response = (memory.floats[place : place + n_u] for place in places)
    free = sum(_free_mobility(model, body, row, start) for body in range(first, first + count))
    return float(row @ response), free


def inverse_mass(model: LaidOut, number: int) -> np.ndarray:
    """Return the inverse mass matrix of a body alone, as it was evaluated last, shape [n_u, n_u]."""
    memory, body = model.memory, model.system.bodies[number]
    tail = int(memory[owners.Body.tail][number])
    start = tail + body.n_q + body.n_u
    return np.asarray(memory.floats[start : start + body.n_u**2].reshape(body.n_u, body.n_u))


def _free_mobility(model: LaidOut, number: int, row: np.ndarray, start: int) -> float:
    """Return the mobility that a body alone gives to a row over the velocities of its articulation [1/kg]."""
    body = model.system.bodies[number]
    if body.n_u == 0:
        return 0.0
    u = int(model.memory[owners.Body.u][number])
    own = row[u - start : u - start + body.n_u]
    return float(own @ inverse_mass(model, number) @ own)
