"""Checks of a start: no bodies overlap, joints are closed, energies and guards have finite values.

The engine assumes all of this. Without the checks a wrong start would end as a failed run that names no cause.
"""

from __future__ import annotations

import math

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import AXIS, JOINT_ROW
from nonsmooth.engine.numerics.tolerances import GAP, RELATIVE_GAP, RELATIVE_VELOCITY, VELOCITY
from nonsmooth.errors import InvalidInput, PluginError
from nonsmooth.interfaces import CompliantNormalLaw
from nonsmooth.interfaces.body import Vector
from nonsmooth.interfaces.guard import guard_value
from nonsmooth.model.blocks import block_overrun
from nonsmooth.model.immobile import REMEDY, held_by, immobile_contact
from nonsmooth.model.laid_out import LaidOut, energies
from nonsmooth.model.laying import articulations
from nonsmooth.model.overlaps import at_default, check_overlaps, frames_of
from nonsmooth.model.scales import scales_of
from nonsmooth.solids.measure import touching
from nonsmooth.system.contact import Tie
from nonsmooth.system.system import System

_OPEN = 1e-9
"""Largest residual or rate of a closed joint, relative to the largest coordinate or velocity, which is taken as at
least 1 (SI). A start is rounded to about this part. Displacements of small bodies have a smaller limit."""


def check_start(model: LaidOut) -> None:
    """Check the start that the memory holds.

    Raises
    ------
    InvalidInput
        If bodies overlap, a joint is open or opens, joints prevent a contact from moving along its normal, or an energy
        or a guard has no finite value.
    PluginError
        If a function writes past its block.
    """
    # evaluates bodies and contacts for all checks
    gaps = model.gaps()
    # first: all numbers may be wrong if a function has written past its block
    if overrun := block_overrun(model):
        raise PluginError(overrun[0].upper() + overrun[1:])
    _check_energy(model)
    _check_gaps(model, gaps)
    # bodies that overlap deeply may have no features that face each other, and then no gap
    check_overlaps(model)
    _check_joints(model)
    _check_mobility(model)
    t, y = float(model.memory[owners.Island.time]), model.memory[owners.Island.y][: model.n_q + model.n_u]
    check_guards(model.system, t, y[: model.n_q], y[model.n_q :])


def _check_gaps(model: LaidOut, gaps: Vector) -> None:
    """Check that no gap of a rigid contact is negative. That of a compliant contact only must not be NaN.

    The error of a gap is allowed. A support function of a shape that fails gives a better message than the wrong gap
    that follows, so the shapes are tested before.
    """
    # this finds NaN, too
    for number in np.flatnonzero(~(gaps >= 0.0)).tolist():
        contact, gap = model.system.contacts[number], float(gaps[number])
        is_compliant = isinstance(contact.normal, CompliantNormalLaw)
        if not gap >= (-math.inf if is_compliant else -touching(contact.size)):
            _check_shapes(model, number)
            raise InvalidInput(
                f"start of the {contact}",
                "must not overlap: its gap must be >= 0 [m]",
                gap,
                f"Place the bodies apart or touching, by System.place.{at_default(model, contact)}",
            )


def _check_energy(model: LaidOut) -> None:
    """Check that both energies are finite. Too large coordinates or velocities of a start make them infinite."""
    found = energies(model.system.bodies, model.memory[owners.BodyRecord.tail], model.memory.floats)
    for what, value in zip(("kinetic", "potential"), found, strict=True):
        if not math.isfinite(value):
            thing, rule = f"start: the {what} energy", "must be finite [J]"
            raise InvalidInput(thing, rule, value, "Place the bodies nearer to the origin, or let them move slower.")


def _check_shapes(model: LaidOut, number: int) -> None:
    """Evaluate support points of both shapes of a contact, so that a wrong support function raises its own error.

    A support point is the farthest one along a direction. The directions are the axes of both frames and the line
    between their origins, both ways.
    """
    (origin_a, axes_a), (origin_b, axes_b) = ((one[:3], one[3:].reshape(3, 3)) for one in frames_of(model, number))
    directions = np.array([*axes_a.T, *axes_b.T, origin_b - origin_a])
    # no direction leads from an origin to the same point
    directions = directions[np.any(directions, axis=1)]
    for shape, axes in zip(model.system.contacts[number].shapes, (axes_a, axes_b), strict=True):
        if shape.solid is not None:
            for direction in (*directions, *-directions):
                # in axes of the frame, which are the columns
                shape.solid.support(direction @ axes)


def _check_joints(model: LaidOut) -> None:
    """Check that each row of each joint is closed at the start: residual and rate are zero, up to round-off.

    A row is a scalar condition of the joint.
    """
    if not model.system.joints:
        return
    memory = model.memory
    # round-off is relative to the largest coordinate or velocity
    scale = max(1.0, float(np.max(np.abs(memory[owners.Island.y][: model.n_q + model.n_u]), initial=0.0)))
    # in the order in which the memory has the joints
    ties = [(i, tie) for i, articulation in enumerate(articulations(model.system)) for tie in articulation.joints]
    # small and slow bodies have smaller tolerances of displacements
    sizes = scales_of(model.system)
    small = min(1.0, RELATIVE_GAP / GAP * sizes.length), min(1.0, RELATIVE_VELOCITY / VELOCITY * sizes.speed)
    for number, (articulation, tie) in enumerate(ties):
        _check_joint(model, tie, number, articulation, _OPEN * scale, small)


def _check_joint(
    model: LaidOut, tie: Tie, number: int, articulation: int, allowed: float, small: tuple[float, float]
) -> None:
    """Check that residual and rate of each row of a joint are at most ``allowed`` [m, m/s, rad or rad/s].

    ``number`` and ``articulation`` are the numbers of the joint and of its group of tied bodies in the memory.
    ``small`` has the factors by which residual and rate of a displacement must be smaller.
    """
    memory = model.memory
    rows, first, out = (
        int(memory[one][number])
        for one in (owners.JointRecord.n_rows, owners.JointRecord.first_row, owners.JointRecord.out)
    )
    # a row of a displacement has an axis, one of a rotation has none
    axes = memory.floats[out:][: JOINT_ROW * rows].reshape(rows, JOINT_ROW)[:, AXIS : AXIS + 3]
    displaces = np.any(axes != 0.0, axis=1)
    for what, unit, place, factor in (
        ("residual", "m or rad", owners.Articulation.residual, small[0]),
        ("rate", "m/s or rad/s", owners.Articulation.rate, small[1]),
    ):
        # the rows of all joints of an articulation follow each other
        values = memory.floats[int(memory[place][articulation]) + first :][:rows]
        # this finds NaN, too
        if not np.all(np.abs(values) <= np.where(displaces, factor * allowed, allowed)):
            raise InvalidInput(
                f"start of the {tie}",
                f"must have the {what} 0 [{unit}] in each of its rows",
                values.tolist(),
                _remedy_of_joint(model, tie, what),
            )


def _remedy_of_joint(model: LaidOut, tie: Tie, what: str) -> str:
    """Remedy for a joint that is open at the start ("residual"), or whose joined points separate ("rate")."""
    contradiction = "Joints that contradict each other cannot all be closed."
    if what == "residual":
        return f"Place the bodies where the joint is closed. {contradiction}"
    remedy = (
        "A body that turns about the joint needs velocity [m/s, world axes] and angular_velocity [rad/s, body axes] in "
        "System.place: the joined points must have the same velocity."
    )
    driven = next((body for body in (tie.first, tie.second) if body.n_u == 0), None)
    if driven is not None:
        name = model.system.name_of(driven)
        remedy += f" If {name!r} moves at the start, give the other body its velocity or let its motion begin at rest."
    return f"{remedy} {contradiction}"


def _check_mobility(model: LaidOut) -> None:
    """Check that each touching rigid contact can move along its normal. Else no motion determines its force."""
    found = immobile_contact(model)
    if found is not None:
        raise InvalidInput(
            f"start of the {found.contact}",
            "must have some effective inverse mass along its normal, relative to that without joints",
            found.ratio,
            f"Its force is not determined, as {held_by(found.joints)}. {REMEDY}",
        )


def check_guards(system: System, t: float, q: Vector, u: Vector) -> None:
    """Check that the guards of the user have finite values at a time [s], for coordinates q and velocities u.

    Raises
    ------
    InvalidInput
        If one has no finite value.
    """
    for watched in system.watched:
        guard = watched.guard
        value = guard_value(guard, t, q, u)
        # a function of the user may return anything, None or an array as well
        if not isinstance(value, float) or not math.isfinite(value):
            raise InvalidInput(
                f"{watched}: {type(guard).__name__}.value",
                "must return a finite number at the start",
                value,
                f"Call {guard.value.__qualname__} with t = {t:g} and the q and u of the start.",
            )
