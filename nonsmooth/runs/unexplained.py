"""After a run that failed its own checks: what was found where, and what would have been explained."""

from __future__ import annotations

from nonsmooth.binding.source import described
from nonsmooth.engine.memory.modes import (
    GAP_UNDECIDED,
    GAP_UNEXPLAINED,
    MOTION_UNEXPLAINED,
    PASSED,
    QUATERNION_UNEXPLAINED,
)
from nonsmooth.model.laid_out import LaidOut

_REMEDY = "`nonsmooth check` looks at it by itself; if it comes with nonsmooth, the poses before are a bug to report."


def unexplained(model: LaidOut, status: int) -> str:
    """Return a sentence that names the contact or body and the figure that the run stumbled over; "" if it is none."""
    scalars = model.memory.scalars[0]
    found, allowed, number = float(scalars["found"]), float(scalars["allowed"]), int(scalars["blamed"])
    if status == GAP_UNEXPLAINED:
        n = int(scalars["n_contacts"])
        contact = model.system.contacts[int(model.memory.array("identity", n)[number])]
        return (
            f"The {contact}: the gap is {found:.3g} m, of which tolerances explain {allowed:.3g} m.  It jumps in "
            f"{described(contact.kinematics.evaluator)}, or contacts that contradict each other are closed. {_REMEDY}"
        )
    if status == PASSED:
        contact, names = model.system.contacts[number], model.system.names.bodies
        first, second = (names[model.system.bodies.index(body)] for body in (contact.first, contact.second))
        return (
            f"The bodies {first!r} and {second!r} of the {contact} overlap by {-found:.3g} m, of which their closed "
            f"contacts explain {-allowed:.3g} m. Their features missed each other: turn or shift one of them by a "
            "thousandth of its size, give it feet or a rounding, or take shorter steps, EventDriven(largest_step=...)."
        )
    if status == GAP_UNDECIDED:
        n = int(scalars["n_contacts"])
        contact = model.system.contacts[int(model.memory.array("identity", n)[number])]
        return (
            f"The {contact}: its gap is {found:.3g} m and hardly changes within a step of {float(scalars['h']):.3g} s. "
            "Place the bodies farther apart or in contact, or take a smaller tolerance: EventDriven(tolerance=...)."
        )
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
        f"explain {allowed:.3g}: {described(body.evaluator)} turns it at rates that do not keep its length. {_REMEDY}"
    )
