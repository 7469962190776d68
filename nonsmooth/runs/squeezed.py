"""Diagnosis of a body between driven bodies that approach each other, which no rigid contact can allow.

Take two points of a free body at which driven bodies act. A force along the line between the points is borne if it
lies in the friction cone of a contact, or along an axis that a joint constrains. Let both ends bear it, and
let the driven points approach each other along the line. Then the body can neither stick to both nor slip, and the
impulses grow without bound.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from nonsmooth.certificates import coefficient_of
from nonsmooth.engine.memory import blocks, owners
from nonsmooth.engine.memory.modes import Status
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.interfaces import Body, FrictionLaw
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.laying import joints_in_order

_STATUSES = (
    Status.IMPACT_ENDLESS,
    Status.NO_CONTACT_SOLUTION,
    Status.NOT_FINITE,
    Status.STALLED,
    Status.UPDATE_ENDLESS,
)
"""Statuses that a squeezed body may cause."""
_CLOSED = 1e4
"""Largest gap of a contact that counts as closed, in gap tolerances. Between two short bounces it is not zero."""
_ALONG = 1e-9
"""Sine of the angle between a line and an axis below which they are parallel. Round-off stays below it."""


class _Support(NamedTuple):
    """A point of a free body at which a driven body acts, through a contact or a joint.

    Attributes
    ----------
    name : str
        Name of the contact or joint.
    body : int
        Number of the free body.
    point : array
        The point of the free body [m].
    velocity : array
        Velocity of the driven body there [m/s].
    normal : array
        Unit normal of a contact into the free body, shape [3], or the constrained axes of a joint, shape [n, 3].
    friction : FrictionLaw or None
        Friction law of a contact; None for a joint.
    """

    name: str
    body: int
    point: np.ndarray
    velocity: np.ndarray
    normal: np.ndarray
    friction: FrictionLaw | None

    def bears(self, direction: np.ndarray) -> bool:
        """True if the support can exert a force along a unit vector, into the free body."""
        if self.friction is not None:
            # within the cone about the normal whose half angle is the angle of friction at rest
            return bool(direction @ self.normal >= math.cos(math.atan(coefficient_of(self.friction)(0.0))))
        # the part of the direction that no combination of the axes gives
        rest = direction - self.normal.T @ np.linalg.lstsq(self.normal.T, direction, rcond=None)[0]
        return float(np.linalg.norm(rest)) <= _ALONG


def squeezed_body(model: LaidOut, status: int) -> str:
    """Sentences that name a squeezed body and its supports after a run ended with a status, or "".

    Two supports of a body are compared at a time, of which at least one is a contact.
    """
    if status not in _STATUSES:
        return ""
    memory = model.memory
    # writes the points and velocities of bodies, contacts and joints at the last state
    call_entry("evaluate_at", memory)
    contacts = [one for index in range(len(model.active)) for one in _contact(model, index)]
    for one, two in (*itertools.combinations(contacts, 2), *itertools.product(contacts, _joints(model))):
        between = two.point - one.point
        length = float(np.linalg.norm(between))
        if one.body != two.body or length == 0.0:
            continue
        # from the first point to the second: both forces are into the body, toward the other point
        direction = between / length
        approach = float(direction @ (one.velocity - two.velocity))
        if one.bears(direction) and two.bears(-direction) and approach > float(memory[owners.Tolerance.velocity]):
            name = model.system.names.bodies[one.body]
            return (
                f"The body {name!r} is squeezed between driven ones: the {one.name} and the {two.name} press on it "
                f"along one line, and approach each other at {approach:.3g} m/s. No rigid contact allows that. Give "
                "these contacts a compliant normal law, or the driven bodies another motion."
            )
    return ""


def _free_body(model: LaidOut, first: Body, second: Body) -> tuple[int, bool] | None:
    """Number of the free body of a pair of a free and a driven one, and True if it is the second; None for other pairs.

    A driven body has a prescribed motion, and no velocities of its own.
    """
    bodies = model.system.bodies
    pair = [next(i for i, body in enumerate(bodies) if body is one) for one in (first, second)]
    free = [i for i in pair if bodies[i].n_u > 0]
    return (free[0], pair[1] == free[0]) if len(free) == 1 else None


def _point_and_velocity(
    model: LaidOut, frames: tuple[int, int], is_second: bool, row: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Point of the free body at which the driven one acts [m], and velocity of the driven body there [m/s].

    The first numbers of ``row`` hold a point on either body, ``frames`` are the places of the frames of both bodies,
    and ``is_second`` is True if the second body is the free one.
    """
    # offsets of the points in the row, "A" on the first body
    free, driven = (blocks.POINT_B, blocks.POINT_A) if is_second else (blocks.POINT_A, blocks.POINT_B)
    frame = model.memory.floats[frames[0] if is_second else frames[1] :]
    position, velocity, spin = (frame[at : at + 3] for at in (blocks.POSITION, blocks.VELOCITY, blocks.SPIN))
    return row[free : free + 3].copy(), velocity + np.cross(spin, row[driven : driven + 3] - position)


def _contact(model: LaidOut, index: int) -> list[_Support]:
    """The active contact of an index as a support, if it is closed, and between a free and a driven body; else nothing.

    Only a contact with Coulomb friction has a cone of forces.
    """
    memory = model.memory
    contact = model.system.contacts[model.active[index]]
    block = memory[owners.ContactRecord.geometry][index]
    found = _free_body(model, contact.first, contact.second)
    is_closed = block[blocks.GAP] <= _CLOSED * float(memory[owners.Tolerance.gap])
    if found is None or not is_closed or not isinstance(contact.friction, FrictionLaw):
        return []
    body, is_second = found
    frames = memory[owners.ContactRecord.frame_a][index], memory[owners.ContactRecord.frame_b][index]
    point, velocity = _point_and_velocity(model, frames, is_second, block)
    # the normal of a contact is from its first body to its second, that of a support into the free body
    normal = (1.0 if is_second else -1.0) * block[blocks.NORMAL : blocks.NORMAL + 3]
    return [_Support(str(contact), body, point, velocity, normal, contact.friction)]


def _joints(model: LaidOut) -> Iterator[_Support]:
    """The joints, as supports, between a free and a driven body that constrain a point along one axis or more.

    A row of a joint is one scalar constraint.
    """
    memory = model.memory
    for number, joint in enumerate(joints_in_order(model.system)):
        found = _free_body(model, joint.first, joint.second)
        count, start = (int(memory[one][number]) for one in (owners.JointRecord.n_rows, owners.JointRecord.out))
        rows = memory.floats[start : start + blocks.JOINT_ROW * count].reshape(count, blocks.JOINT_ROW)
        # rows with a moment constrain an angle, and bear no force at a point
        rows = rows[~np.any(rows[:, blocks.MOMENT : blocks.MOMENT + 3], axis=1)]
        if found is None or len(rows) == 0:
            continue
        body, is_second = found
        frames = memory[owners.JointRecord.frame_a][number], memory[owners.JointRecord.frame_b][number]
        # each row has points of its own; those of the first stand for the joint
        point, velocity = _point_and_velocity(model, frames, is_second, rows[0])
        yield _Support(str(joint), body, point, velocity, rows[:, blocks.AXIS : blocks.AXIS + 3], None)
