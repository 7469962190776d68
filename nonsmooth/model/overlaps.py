"""Overlaps of bodies in the poses that the memory holds.

Gaps belong to features that face each other. Bodies that overlap deeply may have none, so their convex pieces are
compared.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import GAP
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import CompliantNormalLaw
from nonsmooth.model.declared import DeclaredContacts
from nonsmooth.model.part_pairs import by_shapes, numbers_of_rows
from nonsmooth.solids.measure import touching
from nonsmooth.solids.pieces import Pieces
from nonsmooth.solids.placed import Placed, overlap
from nonsmooth.system.contact import Contact

if TYPE_CHECKING:
    from nonsmooth.interfaces.solid import Vector
    from nonsmooth.model.laid_out import LaidOut

_POSE = 12
"""Length of position and rotation matrix of a frame, with which its numbers begin."""


class Overlap(NamedTuple):
    """Two bodies that overlap.

    Attributes
    ----------
    contact : Contact
        A contact between them.
    depth : float
        Lower bound of the depth of the overlap [m].
    """

    contact: Contact
    depth: float


def check_overlaps(model: LaidOut) -> None:
    """Check that the shapes of active contacts, whose bodies were evaluated, do not overlap.

    Shapes whose features are searched for are compared, too, if no contact of theirs is active: a rod through a box has
    no features that are near each other.

    Raises
    ------
    InvalidInput
        If two overlap.
    """
    found = first_overlap(model, [*model.active.tolist(), *model.memory[owners.Search.first_contact].tolist()])
    if found is not None:
        kinds = " and ".join(type(shape).__name__ for shape in found.contact.shapes)
        raise InvalidInput(
            f"start of the {found.contact}",
            "must not overlap: its gap must be >= 0 [m]",
            -found.depth,
            f"The solids of {kinds} overlap at least so far. Place the bodies apart or touching, or declare no contact "
            f"between them.{at_default(model, found.contact)}",
        )


def at_default(model: LaidOut, contact: Contact) -> str:
    """Sentence that names the bodies of a contact that begin at their default position; "" if there are none.

    Such a body was probably never placed.
    """
    system = model.system
    q = system.starts()[0]
    # a run may begin from another state than the system's start
    if not np.array_equal(model.memory[owners.Island.y][: len(q)], q):
        return ""
    bodies = [body for body in (contact.first, contact.second) if body.n_q > 0]
    names = [repr(system.name_of(one)) for one in bodies if np.array_equal(system.start(one)[0], one.state()[0])]
    return f" At the default position: {' and '.join(names)}." if names else ""


def first_overlap(model: LaidOut, numbers: Sequence[int]) -> Overlap | None:
    """The first overlap of shapes deeper than is allowed, or None.

    Gaps belong to features that face each other, and do not show all overlaps, so convex pieces are compared. Compliant
    bodies may overlap if a gap of theirs is negative, because then a contact force pushes them apart.

    Parameters
    ----------
    model : LaidOut
        The model, whose bodies and active contacts were evaluated.
    numbers : sequence of int
        The contacts whose bodies are compared.
    """
    contacts, blocks = model.system.contacts, model.memory[owners.ContactRecord.geometry]
    indices = {number: index for index, number in enumerate(model.active.tolist())}
    # only pairs whose bounding spheres meet
    for same, one, two in placed_pairs(model, numbers, within=0.0):
        contact, near = contacts[same[0]], [indices[number] for number in same if number in indices]
        if np.any(blocks[near, GAP] < 0.0) and isinstance(contact.normal, CompliantNormalLaw):
            continue
        depth = overlap(one, two, float(touching(contact.size)))
        if depth > 0.0:
            return Overlap(contact, depth)
    return None


def placed_pairs(
    model: LaidOut, numbers: Sequence[int], within: float = np.inf
) -> Iterator[tuple[Sequence[int], Placed, Placed]]:
    """For each pair of bounded shapes with convex pieces: the numbers of their contacts, and the shapes in their poses.

    Parameters
    ----------
    model : LaidOut
        The model, whose bodies were evaluated.
    numbers : sequence of int
        Contacts of the system; all contacts of a pair of shapes, or none.
    within : float
        Shapes whose bounding spheres are farther apart than this are left out [m].
    """
    contacts = model.system.contacts
    rows = np.unique(np.searchsorted(contacts.starts, np.array(numbers), side="right") - 1)
    for same in by_shapes(contacts, rows.tolist()):
        row, of_rows = contacts.rows[same[0]], numbers_of_rows(contacts, same)
        # the gap of a half-space shows each overlap
        if not all(map(math.isfinite, row.extents)):
            continue
        frames = frames_of(model, of_rows[0])
        if math.dist(frames[0][:3], frames[1][:3]) - sum(row.extents) > within:
            continue
        found = [each for shape in row.shapes if (each := Pieces.of(shape)) is not None]
        # without pieces of both there is nothing to compare
        if len(found) < len(row.shapes):
            continue
        one, two = (
            Placed(each, frame[:3].copy(), frame[3:].reshape(3, 3).copy())
            for each, frame in zip(found, frames, strict=True)
        )
        yield of_rows, one, two


def frames_of(model: LaidOut, number: int) -> tuple[Vector, Vector]:
    """Position [m] and rotation matrix, row by row, of both frames of a contact, shape [12] each."""
    floats, declared = model.memory.floats, DeclaredContacts.of(model.memory, [number])
    first, second = (int(declared[frame][0]) for frame in (owners.ContactRecord.frame_a, owners.ContactRecord.frame_b))
    return floats[first : first + _POSE], floats[second : second + _POSE]
