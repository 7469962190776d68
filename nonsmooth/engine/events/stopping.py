"""Slips that stop within an implicit step: the instant at which a slip stops is an event.

An implicit step keeps a slip at zero that reached zero within it. So the step does not show when the slip stopped. The
time is predicted from the deceleration at the start of the step, and the step is cut there. If an explicit step is
possible over the last part, it goes beyond the predicted time and the slip guard locates the stop. Otherwise implicit
steps approach the stop, and the last one ends there.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.kinematics import row
from nonsmooth.engine.flow.guard_numbers import friction_of
from nonsmooth.engine.flow.step import LARGEST_EXPLICIT
from nonsmooth.engine.memory.layout import FIRST_ROW, SECOND_ROW
from nonsmooth.engine.memory.modes import NO_CONTACT, Mode
from nonsmooth.engine.native.kernel import ContactRecord, Workspace, kernel
from nonsmooth.engine.numerics.tolerances import NEGLIGIBLE
from nonsmooth.engine.numerics.vectors import length

_EXPLICIT_PART = 1.5
"""Length of an explicit step relative to the predicted time of a stop: it passes the stop, which is then located."""
_IMPLICIT_PART = 0.98
"""Length of an implicit step relative to the predicted time of a stop. The slip must not stop within it."""
_SMALLEST_PART = 1e-3
"""Smallest part of a step that is taken. A part that differs from 1 by less makes the step end at the stop."""
_LARGEST_PART = 0.9
"""Largest part of a step that is taken if the step must become shorter."""
_UNKNOWN_PART = 0.25
"""Part of a step that is taken if no stop is predicted, because the slip does not decelerate at the start."""


@kernel("f8(ws, ContactRecord, f8)")
def _part_before_stop_of(ws: Workspace, contact: ContactRecord, h: float) -> float:
    """Part of the implicit step of ``h`` [s] to take, so that it ends at or before the stop of a slip.

    The stop is predicted from slip and slip acceleration at the start. If the slip stops at the end of the step, the
    part is 1, and the contact becomes ``halting_contact``.
    """
    # the end of the last step is the start of this one
    c, speed = contact.index, length(contact.slip_at_end)
    v1, v2 = contact.slip_at_end
    du = ws.island.slopes.start + ws.model.n_q
    a1, a2 = row(ws, c, FIRST_ROW, du) + contact.bias[1], row(ws, c, SECOND_ROW, du) + contact.bias[2]
    # predicted decrease of the speed over the step [m/s]
    decrease = -h * (v1 * a1 + v2 * a2) / speed
    # the shortest part is two time tolerances long
    part, least = _UNKNOWN_PART, 2.0 * ws.tolerance.time
    if decrease > 0.0:
        part = speed / decrease
        # relaxation: fastest rate of a slip direction [1/s], which limits explicit steps
        # an explicit step may reach the stop; an implicit one that passes it is taken again, shorter
        if _EXPLICIT_PART * part * h * ws.step.relaxation <= LARGEST_EXPLICIT:
            part *= _EXPLICIT_PART
        elif speed > ws.tolerance.velocity:
            # only a slip within the velocity tolerance may stop in an implicit step, at its end
            part *= _IMPLICIT_PART
        elif abs(part - 1.0) * h <= _SMALLEST_PART * h + least:
            ws.step.halting_contact = c
            return 1.0
    return float(max(_SMALLEST_PART, least / h, min(_LARGEST_PART, part)))


@kernel("f8(ws, f8)")
def part_before_stop(ws: Workspace, h: float) -> float:
    """Part of an implicit step of ``h`` [s] to take, 1 if no slip stops before its end.

    A contact whose slip stops at the end of the step is written to ``halting_contact``.
    """
    part, negligible = 1.0, NEGLIGIBLE * ws.tolerance.velocity
    for contact in ws.contacts:
        # friction that stops a slip sets it to exactly zero
        if not _has_coulomb_slip(contact) or contact.slip != (0.0, 0.0):
            continue
        # the slip at the end of the last step is the one at the start of this step
        if length(contact.slip_at_end) > negligible:
            part = min(part, _part_before_stop_of(ws, contact, h))
        else:
            # it had stopped before this step, up to round-off
            ws.step.halting_contact = contact.index
    return part


@kernel("b1(ContactRecord)")
def _has_coulomb_slip(contact: ContactRecord) -> bool:
    """True if a contact slides with friction that may stop it: by Coulomb's law, with instantaneous forces."""
    return contact.mode == Mode.SLIDE and not contact.has_traction_law and not contact.is_averaged


@kernel("i8(ws)")
def stopped_contact(ws: Workspace) -> int:
    """Contact whose slip has stopped at the end of a step, or ``NO_CONTACT``.

    If no implicit step is possible, it is a contact that slows down within the velocity tolerance. The direction of so
    slow a slip is stiff, and what is left of it is within the tolerance.
    """
    # the relaxation rate of slip directions is 0 if no implicit step is possible
    if ws.step.relaxation > 0.0:
        return int(ws.step.halting_contact)
    for contact in ws.contacts:
        if _has_coulomb_slip(contact):
            speed = length(contact.slip_at_end)
            # the friction guard of a sliding contact is its slip
            if speed <= ws.tolerance.velocity and speed < friction_of(ws, contact).initial:
                return contact.index
    return NO_CONTACT
