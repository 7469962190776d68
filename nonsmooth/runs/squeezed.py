"""After a failure: a body between driven ones that come nearer to each other, to which nothing rigid has an answer."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from nonsmooth.certificates import coefficient_of
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import (
    AXIS,
    GAP,
    JOINT_ROW,
    MOMENT,
    NORMAL,
    POINT_A,
    POINT_B,
    POSITION,
    SPIN,
    VELOCITY,
)
from nonsmooth.engine.memory.modes import IMPACT_ENDLESS, NO_CONTACT_SOLUTION, NOT_FINITE, STALLED, UPDATE_ENDLESS
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.interfaces import Body, FrictionLaw
from nonsmooth.model.laid_out import LaidOut

_STATUSES = (IMPACT_ENDLESS, NO_CONTACT_SOLUTION, NOT_FINITE, STALLED, UPDATE_ENDLESS)
_CLOSED = 1e4
"""Gaps up to so many gap tolerances count: between the last of ever shorter bounces there is some."""
_ALONG = 1e-9
"""Sine of the angle up to which a line is one along which a joint bears: what rounding leaves of it."""


class _Hold(NamedTuple):
    """What a driven body does to a free one at a point: it presses within a cone, or a joint bears along some axes.

    Attributes
    ----------
    name : str
        What it is.
    body : int
        Number of the free body.
    point : array
        Its point there [m].
    velocity : array
        That of the driven body there [m/s].
    normal : array
        Unit vector into the free body, shape [3], or of a joint all axes along which it bears, shape [n, 3].
    friction : FrictionLaw or None
        That of the contact; a joint has none.
    """

    name: str
    body: int
    point: np.ndarray
    velocity: np.ndarray
    normal: np.ndarray
    friction: FrictionLaw | None

    def bears(self, line: np.ndarray) -> bool:
        """Return whether a force along a unit vector, into the free body, is borne."""
        if self.friction is not None:
            return bool(line @ self.normal >= math.cos(math.atan(coefficient_of(self.friction)(0.0))))
        left = line - self.normal.T @ np.linalg.lstsq(self.normal.T, line, rcond=None)[0]
        return float(np.linalg.norm(left)) <= _ALONG


def squeezed(model: LaidOut, status: int) -> str:
    """Return a sentence that names such a body and what holds it, "" if there is none.

    A body bears any force along the line between two points of it, if that lies in the friction cones of contacts there
    or is one along which a joint bears.  While the driven bodies there come nearer to each other along that line it can
    neither stick to both nor slip: impulses grow until something gives, and nothing rigid does.
    """
    if status not in _STATUSES:
        return ""
    call_entry("evaluate_at", model.memory)
    contacts = [hold for slot in range(int(model.memory[owners.Island.n_contacts])) for hold in _driven(model, slot)]
    for one, two in (*itertools.combinations(contacts, 2), *itertools.product(contacts, _jointed(model))):
        way = two.point - one.point
        length = float(np.linalg.norm(way))
        if one.body != two.body or length == 0.0:
            continue
        line = way / length
        nearer = float(line @ (one.velocity - two.velocity))
        if one.bears(line) and two.bears(-line) and nearer > float(model.memory[owners.Tolerance.velocity]):
            name = model.system.names.bodies[one.body]
            return (
                f"The body {name!r} is squeezed between driven ones: the {one.name} and the {two.name} press on it "
                f"along one line, and come nearer to each other by {nearer:.3g} m/s. Rigid bodies have no answer to "
                "that; give these contacts a compliant normal law, or the driven bodies another motion."
            )
    return ""


def _free(model: LaidOut, first: Body, second: Body) -> tuple[int, bool] | None:
    """Return the number of the free one of a free and a driven body, and whether it is the second; else None."""
    bodies = model.system.bodies
    pair = [next(i for i, body in enumerate(bodies) if body is own) for own in (first, second)]
    free = [i for i in pair if bodies[i].n_u > 0]
    return (free[0], pair[1] == free[0]) if len(free) == 1 else None


def _velocity(model: LaidOut, place: int, point: np.ndarray) -> np.ndarray:
    """Return the velocity of a point of the frame that stands at a place."""
    frame = model.memory.floats[place:]
    arm = point - frame[POSITION : POSITION + 3]
    return np.asarray(frame[VELOCITY : VELOCITY + 3] + np.cross(frame[SPIN : SPIN + 3], arm))


def _driven(model: LaidOut, slot: int) -> list[_Hold]:
    """Return the contact of a slot, if it is closed, rigid, and one of a driven body with another one."""
    memory = model.memory
    contact = model.system.contacts[int(memory[owners.Contact.declared][slot])]
    block = memory[owners.Contact.geometry][slot]
    found = _free(model, contact.first, contact.second)
    closed = block[GAP] <= _CLOSED * float(memory[owners.Tolerance.gap])
    if found is None or not closed or not isinstance(contact.friction, FrictionLaw):
        return []
    body, second = found
    own, other = (POINT_B, POINT_A) if second else (POINT_A, POINT_B)
    place = int(memory[owners.Contact.frame_a if second else owners.Contact.frame_b][slot])
    velocity = _velocity(model, place, block[other : other + 3])
    normal = (1.0 if second else -1.0) * block[NORMAL : NORMAL + 3]
    return [_Hold(str(contact), body, block[own : own + 3].copy(), velocity, normal, contact.friction)]


def _jointed(model: LaidOut) -> Iterator[_Hold]:
    """Yield the joints that hold a point of a free body at a driven one, along one axis or more."""
    memory = model.memory
    for number, joint in enumerate(model.system.joints):
        found = _free(model, joint.first, joint.second)
        count, start = (int(memory[one][number]) for one in (owners.Joint.n_rows, owners.Joint.out))
        rows = memory.floats[start : start + JOINT_ROW * count].reshape(count, JOINT_ROW)
        rows = rows[~np.any(rows[:, MOMENT : MOMENT + 3], axis=1)]
        if found is None or len(rows) == 0:
            continue
        body, second = found
        own, other = (POINT_B, POINT_A) if second else (POINT_A, POINT_B)
        place = int(memory[owners.Joint.frame_a if second else owners.Joint.frame_b][number])
        velocity = _velocity(model, place, rows[0, other : other + 3])
        yield _Hold(str(joint), body, rows[0, own : own + 3].copy(), velocity, rows[:, AXIS : AXIS + 3], None)
