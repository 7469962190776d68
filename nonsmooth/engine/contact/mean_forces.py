"""The time-stepping fallback: forces of an island that are constant over a contact time.

If events accumulate, or no forces of the instant exist, an island is stepped by Moreau's rule (J. J. Moreau, in
Nonsmooth Mechanics and Applications, Springer (1988) 1-82). With the time T of the step, the rates z0 of the contacts
at its start, and their accelerations b without contact forces, the rates at its end are

    z1 = z0 + T (b + G f),      0 <= z1_n,  0 <= f_n,  one of them zero,

and friction on Coulomb's cone opposes the slip z1_t, or keeps it at zero. This problem always has a solution, while
that of an instant need not. Events within T are not resolved. Nothing is lost by that as long as T is at most a contact
time, because a rigid contact law does not describe what is faster than that. In code, these forces are called mean
forces.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.anisotropy import stretch_along
from nonsmooth.engine.bodies.compliance import decouple_normals
from nonsmooth.engine.bodies.kinematics import row
from nonsmooth.engine.contact.inelastic import inelastic_impulses
from nonsmooth.engine.contact.trial import tangential_inverse_mass
from nonsmooth.engine.delassus.delassus import acceleration, assemble_delassus, slip_acceleration
from nonsmooth.engine.memory.layout import FIRST_ROW, NORMAL_ROW, SECOND_ROW
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Workspace, kernel
from nonsmooth.engine.numerics.vectors import length, unit

_LONGEST = 50.0
"""Maximum time of a step, in contact times, if the steps before were accurate."""
_LEAST_RATE = 0.25
"""Smallest gap rate in the estimate of accuracy, in velocity tolerances. It limits the growth of a step to two."""


# --- the time of a step -----------------------------------------------------------------------------------------------


@kernel("b1(ws)")
def is_averaged(ws: Workspace) -> bool:
    """True if an active contact has a mean force, over the time of a step of the time-stepping fallback."""
    for active in ws.actives:
        if ws.contacts[active.contact].is_averaged:
            return True
    return False


@kernel("f8(ws)")
def averaging_time(ws: Workspace) -> float:
    """Time over which events of the active contacts need not be resolved [s]: their shortest contact time.

    It is 0 if a rigid contact has no contact time, or if all contacts are compliant: forces are then not averaged.
    """
    time = math.inf
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        if not contact.is_compliant:
            time = min(time, contact.contact_time)
    return time if time < math.inf else 0.0


@kernel("b1(ws)")
def has_no_stopping_slip(ws: Workspace) -> bool:
    """True if friction stops no slip of an active contact within a contact time, so that averaging may end.

    A stop within it is an event that averaging leaves out. The speed that friction takes in that time is the contact
    time, times the friction, times the slip acceleration per unit of friction.
    """
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        speed = length(contact.slip)
        friction = length((contact.force[FIRST_ROW], contact.force[SECOND_ROW]))
        is_slow = speed <= contact.contact_time * contact.slip_per_force * friction
        # a contact at rest has no slip to stop
        if is_slow and speed > ws.tolerance.velocity and contact.normal_force > 0.0:
            return False
    return True


@kernel("f8(ws, b1)")
def averaging_span(ws: Workspace, follows: bool) -> float:
    """Time of the next step of the time-stepping fallback [s]: a contact time, unless it ``follows`` another such step.

    Then it is the longest that the accuracy of the last step allows, up to ``_LONGEST`` contact times.
    """
    least = averaging_time(ws)
    if not follows:
        return float(least)
    span = _LONGEST * least
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        # a span of 0 means that its averaging has just begun
        if contact.is_averaged:
            span = min(span, contact.mean_span if contact.mean_span > 0.0 else least)
    return float(span)


@kernel()
def set_spans(ws: Workspace) -> None:
    """Write the time that the next step of each contact may take [s], from the gap rates that the last step has left.

    A gap rate that is left counts as the error of the step. It grows with the square of the time. Up to a contact time,
    a step may in any case be twice as long as the last one, which may have been shortened for other reasons.
    """
    for contact in ws.contacts:
        if contact.is_averaged:
            rate = max(abs(contact.normal_rate), _LEAST_RATE * ws.tolerance.velocity)
            # at this time, the gap rate would be the velocity tolerance
            accurate = contact.mean_span * math.sqrt(ws.tolerance.velocity / rate)
            contact.mean_span = max(accurate, min(2.0 * contact.mean_span, contact.contact_time))


@kernel("void(ws, f8)")
def _store_span(ws: Workspace, span: float) -> None:
    """Store the time of a step [s] as ``mean_span``, for the length of the next one.

    It is halved if a contact ends this step in another mode than the last one, but not below a contact time, within
    which events need not be resolved.
    """
    stored = span
    for active in ws.actives:
        if ws.contacts[active.contact].mode_after_averaging != active.mode_tried:
            stored = max(0.5 * span, min(span, averaging_time(ws)))
    for active in ws.actives:
        # an island has one step
        ws.contacts[active.contact].mean_span = stored


# --- the forces of a step ---------------------------------------------------------------------------------------------


@kernel("f8(ws, f8)")
def find_mean_impulses(ws: Workspace, time: float) -> float:
    """Find the impulses of the active contacts over a ``time`` [N s]. Returns the time over which they were found [s].

    It is ``time``, or a contact time if none are found over a longer one. Impulses that have not settled then are taken
    as they are: those of compliant contacts, which bring in no energy. The check of gaps judges the approach that they
    leave. Before: the rates of the contacts, and in ``du`` the accelerations without contact forces.
    """
    if not _solve(ws, time) and time > averaging_time(ws):
        time = averaging_time(ws)
        _solve(ws, time)
    return time


@kernel("b1(ws, f8)")
def _solve(ws: Workspace, time: float) -> bool:
    """Find the impulses of the active contacts over a ``time`` [N s]. True if they are found.

    The accelerations in ``du`` are those without contact forces. The impulses leave no approach at the end.
    """
    assemble_delassus(ws)
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        # for `has_no_stopping_slip`
        contact.slip_per_force = tangential_inverse_mass(ws, active)
        for r in range(3):
            active.free[r] = contact.bias[r] + row(ws, active.contact, r, ws.island.du.start)
            # the impulses of the last step are the first guess
            active.force[r] = time * contact.mean_force[r] if contact.is_averaged else 0.0
        active.force[1] /= stretch_along(ws, contact)
        # an open gap may close within the step: its rate at the end must be at least -gap / time. The solver multiplies
        # accelerations by the time
        active.free[NORMAL_ROW] += max(0.0, contact.gap) / (time * time)
    # the normal forces of compliant contacts are known
    decouple_normals(ws)
    return inelastic_impulses(ws, time)


@kernel("f8(ws, i8, f8)")
def gap_after(ws: Workspace, a: int, time: float) -> float:
    """Gap of active contact ``a`` after its impulses in a ``time`` [m], with constant Jacobians and accelerations."""
    contact = ws.contacts[ws.actives[a].contact]
    # gap rate at the end plus the open gap / time, which `_solve` has added
    rate = acceleration(ws, ws.actives[a], NORMAL_ROW)
    # the gap changes by the time times the mean of the rates at start and end. Half of what was added is in it, and is
    # subtracted again
    closing = max(0.0, contact.gap)
    return float(contact.gap - 0.5 * closing + 0.5 * time * (contact.normal_rate + rate))


@kernel("void(ws, f8)")
def set_mean_forces(ws: Workspace, time: float) -> None:
    """Spread the impulses of the active contacts over a ``time`` [s] from now on, as mean forces [N].

    Before: ``force`` holds impulses [N s]. Modes and slip directions under trial become those at the end of that time.
    """
    # the first end of a step of any island, at which its forces are found anew
    ws.island.averaged_until = min(ws.island.averaged_until, ws.island.time + time)
    # no deviation from the planned gaps yet
    ws.island.strayed = 0.0
    for active in ws.actives:
        # impulses are the forces here, so that this is the slip at the end
        slip = slip_acceleration(ws, active)
        active.mode_tried = Mode.OPEN
        if active.normal_force > 0.0:
            active.mode_tried = Mode.SLIDE if length(slip) > ws.tolerance.velocity else Mode.STICK
        active.direction = unit(slip)
    _store_span(ws, time)
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        # change that the gap is allowed, as a gap that opens comes to rest only at the end of the step; without
        # averaging before, the old change is out of date
        opening = time * max(0.0, contact.normal_rate)
        contact.mean_gap_change = opening + (contact.mean_gap_change if contact.is_averaged else 0.0)
        contact.mode_after_averaging = active.mode_tried
        contact.mean_gap = contact.gap
        for r in range(3):
            active.force[r] /= time
            contact.mean_force[r] = active.force[r]
        contact.mean_force[1] *= stretch_along(ws, contact)
