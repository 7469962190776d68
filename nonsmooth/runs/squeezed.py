"""Diagnosis of a body between driven bodies that approach each other, which no rigid contact can allow.

Take a force on a free body in the friction cone of a contact with a driven body. Let another such contact, or a joint
with a driven body, bear it: its reaction balances the force. Let the driven bodies approach each other along the force.
Then the body can neither stick to both nor slip, and the impulses grow without bound.
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
"""Part of a force or moment that counts as none, relative to the whole. Round-off stays below it."""


class _Touch(NamedTuple):
    """A closed contact of a free body with a driven one.

    Attributes
    ----------
    name : str
        Name of the contact.
    body : int
        Number of the free body.
    point : array
        The point of the free body [m].
    velocity : array
        Velocity of the driven body there [m/s].
    normal : array
        Unit normal into the free body, shape [3].
    friction : FrictionLaw
        Friction law of the contact.
    """

    name: str
    body: int
    point: np.ndarray
    velocity: np.ndarray
    normal: np.ndarray
    friction: FrictionLaw

    def exerts(self, direction: np.ndarray) -> bool:
        """True if a force on the free body along the unit vector ``direction`` is in the friction cone."""
        # within the cone about the normal whose half angle is the angle of friction at rest
        return bool(direction @ self.normal >= math.cos(math.atan(coefficient_of(self.friction)(0.0))))


class _Hold(NamedTuple):
    """A joint of a free body with a driven one. A row of a joint is one scalar constraint.

    Attributes
    ----------
    name : str
        Name of the joint.
    body : int
        Number of the free body.
    forces, moments : array
        Force of each row, and its moment about the origin [m], relative to the multiplier of the row, shape [n, 3].
    rates : array
        Power of each row on the driven body, relative to its multiplier [m/s], shape [n].
    """

    name: str
    body: int
    forces: np.ndarray
    moments: np.ndarray
    rates: np.ndarray


class _Line(NamedTuple):
    """A force of a contact that another contact or joint bears.

    Attributes
    ----------
    direction : array
        Unit vector of the force on the free body.
    approach : float
        Speed at which the two driven bodies approach each other along the force [m/s].
    """

    direction: np.ndarray
    approach: float


def _between(one: _Touch, two: _Touch) -> _Line | None:
    """The line from contact ``one`` to contact ``two`` of a body, or None if a force along it is in only one cone."""
    between = two.point - one.point
    length = float(np.linalg.norm(between))
    if length == 0.0 or not two.exerts(-between / length):
        return None
    direction = between / length
    return _Line(direction, float(direction @ (one.velocity - two.velocity)))


def _against(one: _Touch, two: _Hold) -> _Line | None:
    """The force of contact ``one`` that joint ``two`` bears and that is nearest to the normal, or None.

    The joint bears a force at the contact point if multipliers of its rows give that force, without a moment about the
    point. A ball joint bears a force through it, a slider any force across its axis.
    """
    about_point = two.moments - np.cross(one.point, two.forces)
    left, sizes, _ = np.linalg.svd(about_point)
    free = left[:, int(np.sum(sizes > _ALONG * max(1.0, sizes[0]))) :]
    borne = two.forces.T @ free
    multipliers = np.linalg.lstsq(borne, one.normal, rcond=_ALONG)[0]
    force = borne @ multipliers
    length = float(np.linalg.norm(force))
    if length <= _ALONG:
        return None
    direction = force / length
    return _Line(direction, float(direction @ one.velocity - free @ multipliers @ two.rates / length))


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
    pairs = [(one, two, _between(one, two)) for one, two in itertools.combinations(contacts, 2) if one.body == two.body]
    joints = itertools.product(contacts, _joints(model))
    for one, two, line in (*pairs, *((one, two, _against(one, two)) for one, two in joints if one.body == two.body)):
        if line and one.exerts(line.direction) and line.approach > float(memory[owners.Tolerance.velocity]):
            name = model.system.names.bodies[one.body]
            return (
                f"The body {name!r} is squeezed between driven ones: the {one.name} and the {two.name} press on it "
                f"along one line, and approach each other at {line.approach:.3g} m/s. No rigid contact allows that. "
                "Give these contacts a compliant normal law, or the driven bodies another motion."
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


def _contact(model: LaidOut, index: int) -> list[_Touch]:
    """The active contact of an index, if it is closed, and between a free and a driven body; else nothing.

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
    # the normal of a contact is from its first body to its second, this one into the free body
    normal = (1.0 if is_second else -1.0) * block[blocks.NORMAL : blocks.NORMAL + 3]
    return [_Touch(str(contact), body, point, velocity, normal, contact.friction)]


def _joints(model: LaidOut) -> Iterator[_Hold]:
    """The joints between a free and a driven body."""
    memory = model.memory
    for number, joint in enumerate(joints_in_order(model.system)):
        found = _free_body(model, joint.first, joint.second)
        count, start = (int(memory[one][number]) for one in (owners.JointRecord.n_rows, owners.JointRecord.out))
        rows = memory.floats[start : start + blocks.JOINT_ROW * count].reshape(count, blocks.JOINT_ROW)
        if found is None or count == 0:
            continue
        body, is_second = found
        at = blocks.POINT_B if is_second else blocks.POINT_A
        forces = rows[:, blocks.AXIS : blocks.AXIS + 3].copy()
        moments = np.cross(rows[:, at : at + 3], forces) + rows[:, blocks.MOMENT : blocks.MOMENT + 3]
        place = memory[owners.JointRecord.frame_a if is_second else owners.JointRecord.frame_b][number]
        frame = memory.floats[int(place) :]
        position, velocity, spin = (frame[one : one + 3] for one in (blocks.POSITION, blocks.VELOCITY, blocks.SPIN))
        # power of a force and its moment about the origin: the body-fixed point there moves, too
        rates = forces @ (velocity - np.cross(spin, position)) + moments @ spin
        yield _Hold(str(joint), body, forces, moments, rates)
