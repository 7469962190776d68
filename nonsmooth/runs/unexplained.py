"""After a run that failed its own checks: what was found where, and what would have been explained."""

from __future__ import annotations

import numpy as np

from nonsmooth.binding.source import described
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.modes import (
    GAP_UNDECIDED,
    GAP_UNEXPLAINED,
    JOINTS_APART,
    MOTION_UNEXPLAINED,
    OPEN,
    PASSED,
    QUATERNION_UNEXPLAINED,
)
from nonsmooth.model.immobile import inverse_mass
from nonsmooth.model.laid_out import LaidOut

_CHECK = "`nonsmooth check` looks at it by itself."
_SHIFT = "Shift or turn a body a little, or give it rounded edges."
"""For a pair of features whose gap has a jump where they are just so, as features in line have."""
_ILL_CONDITIONED = 1e11
"""Ratio of inertias of joined bodies above which the lightest one is named."""
_ENOUGH = 1e-8
"""Part of the largest inertia that the lightest one may have: motions change by about as much, and runs are fast."""
_PRESSED = (
    "Let it be compliant, by a normal law such as LinearCompliant, or leave out a contact that holds the same body."
)
"""For contacts of which one holds a body still that another one moves."""


def unexplained(model: LaidOut, status: int) -> str:
    """Return a sentence that names the contact or body and the figure that the run stumbled over; "" if it is none."""
    found, allowed, number = (
        model.memory[owners.Run.found],
        model.memory[owners.Run.allowed],
        model.memory[owners.Run.failed_number],
    )
    if status == GAP_UNEXPLAINED:
        n = model.memory[owners.Island.n_contacts]
        contact = model.system.contacts[int(model.memory[owners.Contact.declared][:n][number])]
        said = f"The {contact}: the gap is {found:.3g} m, of which tolerances explain {allowed:.3g} m."
        if model.memory[owners.Contact.mode][:n][number] != OPEN and (others := _other_holds(model, number)):
            return f"{said} It is closed, and {others} hold its bodies otherwise. {_PRESSED}"
        return f"{said} It jumps in {described(contact.kinematics.evaluator)}. {_CHECK} {_SHIFT}"
    if status == PASSED:
        contact = model.system.contacts[number]
        first, second = map(model.system.name_of, (contact.first, contact.second))
        return (
            f"The bodies {first!r} and {second!r} of the {contact} overlap by {found:.3g} m, of which their closed "
            f"contacts explain {allowed:.3g} m. Their features missed each other: turn or shift one of them by a "
            "thousandth of its size, give it feet or a rounding, or take shorter steps, EventDriven(largest_step=...)."
        )
    if status == GAP_UNDECIDED:
        n = model.memory[owners.Island.n_contacts]
        contact = model.system.contacts[int(model.memory[owners.Contact.declared][:n][number])]
        return (
            f"The {contact}: its gap is {found:.3g} m and hardly changes within a step of "
            f"{model.memory[owners.Step.h]:.3g} s. Place the bodies farther apart or in contact, or "
            "take a smaller tolerance: EventDriven(tolerance=...)."
        )
    if status == JOINTS_APART:
        return f"They are apart by {found:.3g} m or rad, of which tolerances explain {allowed:.3g}.{_light(model)}"
    if status not in (MOTION_UNEXPLAINED, QUATERNION_UNEXPLAINED):
        return ""
    body, name = model.system.bodies[number], model.system.names.bodies[number]
    if status == MOTION_UNEXPLAINED:
        return (
            f"The body {name!r} would have to move by {found:.3g} in one of its coordinates, of which tolerances "
            f"explain {allowed:.3g}: what is closed around it contradicts itself."
        )
    return (
        f"The body {name!r}: the length of its quaternion is off by {found:.3g} after one step, of which tolerances "
        f"explain {allowed:.3g}: {described(body.evaluator)} turns it at rates that do not keep its length. {_CHECK}"
    )


def _light(model: LaidOut) -> str:
    """Return a sentence on the joined body whose inertia is within round-off of the largest one, "" if none is."""
    bodies, joined = model.system.bodies, {id(body) for tie in model.system.joints for body in (tie.first, tie.second)}
    found = [
        (float(value), model.system.names.bodies[number], unit)
        for number, body in enumerate(bodies)
        if id(body) in joined and body.n_u > 0
        for value, (_, unit) in zip(np.diag(inverse_mass(model, number)), body.u_labels, strict=True)
        if np.isfinite(value) and value > 0.0
    ]
    if not found:
        return ""
    most = max(found)
    ratio = most[0] / min(found)[0]
    if ratio < _ILL_CONDITIONED:
        return ""
    what, unit = ("moment of inertia", "kg m^2") if most[2] == "rad/s" else ("mass", "kg")
    return (
        f" The {what} of {most[1]!r}, {1.0 / most[0]:.3g} {unit}, is {1.0 / ratio:.1g} of the largest inertia "
        f"of joined bodies (SI): round-off moves it. Give it {_ENOUGH:g} of the largest: motions change by as little."
    )


def _other_holds(model: LaidOut, number: int) -> str:
    """Return the names of other pairs of bodies in closed contact with a body of the contact of a slot, "" if none."""
    n = int(model.memory[owners.Island.n_contacts])
    modes, identity = model.memory[owners.Contact.mode][:n], model.memory[owners.Contact.declared][:n]
    contact = model.system.contacts[int(identity[number])]
    own = {id(body) for body in (contact.first, contact.second) if body.n_u > 0}
    pairs = dict[tuple[int, int], str]()
    for slot in np.flatnonzero(modes != OPEN).tolist():
        other = model.system.contacts[int(identity[slot])]
        bodies = id(other.first), id(other.second)
        if own & set(bodies) and {*bodies} != {id(contact.first), id(contact.second)}:
            pairs.setdefault(bodies, f"the {other}")
    return ", ".join(pairs.values())
