"""Modes and forces at an instant.

Modes are guessed from the past and from the event. Modes and forces are solved for island by island. Then all contacts
adopt their modes at once.
"""

from __future__ import annotations

import math
from enum import IntEnum

from nonsmooth.engine.bodies.anisotropy import turn_facing
from nonsmooth.engine.bodies.compliance import accelerate_by_compliance, has_known_friction, start_inner_states
from nonsmooth.engine.bodies.courses import has_own_step
from nonsmooth.engine.contact.problem import accelerate, accelerate_touching, solve_contact, write_contact_problem
from nonsmooth.engine.contact.trial import NO_FORCE, small_force, tangential_inverse_mass
from nonsmooth.engine.delassus.islands import activate_group, group_members
from nonsmooth.engine.events.averaging import agree_on_averaged_modes, stays_averaged
from nonsmooth.engine.events.record import mode_code
from nonsmooth.engine.flow.guard_numbers import normal_guard
from nonsmooth.engine.memory.modes import Cause, Mode
from nonsmooth.engine.native.kernel import ContactRecord, Workspace, kernel, result
from nonsmooth.engine.numerics.vectors import length


@result
class ContactSolution(IntEnum):
    """Outcome of the contact problem of an instant."""

    NONE = 0
    """The problem of an island has no solution. The contacts of that island stay the active ones."""
    FOUND = 1
    """Every island has modes and forces."""
    FACING_TURNED = 2
    """Anisotropic friction opposes the other direction than was assumed, so its bound is another one."""


@kernel("void(ws, Cause, i8)")
def guess_modes(ws: Workspace, cause: Cause, which: int) -> None:
    """Group the contacts that touch and do not separate, and guess their modes from the past and from the event.

    ``which`` is the contact of the event, with its ``cause``. The guesses are ``mode_agreed``; contacts keep their
    modes until solutions are adopted. A contact outside of the problem is to be open, or keeps its mode if its body has
    an own step (multirate).
    """
    for contact in ws.contacts:
        contact.is_in_problem = False
        contact.mode_agreed = contact.mode if has_own_step(ws, contact.index) else Mode.OPEN
        if contact.is_compliant:
            _guess_compliant_mode(ws, contact, cause, which)
        # forces of the time-stepping fallback may leave a gap rate, and continue in spite of it
        elif contact.is_touching and (contact.normal_rate <= ws.tolerance.velocity or contact.is_averaged):
            contact.is_in_problem = True
            contact.mode_agreed = _guessed_mode(ws, contact, cause, which)
    group_members(ws)


@kernel("Mode(ws, ContactRecord, Cause, i8)")
def _guessed_mode(ws: Workspace, contact: ContactRecord, cause: Cause, which: int) -> Mode:
    """Guess of the mode of a rigid contact that touches and does not separate, at an event of contact ``which``."""
    is_cause = contact.index == which
    if cause == Cause.STICK_TO_SLIP and (is_cause or _share_a_bound(ws, contact, which)):
        return Mode.SLIDE
    if cause == Cause.LIFT_OFF and (is_cause or _force_has_vanished(ws, contact)):
        return Mode.OPEN
    # an open contact closes if it is the cause, or at the start of a run; a jam stops a slip, and closes nothing
    may_have_closed = (is_cause and cause != Cause.JAM) or cause == Cause.START
    if contact.mode == Mode.OPEN and not may_have_closed:
        return Mode.OPEN
    return Mode.SLIDE if length(contact.slip) > ws.tolerance.velocity else Mode.STICK


@kernel("void(ws, ContactRecord, Cause, i8)")
def _guess_compliant_mode(ws: Workspace, contact: ContactRecord, cause: Cause, which: int) -> None:
    """Guess the mode of a compliant contact at an event of contact ``which``, and whether its friction is unknown.

    Its normal force is known. A contact with a traction law has a known friction, too, and always slides. A contact
    that does not touch keeps the guess of the caller: open; or its mode, if its body has an own step (multirate), which
    this event does not interrupt.
    """
    is_cause = contact.index == which
    # its guard has fired, so that it opens: its gap is at the limit up to round-off
    if cause == Cause.LIFT_OFF and is_cause:
        contact.is_touching = False
    if not contact.is_touching:
        return
    speed = length(contact.slip)
    slips = speed > ws.tolerance.velocity
    breaks_away = cause == Cause.STICK_TO_SLIP and (is_cause or _share_a_bound(ws, contact, which))
    slides = slips or contact.has_traction_law or breaks_away
    contact.mode_agreed = Mode.SLIDE if slides else Mode.STICK
    contact.is_in_problem = not has_known_friction(ws, contact.index)
    contact.direction_agreed = contact.direction
    if slips:
        contact.direction_agreed = contact.slip[0] / speed, contact.slip[1] / speed


@kernel("b1(ws, ContactRecord)")
def _force_has_vanished(ws: Workspace, contact: ContactRecord) -> bool:
    """True if the normal force of a closed rigid contact is round-off, as is that of the contact which lifts off.

    Then both lift off together.
    """
    largest = 0.0
    # the normal guard of a closed rigid contact is its force; initial is its value at the start of the step
    for other in ws.contacts:
        if other.mode != Mode.OPEN and not other.is_compliant and not has_own_step(ws, other.index):
            largest = max(largest, ws.guards[normal_guard(other.index)].initial)
    is_small = ws.guards[normal_guard(contact.index)].value <= NO_FORCE * largest
    return not contact.is_compliant and contact.mode != Mode.OPEN and is_small


@kernel("b1(ws, ContactRecord, i8)")
def _share_a_bound(ws: Workspace, contact: ContactRecord, which: int) -> bool:
    """True if the forces of a contact and of contact ``which`` are both redundant, so that they break away together."""
    # the sum of redundant friction obeys the sum of the bounds
    return contact.has_redundant_force and ws.contacts[which].has_redundant_force


@kernel("ContactSolution(ws, b1)")
def solve_islands(ws: Workspace, averaging_ends: bool) -> ContactSolution:
    """Find modes and forces of the grouped contacts, island by island: instantaneous, or averaged over time.

    ``averaging_ends`` is true at the end of a span of averaged forces, where instantaneous ones are tried again.
    """
    accelerate_touching(ws)
    accelerate_by_compliance(ws)
    # islands that stay averaged set the end of their span again
    ws.island.averaged_until = math.inf
    has_turned = False
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        if stays_averaged(ws, averaging_ends):
            # a span of this island that ends here is followed by another one
            agree_on_averaged_modes(ws, averaging_ends)
            accelerate(ws)
            continue
        _use_guessed_modes(ws)
        write_contact_problem(ws)
        if not solve_contact(ws):
            return ContactSolution.NONE
        accelerate(ws)
        has_turned = _take_solution(ws) or has_turned
    return ContactSolution.FACING_TURNED if has_turned else ContactSolution.FOUND


@kernel()
def _use_guessed_modes(ws: Workspace) -> None:
    """Start the solver of the active contacts from the guessed modes, and end their averaging over time."""
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        # if the instantaneous forces fail soon after this attempt, the next one comes later
        if contact.is_averaged:
            contact.mean_forces_asked = ws.island.time
        contact.mode_after_averaging, active.mode_tried = Mode.OPEN, contact.mode_agreed


@kernel("b1(ws)")
def _take_solution(ws: Workspace) -> bool:
    """Store what the solver found for the active contacts. True if anisotropic friction faces the other way now.

    Later steps need the threshold of force and the inverse mass that are stored here. Modes and directions are adopted
    later, by :func:`adopt_modes`.
    """
    has_turned = False
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        contact.force_round_off = small_force(ws, active.index)
        contact.slip_per_force = tangential_inverse_mass(ws, active)
        contact.mode_agreed = active.mode_tried
        contact.direction_agreed = active.direction
        # the friction of a contact at rest may oppose the other direction of slip, which has another coefficient
        if active.is_at_rest and active.mode_tried != Mode.OPEN:
            has_turned = turn_facing(ws, contact.index, active.force[1]) or has_turned
    return has_turned


@kernel("b1(ws)")
def coefficients_are_valid(ws: Workspace) -> bool:
    """True if the friction coefficients of the active contacts, which the user's laws gave, are positive or zero.

    A problem without a solution may be the fault of a law.
    """
    for active in ws.actives:
        if not (active.friction_coefficient >= 0.0 and active.static_coefficient >= 0.0):
            return False
    return True


@kernel()
def adopt_modes(ws: Workspace) -> None:
    """Give all contacts the modes and slip directions found for them. The laws of a contact that closes start anew."""
    for contact in ws.contacts:
        if contact.mode == Mode.OPEN and contact.mode_agreed != Mode.OPEN:
            start_inner_states(ws, contact.index)
        contact.mode = contact.mode_agreed
        # OPEN also marks that forces are not averaged over time
        if contact.mode == Mode.OPEN:
            contact.mode_after_averaging = Mode.OPEN
        if contact.mode == Mode.SLIDE:
            contact.direction = contact.direction_agreed


@kernel("b1(ws)")
def modes_have_changed(ws: Workspace) -> bool:
    """True if a contact has another mode than before the event, or its averaging over time has begun or ended.

    If not, the event need not be recorded.
    """
    for contact in ws.contacts:
        if mode_code(contact) != contact.code_before or contact.is_averaged != contact.was_averaged:
            return True
    return False
