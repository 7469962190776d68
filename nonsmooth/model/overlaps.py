"""The solids of a laid-out system where they stand, and whether some overlap that may not."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import CompliantNormalLaw
from nonsmooth.solids.placed import Placed, overlap
from nonsmooth.system.contact import Contact

if TYPE_CHECKING:
    from nonsmooth.interfaces.solid import Vector
    from nonsmooth.model.laid_out import LaidOut

_ENDS = 12
"""Numbers of a frame that say where it is."""


def overlap_allowed(contact: Contact) -> float:
    """Return by how much bodies that touch may overlap [m]."""
    return max(1e-9, 1e-6 * contact.size)


def check_overlaps(model: LaidOut) -> None:
    """Look at the solids of all contacts near each other, whose bodies have been evaluated.

    Raises
    ------
    InvalidInput
        If two overlap.
    """
    found = deepest_overlap(
        model, model.memory[owners.Contact.declared][: int(model.memory[owners.Island.n_contacts])].tolist()
    )
    if found is not None:
        contact, depth = found
        kinds = " and ".join(type(shape).__name__ for shape in contact.shapes)
        raise InvalidInput(
            f"start of the {contact}",
            "must not overlap: its gap must be >= 0 [m]",
            -depth,
            f"The solids of {kinds} reach at least so far into each other. Place the bodies apart or touching, "
            "or declare no contact between them.",
        )


def deepest_overlap(model: LaidOut, numbers: Sequence[int]) -> tuple[Contact, float] | None:
    """Return a contact whose solids overlap, and by how much at least [m]; None if no tolerance is exceeded.

    Compliant bodies may overlap where that is felt: where they have a gap that is negative.

    Parameters
    ----------
    model : LaidOut
        Laid out, its bodies and the contacts near each other evaluated.
    numbers : sequence of int
        Contacts of the system that are looked at.
    """
    contacts, memory = model.system.contacts, model.memory
    n = int(memory[owners.Island.n_contacts])
    blocks = memory[owners.Contact.geometry][:n]
    slots = {number: slot for slot, number in enumerate(memory[owners.Contact.declared][:n].tolist())}
    for same, one, two in solid_pairs(model, numbers, within=0.0):
        contact, near = contacts[same[0]], [slots[number] for number in same if number in slots]
        least = min((float(blocks[slot, 0]) for slot in near), default=0.0)
        if least < 0.0 and isinstance(contact.normal, CompliantNormalLaw):
            continue
        allowed = overlap_allowed(contact) + one.solid.set_back + two.solid.set_back
        nearest = min(near, key=lambda slot: abs(float(blocks[slot, 0])), default=None)
        normal = np.array([0.0, 0.0, 1.0]) if nearest is None else blocks[nearest, 1:4]
        found = overlap(one, two, allowed, normal)
        if found > 0.0:
            return contact, found
    return None


def solid_pairs(
    model: LaidOut, numbers: Sequence[int], within: float = np.inf
) -> Iterator[tuple[list[int], Placed, Placed]]:
    """Yield, for every two shapes that have solids, their contacts and the solids where they stand.

    Parameters
    ----------
    model : LaidOut
        Laid out, its bodies evaluated.
    numbers : sequence of int
        Contacts of the system.
    within : float
        Shapes whose balls about the origins of their frames are farther apart than this are left out [m].
    """
    pairs: dict[tuple[int, ...], list[int]] = {}
    contacts = model.system.contacts
    for number in numbers:
        contact = contacts[number]
        key = (*map(id, (contact.first, contact.second, *contact.shapes)), *contact.frames)
        pairs.setdefault(key, []).append(number)
    for same in pairs.values():
        contact = contacts[same[0]]
        solids = [solid for shape in contact.shapes if (solid := shape.solid) is not None]
        if len(solids) < len(contact.shapes):
            continue
        frames = frames_of(model, same[0])
        if math.dist(frames[0][:3], frames[1][:3]) - sum(contact.extents) > within:
            continue
        one, two = (
            Placed(solid, frame[:3].copy(), frame[3:].reshape(3, 3).copy())
            for solid, frame in zip(solids, frames, strict=True)
        )
        yield same, one, two


def frames_of(model: LaidOut, number: int) -> tuple[Vector, Vector]:
    """Return position [m] and rotation matrix, row by row, of both frames of a contact, shape [12] each."""
    floats, declared = model.memory.floats, model.memory.declared
    first, second = (int(declared(frame)[number]) for frame in (owners.Contact.frame_a, owners.Contact.frame_b))
    return floats[first : first + _ENDS], floats[second : second + _ENDS]
