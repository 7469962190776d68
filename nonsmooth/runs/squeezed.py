"""After a failure: a body between driven ones that come nearer to each other, to which nothing rigid has an answer."""

from __future__ import annotations

import itertools
import math

import numpy as np

from nonsmooth.certificates import coefficient_of
from nonsmooth.engine.memory.blocks import GAP, GEOMETRY, NORMAL, POINT_A, POINT_B, POSITION, SPIN, VELOCITY
from nonsmooth.engine.memory.modes import IMPACT_ENDLESS, NO_CONTACT_SOLUTION, NOT_FINITE, STALLED, UPDATE_ENDLESS
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.interfaces import FrictionLaw
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.system.contact import Contact

_STATUSES = (IMPACT_ENDLESS, NO_CONTACT_SOLUTION, NOT_FINITE, STALLED, UPDATE_ENDLESS)
_CLOSED = 1e4
"""Gaps up to so many gap tolerances count: between the last of ever shorter bounces there is some."""

_Row = tuple[Contact, int, np.ndarray, np.ndarray, np.ndarray]
"""A contact of a free body with a driven one: number of the free one, its point, the normal into it, the other's
velocity there."""


def squeezed(model: LaidOut, status: int) -> str:
    """Return a sentence that names such a body and its contacts, "" if there is none.

    A body bears any force along the line between two of its contacts that lies in the friction cones of both.  While
    the driven bodies there come nearer to each other along that line it can neither stick to both nor slip: impulses
    grow until something gives, and nothing rigid does.
    """
    if status not in _STATUSES:
        return ""
    call_entry("evaluate_at", model.memory)
    rows = [row for slot in range(int(model.memory.scalars["n_contacts"][0])) for row in _driven(model, slot)]
    for one, two in itertools.combinations(rows, 2):
        way = two[2] - one[2]
        length = float(np.linalg.norm(way))
        if one[1] != two[1] or length == 0.0:
            continue
        line = way / length
        nearer = float(line @ (one[4] - two[4]))
        borne = line @ one[3] >= _cosine(one[0]) and -line @ two[3] >= _cosine(two[0])
        if borne and nearer > float(model.memory.scalars["velocity_tolerance"][0]):
            name = model.system.names.bodies[one[1]]
            return (
                f"The body {name!r} is squeezed between driven ones: the {one[0]} and the {two[0]} press on it along "
                f"one line, and come nearer to each other by {nearer:.3g} m/s. Rigid bodies have no answer to that; "
                "give these contacts a compliant normal law, or the driven bodies another motion."
            )
    return ""


def _driven(model: LaidOut, slot: int) -> list[_Row]:
    """Return the row of a contact that is closed, rigid, and one of a driven body with another one."""
    memory, n = model.memory, int(model.memory.scalars["n_contacts"][0])
    contact = model.system.contacts[int(memory.array("identity", n)[slot])]
    block = memory.array("geometry", GEOMETRY * n)[GEOMETRY * slot :]
    bodies = model.system.bodies
    pair = [next(i for i, body in enumerate(bodies) if body is own) for own in (contact.first, contact.second)]
    free = [i for i in pair if bodies[i].n_u > 0]
    closed = block[GAP] <= _CLOSED * float(memory.scalars["gap_tolerance"][0])
    if len(free) != 1 or not closed or not isinstance(contact.friction, FrictionLaw):
        return []
    second = pair[1] == free[0]
    frame = memory.floats[int(memory.array("frame_a" if second else "frame_b", n)[slot]) :]
    own, other = (POINT_B, POINT_A) if second else (POINT_A, POINT_B)
    arm = block[other : other + 3] - frame[POSITION : POSITION + 3]
    velocity = frame[VELOCITY : VELOCITY + 3] + np.cross(frame[SPIN : SPIN + 3], arm)
    normal = (1.0 if second else -1.0) * block[NORMAL : NORMAL + 3]
    return [(contact, free[0], block[own : own + 3].copy(), normal, velocity)]


def _cosine(contact: Contact) -> float:
    """Return the cosine of the angle of friction."""
    assert isinstance(contact.friction, FrictionLaw)
    return math.cos(math.atan(coefficient_of(contact.friction)(0.0)))
