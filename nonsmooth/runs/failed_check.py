"""Sentences about a run that failed its own checks: the contact or body, the value found and the value allowed."""

from __future__ import annotations

import numpy as np

from nonsmooth.binding.source import described
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.modes import Mode, Status
from nonsmooth.model.immobile import inverse_mass
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.system.contact import Contact

_CHECK = "Run `nonsmooth check` on a kinematics or body of your own; report one of nonsmooth."
_SHIFT = "Shift or turn a body a little, or give it rounded edges."
"""Remedy for a pair of features whose gap jumps in a special pose, such as edges in line."""
_ILL_CONDITIONED = 1e11
"""Ratio of the inertias of joined bodies above which the least is named. Round-off then moves the lightest body."""
_LEAST_INERTIA = 1e-8
"""Least inertia relative to the largest that the message recommends. It changes the motion by about this part."""
_COMPLIANT = "Give it a compliant normal law such as LinearCompliant, or leave out a contact that holds the same body."
"""Remedy for a closed contact that another closed contact contradicts."""


def failed_check(model: LaidOut, status: int) -> str:
    """Sentences about the check that a run failed, by the last status of the engine; "" for a status of no check.

    The engine has stored the value found and the largest value allowed.
    """
    run = owners.Run
    # by the status, the number is that of an active contact, a declared contact or a body
    found, allowed, number = (model.memory[one] for one in (run.found, run.allowed, run.failed_number))
    if status == Status.GAP_UNEXPLAINED:
        return _gap(model, number, found, allowed)
    if status == Status.PASSED:
        return _overlap(model, number, found, allowed)
    if status == Status.GAP_UNDECIDED:
        return (
            f"The {model.system.contacts[model.active[number]]}: its gap is {found:.3g} m and hardly changes within a "
            f"step of {model.memory[owners.Step.h]:.3g} s. Place the bodies farther apart or in contact, or take a "
            "smaller tolerance: EventDriven(tolerance=...)."
        )
    if status == Status.JOINTS_APART:
        return f"They are apart by {found:.3g} m or rad; the tolerances allow {allowed:.3g}.{_lightest(model)}"
    if status not in (Status.MOTION_UNEXPLAINED, Status.QUATERNION_UNEXPLAINED):
        return ""
    body, name = model.system.bodies[number], model.system.names.bodies[number]
    if status == Status.MOTION_UNEXPLAINED:
        return (
            f"The body {name!r} would have to move by {found:.3g} in one of its coordinates; the tolerances "
            f"allow {allowed:.3g}. What is closed around it contradicts itself."
        )
    return (
        f"The body {name!r}: the length of its quaternion is off by {found:.3g} after one step; the tolerances "
        f"allow {allowed:.3g}. The rates that {described(body.evaluator)} gives do not keep its length. {_CHECK}"
    )


def _gap(model: LaidOut, index: int, found: float, allowed: float) -> str:
    """Sentences about an active contact whose gap ``found`` [m] is beyond what the tolerances allow.

    A closed contact may not have a gap, an open one no overlap. Either other closed contacts of its bodies contradict
    it, or its kinematics is not continuous.
    """
    contact = model.system.contacts[model.active[index]]
    text = f"The {contact}: the gap is {found:.3g} m; the tolerances allow {allowed:.3g} m."
    if model.memory[owners.Contact.mode][index] != Mode.OPEN and (others := _other_closed(model, contact)):
        return f"{text} It is closed, and {others} hold its bodies otherwise. {_COMPLIANT}"
    return f"{text} It jumps in {described(contact.kinematics.evaluator)}. {_CHECK} {_SHIFT}"


def _overlap(model: LaidOut, number: int, found: float, allowed: float) -> str:
    """Sentences about the bodies of a declared contact that passed into each other by ``found`` [m]."""
    contact = model.system.contacts[number]
    first, second = map(model.system.name_of, (contact.first, contact.second))
    return (
        f"The bodies {first!r} and {second!r} of the {contact} overlap by {found:.3g} m; their closed "
        f"contacts allow {allowed:.3g} m. Their features missed each other: turn or shift one of them by a "
        "thousandth of its size, give it feet or a rounding, or take shorter steps, EventDriven(largest_step=...)."
    )


def _lightest(model: LaidOut) -> str:
    """Sentences on the joined body whose inertia is least, if round-off of the largest inertia moves it, else "".

    An inertia is a mass [kg] or a moment of inertia [kg m^2], here the inverse of a diagonal entry of the inverse mass
    matrix. Numbers of both kinds are compared, since round-off does not know units. The text follows another sentence.
    """
    bodies, joined = model.system.bodies, {id(body) for tie in model.system.joints for body in (tie.first, tie.second)}
    inverse_inertias = [
        (float(value), model.system.names.bodies[number], unit)
        for number, body in enumerate(bodies)
        if id(body) in joined and body.n_u > 0
        for value, (_, unit) in zip(np.diag(inverse_mass(model, number)), body.u_labels, strict=True)
        if np.isfinite(value) and value > 0.0
    ]
    if not inverse_inertias:
        return ""
    # the least inertia has the largest inverse; the ratio is that of the largest inertia to the least
    inverse, name, unit_of_rate = max(inverse_inertias)
    ratio = inverse / min(inverse_inertias)[0]
    if ratio < _ILL_CONDITIONED:
        return ""
    quantity, unit = ("moment of inertia", "kg m^2") if unit_of_rate == "rad/s" else ("mass", "kg")
    return (
        f" The {quantity} of {name!r}, {1.0 / inverse:.3g} {unit}, is {1.0 / ratio:.1g} of the largest inertia of "
        f"joined bodies (SI): round-off moves it. Give it {_LEAST_INERTIA:g} of the largest; motions change as little."
    )


def _other_closed(model: LaidOut, contact: Contact) -> str:
    """Names of closed contacts that share a free body with a contact, or "".

    Of contacts between the same two bodies the first is named. Those between both bodies of ``contact`` are left out.
    """
    modes = model.memory[owners.Contact.mode][: len(model.active)]
    # a driven body has no velocities, and takes no part in a contradiction
    free = {id(body) for body in (contact.first, contact.second) if body.n_u > 0}
    pairs = dict[tuple[int, int], str]()
    for number in model.active[modes != Mode.OPEN].tolist():
        other = model.system.contacts[number]
        bodies = id(other.first), id(other.second)
        if free & {*bodies} and {*bodies} != {id(contact.first), id(contact.second)}:
            pairs.setdefault(bodies, f"the {other}")
    return ", ".join(pairs.values())
