"""What must hold at the start: nothing overlaps, every joint is closed, every guard has a value."""

from __future__ import annotations

import math

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.errors import InvalidInput, PluginError
from nonsmooth.interfaces import CompliantNormalLaw
from nonsmooth.interfaces.body import Vector
from nonsmooth.interfaces.guard import guard_value
from nonsmooth.model.articulations import articulations
from nonsmooth.model.block_ends import BlockEnds
from nonsmooth.model.blocks import block_overrun
from nonsmooth.model.immobile import REMEDY, held_by, immobile_contact
from nonsmooth.model.laid_out import LaidOut, energies
from nonsmooth.model.overlaps import check_overlaps, frames_of, overlap_allowed
from nonsmooth.system.contact import Tie
from nonsmooth.system.system import System

_OPEN = 1e-9


def check_start(model: LaidOut, ends: BlockEnds) -> None:
    """Look at gaps and joints at the start; ``ends`` are those of its blocks.

    Raises
    ------
    InvalidInput
        If bodies overlap, a shape has no farthest point, a joint is open or opening, joints hold a contact along its
        normal, or a guard has no finite value.
    PluginError
        If a function writes past its block.
    """
    gaps = model.gaps()
    past = block_overrun(model, ends)
    if past:
        raise PluginError(past[0].upper() + past[1:])
    _check_energy(model)
    contacts = model.system.contacts
    for number in np.flatnonzero(~(gaps >= 0.0)).tolist():
        contact, gap = contacts[number], float(gaps[number])
        compliant = isinstance(contact.normal, CompliantNormalLaw)
        if not gap >= (-math.inf if compliant else -overlap_allowed(contact)):
            _ask_shapes(model, number)
            raise InvalidInput(
                f"start of the {contact}",
                "must not overlap: its gap must be >= 0 [m]",
                gap,
                "Place the bodies apart or touching, by System.place.",
            )
    # gaps tell of features that face each other, and bodies right through one another may have none
    check_overlaps(model)
    _check_joints(model)
    _check_mobility(model)
    t, y = float(model.memory[owners.Island.time]), model.memory[owners.Island.y][: model.n_q + model.n_u]
    check_guards(model.system, t, y[: model.n_q], y[model.n_q :])


def _check_energy(model: LaidOut) -> None:
    """Raise InvalidInput if numbers of a start are so large that an energy has no finite value."""
    bodies = model.system.bodies
    found = energies(bodies, model.memory[owners.Body.tail][: len(bodies)], model.memory.floats)
    for what, value in zip(("kinetic", "potential"), found, strict=True):
        if not math.isfinite(value):
            thing, rule = f"start: the {what} energy", "must be finite [J]"
            raise InvalidInput(thing, rule, value, "Place the bodies nearer to the origin, or let them move slower.")


def _ask_shapes(model: LaidOut, number: int) -> None:
    """Ask the shapes of a contact for points along each other's axes: one whose function is wrong there says so."""
    (p, a), (q, b) = ((frame[:3], frame[3:].reshape(3, 3)) for frame in frames_of(model, number))
    ways = np.array([*a.T, *b.T, q - p])
    ways = ways[np.any(ways, axis=1)]
    for shape, axes in zip(model.system.contacts[number].shapes, (a, b), strict=True):
        if shape.solid is not None:
            for way in (*ways, *-ways):
                shape.solid.support(way @ axes)


def _check_joints(model: LaidOut) -> None:
    """Look at residual and rate of every row of every joint."""
    if not model.system.joints:
        return
    memory = model.memory
    # speeds of a joint are judged by those of its bodies
    scale = max(1.0, float(np.max(np.abs(memory[owners.Island.y][: model.n_q + model.n_u]), initial=0.0)))
    number = 0
    for index, articulation in enumerate(articulations(model.system)):
        for tie in articulation.joints:
            _check_joint(model, tie, number, index, _OPEN * scale)
            number += 1


def _check_joint(model: LaidOut, tie: Tie, number: int, articulation: int, allowed: float) -> None:
    memory = model.memory
    rows = int(memory[owners.Joint.n_rows][number])
    first = int(memory[owners.Joint.first_row][number])
    for what, unit, place in (
        ("residual", "m or rad", owners.Articulation.residual),
        ("rate", "m/s or rad/s", owners.Articulation.rate),
    ):
        start = int(memory[place][articulation]) + first
        values = memory.floats[start : start + rows]
        if not float(np.max(np.abs(values))) <= allowed:
            raise InvalidInput(
                f"start of the {tie}",
                f"must have the {what} 0 [{unit}] in each of its rows",
                values.tolist(),
                _remedy_of_joint(model, tie, what),
            )


def _remedy_of_joint(model: LaidOut, tie: Tie, what: str) -> str:
    """Return what to do about a joint that is open at the start, or opens there as a driven body moves."""
    remedy = "Place the bodies where the joint is closed; joints that contradict each other cannot all be."
    for body in (tie.first, tie.second):
        if what == "rate" and body.n_u == 0:
            name = model.system.name_of(body)
            return (
                f"If {name!r} moves there, give the other body its velocity or let its motion begin at rest. {remedy}"
            )
    return remedy


def _check_mobility(model: LaidOut) -> None:
    """Raise InvalidInput if a rigid contact touches whose gap no force can change."""
    found = immobile_contact(model)
    if found is not None:
        contact, joints, mobility = found
        raise InvalidInput(
            f"start of the {contact}",
            "must have some mobility along its normal, over that without joints",
            mobility,
            f"Its force is not determined, as {held_by(joints)}. {REMEDY}",
        )


def check_guards(system: System, t: float, q: Vector, u: Vector) -> None:
    """Look at the guards of a system at a time [s], for its coordinates and velocities.

    Raises
    ------
    InvalidInput
        If one has no finite value.
    """
    for watched in system.watched:
        guard = watched.guard
        value = guard_value(guard, t, q, u)
        if not isinstance(value, float) or not math.isfinite(value):
            raise InvalidInput(
                f"{watched}: {type(guard).__name__}.value",
                "must return a finite number at the start",
                value,
                f"Look at {guard.value.__qualname__} with t = {t:g} and the q and u of the start.",
            )
