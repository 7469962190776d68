"""End of an accumulation of ever shorter bounces (Zeno sequence), Eq. (33): of a single contact, and of an island.

A ball that bounces with a restitution below 1 comes to rest after infinitely many impacts in finite time. The sequence
is cut off as soon as a bounce is shorter than the contact time, because rigid impacts mean nothing in less. The rest of
the sequence is left out: the contact closes, and the small energy that is left counts as closing loss. So the error is
bounded by the physical contact time, not by a numerical tolerance.

A single contact is closed by a projection of its rate. If several contacts of an island touch, their bounces depend on
each other, so the forces of the island are averaged over a contact time instead
(:mod:`nonsmooth.engine.contact.mean_forces`). An approach slower than a contact could reach within one contact time is
stopped by an inelastic impact in place of a collision.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.compliance import accelerate_by_compliance, start_inner_states
from nonsmooth.engine.bodies.courses import has_own_step
from nonsmooth.engine.bodies.kinematics import acceleration_at, motion_of, row
from nonsmooth.engine.bodies.touching import find_touching
from nonsmooth.engine.contact.inelastic import inelastic_impulses
from nonsmooth.engine.contact.mean_forces import averaging_time, is_averaged
from nonsmooth.engine.contact.problem import accelerate_touching, solve_contact
from nonsmooth.engine.delassus.delassus import add_product, add_response, assemble_delassus
from nonsmooth.engine.delassus.islands import activate_group, group_closed, group_touching
from nonsmooth.engine.events.averaging import average_active
from nonsmooth.engine.events.coincident import closed_coincident, replace_coincident
from nonsmooth.engine.events.record import NO_PHASES, begin_event, record_event
from nonsmooth.engine.flow.projection import project_rates
from nonsmooth.engine.memory.event_rows import CLOSING_LOSS, DRIVEN_WORK
from nonsmooth.engine.memory.layout import NORMAL_ROW
from nonsmooth.engine.memory.modes import NO_CONTACT, NO_RELEASE, Cause, Mode, Truncation
from nonsmooth.engine.native.kernel import ContactRecord, Workspace, frame_at, kernel
from nonsmooth.engine.numerics.tolerances import ALLOWED, NEGLIGIBLE
from nonsmooth.engine.numerics.vectors import cross, dot, length, minus

_MOST_HITS = 10
"""Events of a burst up to which bounces of a contact point that runs along its bodies do not accumulate. Then they are
so short that it stays in place, and e^10 of the first rate is left, 1e-3 with e = 0.5."""
_PART_AT_REST = 1.0 - 1e-6
"""Part of an averaging span within which a bounce is short: all contacts come to rest at its end, up to round-off."""


@kernel("void(ws, i8)")
def set_provisional_mode(ws: Workspace, c: int) -> None:
    """Give contact ``c`` the mode that its rates suggest, until the modes of the instant are found.

    A contact that closes starts the inner states of its laws anew.
    """
    contact = ws.contacts[c]
    # the contact of a body with its own step (multirate) takes no part in the event, and keeps its mode
    if has_own_step(ws, c):
        return
    # a compliant contact stays closed while it separates within its reach
    separates = not contact.is_compliant and contact.normal_rate > ws.tolerance.velocity
    # release: the contact could not stay closed, or stick, while its contact point jumped
    if not contact.is_touching or contact.release != NO_RELEASE or separates:
        contact.mode = Mode.OPEN
        return
    if contact.mode == Mode.OPEN:
        start_inner_states(ws, c)
    speed = length(contact.slip)
    contact.mode = Mode.SLIDE if speed > ws.tolerance.velocity else Mode.STICK
    if speed > ws.tolerance.velocity:
        contact.direction = contact.slip[0] / speed, contact.slip[1] / speed


@kernel("b1(ws, i8, f8)")
def _is_short(ws: Workspace, c: int, time: float) -> bool:
    """True if contact ``c`` separates, but turns back within a ``time`` T [s]. Limits ``first_step``, the next step.

    With the rate v and the acceleration -a, the condition is gap + T (v - a T) <= 0: one step of the time-stepping rule
    by which averaged forces are found. The contact closes again after 2 v / a. The next step is at most 1.5 times as
    long, so that it does not miss that.
    """
    contact = ws.contacts[c]
    rate = contact.normal_rate
    acceleration = -(contact.bias[0] + row(ws, c, NORMAL_ROW, ws.island.du.start))
    if rate <= ws.tolerance.velocity or acceleration <= 0.0:
        return False
    ws.island.first_step = min(ws.island.first_step, 3.0 * rate / acceleration)
    acceleration = _approach_of_bodies(ws, contact)
    # a contact that coincides with a closed one is the same contact, and does not bounce
    is_back = (rate - acceleration * time) * time <= -max(0.0, contact.gap)
    return is_back and closed_coincident(ws, c) == NO_CONTACT


@kernel("b1(ws, ContactRecord)")
def _runs(ws: Workspace, contact: ContactRecord) -> bool:
    """True if the contact point moves, and the normal turns, faster than the bodies do there.

    Both have no bound for the sides of two nearly parallel cylinders. A point that slides or rolls is not faster than
    slip and turning together. The normal of a rim over a face turns with the face, however fast the point runs.
    """
    motion, t1, t2 = motion_of(ws, contact), contact.tangent, cross(contact.normal, contact.tangent)
    spin = minus(frame_at(ws.floats, contact.frame_b).spin, frame_at(ws.floats, contact.frame_a).spin)
    size, radius = math.sqrt(dot(spin, spin)), min(contact.support_radius_a, contact.support_radius_b)
    # turning of the normal relative to the first and to the second body
    turning = length((motion.nu1, motion.nu2)), length((motion.nu1 - dot(spin, t2), motion.nu2 + dot(spin, t1)))
    return length((motion.u1, motion.u2)) > length(contact.slip) + size * radius and min(turning[0], turning[1]) > size


@kernel("f8(ws, ContactRecord)")
def _approach_of_bodies(ws: Workspace, contact: ContactRecord) -> float:
    """Acceleration with which a contact approaches without contact forces [m/s^2], which an accumulation needs.

    A contact point that runs along its bodies turns their normal, which adds to the acceleration of the gap. Such
    bounces do not accumulate at first, as the next one is elsewhere. Then at most the acceleration of the bodies at the
    contact point counts.
    """
    by_forces = row(ws, contact.index, NORMAL_ROW, ws.island.du.start)
    approach = -(contact.bias[0] + by_forces)
    if contact.burst_events > _MOST_HITS or not _runs(ws, contact):
        return approach
    fixed = 0.0, 0.0, 0.0
    of_first = acceleration_at(ws.floats, contact.frame_a, contact.point_a, fixed, fixed)
    of_second = acceleration_at(ws.floats, contact.frame_b, contact.point_b, fixed, fixed)
    return min(approach, -(dot(contact.axis_n, minus(of_second, of_first)) + by_forces))


@kernel("i8(ws)")
def end_short_bounces(ws: Workspace) -> int:
    """End the bounces that have become shorter than their contact time. Number of islands in which a bounce ends.

    The last bounce of a single contact is left out. If several contacts touch, the forces of their island are averaged
    over a contact time, so that all come to rest together. If they cannot be averaged, the bounces go on. The contacts
    must have their modes after the event. Bounces limit the next step by ``first_step`` [s], except fast ones of
    several contacts (:func:`_short_bounce`).
    """
    ws.island.first_step = math.inf
    group_touching(ws)
    n_ended = 0
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        which = _short_bounce(ws)
        if which == NO_CONTACT:
            continue
        if ws.problem.n_active == 1:
            _end_bounce(ws, which)
            n_ended += 1
        else:
            # 1 if the forces are averaged from now on
            n_ended += average_active(ws)
    return n_ended


@kernel("i8(ws)")
def _short_bounce(ws: Workspace) -> int:
    """Active contact whose bounce is shorter than the contact time, or ``NO_CONTACT`` (the last one of several).

    Forces that are averaged over a contact time may leave a rate, as long as the gap stays within the allowed one over
    that time. In an island of several contacts a faster bounce is not short.
    """
    # a single contact has no bound of the speed of its bounce
    time, fastest = averaging_time(ws), math.inf
    # the contacts of an averaged island come to rest at the end of the time, up to round-off
    if ws.problem.n_active > 1:
        time *= _PART_AT_REST
        fastest = ALLOWED * ws.tolerance.gap / max(time, ws.tolerance.time)
    which = NO_CONTACT
    for active in ws.actives:
        if ws.contacts[active.contact].normal_rate <= fastest and _is_short(ws, active.contact, time):
            which = active.contact
    return which


@kernel("void(ws, i8)")
def _end_bounce(ws: Workspace, c: int) -> None:
    """Close contact ``c``, the only active one, in place of its last bounce, and record the closing.

    Its mode follows from its slip. A projection brings its gap rate to zero. The kinetic energy that this removes is
    closing loss.
    """
    begin_event(ws)
    contact = ws.contacts[c]
    contact.mode = Mode.SLIDE if length(contact.slip) > ws.tolerance.velocity else Mode.STICK
    work_before = ws.totals.driven_work
    _add_loss(ws, project_rates(ws, at_event=True), work_before)
    record_event(ws, Cause.CLOSING, c, NO_PHASES)


@kernel("void(ws, f8, f8)")
def _add_loss(ws: Workspace, loss: float, work_before: float) -> None:
    """Add the energy ``loss`` that a closing removed [J] to the event and the totals.

    The work of driven bodies is in the totals already. What exceeds ``work_before`` [J] is added to the event.
    """
    ws.event.head[CLOSING_LOSS] += loss
    ws.event.head[DRIVEN_WORK] += ws.totals.driven_work - work_before
    ws.totals.closing_loss += loss


@kernel()
def _stop_active(ws: Workspace) -> None:
    """Stop the approaches of the active contacts by an inelastic impact. Adds its loss and impulses to the event."""
    assemble_delassus(ws)
    for active in ws.actives:
        for r in range(3):
            # accelerations do not matter in no time, and no impulses are known to start from
            active.free[r] = active.force[r] = 0.0
    # approaches are left if it has no exact solution, see `average_slow_islands`
    inelastic_impulses(ws, time=0.0)
    add_response(ws, ws.problem.forces.start, ws.island.y.start + ws.model.n_q)
    loss, work_before = 0.0, ws.totals.driven_work
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        for r in range(3):
            impulse, rate = active.force[r], contact.rate[r]
            # the impulse times the mean of the rates before and after is its work
            loss -= 0.5 * impulse * add_product(ws, 2.0 * rate, active.index, r, ws.problem.forces.start)
            # work of the driven bodies against the impulse, at the rate that they prescribe
            ws.totals.driven_work -= impulse * contact.prescribed_rate[r]
            contact.event_impulse[r] = impulse
    _add_loss(ws, loss, work_before)


@kernel("i8(ws)")
def _fastest_approach(ws: Workspace) -> int:
    """Active contact that approaches fastest, or ``NO_CONTACT`` if none exceeds the velocity tolerance."""
    which, least = NO_CONTACT, -ws.tolerance.velocity
    for active in ws.actives:
        rate = ws.contacts[active.contact].normal_rate
        if rate < least:
            which, least = active.contact, rate
    return which


@kernel("b1(ws, i8)")
def _is_slow(ws: Workspace, c: int) -> bool:
    """True if contact ``c`` approaches too slowly for a bounce that is longer than the contact time.

    Its island must be the active one.
    """
    return -ws.contacts[c].normal_rate <= slow_speed(ws)


@kernel("f8(ws)")
def slow_speed(ws: Workspace) -> float:
    """Speed of a gap of the active contacts below which bounces are shorter than their contact time [m/s].

    It is the speed that the largest free acceleration of approach reaches in the shortest contact time: Eq. (33) of an
    island in place of a contact. The free accelerations must be written.
    """
    time, largest = math.inf, 0.0
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        time = min(time, contact.contact_time)
        largest = max(largest, _approach_of_bodies(ws, contact))
    return float(largest * time)


@kernel("i8(ws)")
def stop_slow_islands(ws: Workspace) -> int:
    """Stop islands whose approaches are slow by an inelastic impact, as their bounces would accumulate (Zeno).

    Returns the number of these islands. After an impact that was cut short, islands are stopped at any speed: another
    impact would be cut short too. All stops are recorded as one event, of the fastest contact of the last island. The
    contacts get provisional modes.
    """
    # which approaches are slow depends on the free accelerations
    accelerate_touching(ws)
    accelerate_by_compliance(ws)
    group_touching(ws)
    n_stopped, which = 0, NO_CONTACT
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        fastest = _fastest_approach(ws)
        was_cut_short = ws.event.truncation != Truncation.NONE
        if fastest == NO_CONTACT or not (was_cut_short or _is_slow(ws, fastest)):
            continue
        if n_stopped == 0:
            begin_event(ws)
        n_stopped, which = n_stopped + 1, fastest
        _stop_active(ws)
    if n_stopped > 0:
        # evaluates the contacts at the new velocities
        find_touching(ws)
        for contact in ws.contacts:
            set_provisional_mode(ws, contact.index)
        _stop_slow_closed(ws)
        record_event(ws, Cause.CLOSING, which, NO_PHASES)
    return n_stopped


@kernel("b1(ws)")
def average_slow_islands(ws: Workspace) -> bool:
    """Average over time the forces of islands that still approach slowly after they were stopped.

    True if another island approaches: fast, or with forces that cannot be averaged. The caller then tries a
    collision. An inelastic impact has no exact solution if its contacts contradict each other. Then another impact
    would leave an approach again.
    """
    # which approaches are slow depends on the free accelerations
    accelerate_touching(ws)
    accelerate_by_compliance(ws)
    group_touching(ws)
    has_others = False
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        fastest = _fastest_approach(ws)
        if fastest != NO_CONTACT and not (_is_slow(ws, fastest) and (is_averaged(ws) or average_active(ws))):
            has_others = True
    return has_others


@kernel()
def _stop_slow_closed(ws: Workspace) -> None:
    """Bring the slow approaches that an inelastic impact left to zero by projection, in islands of closed contacts.

    The kinetic energy that this removes is closing loss.
    """
    group_closed(ws)
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        fastest = _fastest_approach(ws)
        if fastest != NO_CONTACT and _is_slow(ws, fastest):
            work_before = ws.totals.driven_work
            _add_loss(ws, project_rates(ws, at_event=True), work_before)


@kernel("f8(ws)")
def stop_creeping(ws: Workspace) -> float:
    """Stop the touching open contacts that approach within the velocity tolerance. Energy that this removes [J].

    Such an approach is no collision, but in time the bodies would overlap. The impulses are normal only, because
    friction is negligible. The caller adds the energy to the closing loss.
    """
    if not _has_creeping_contact(ws):
        return 0.0
    loss = 0.0
    find_touching(ws)
    group_touching(ws)
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        assemble_delassus(ws)
        ws.problem.acceleration_scale = 0.0
        for active in ws.actives:
            contact = ws.contacts[active.contact]
            # unknown normal impulses, without friction; with rates as free accelerations, forces are impulses
            active.is_at_rest = active.has_given_force = False
            active.friction_coefficient = active.static_coefficient = 0.0
            active.mode_tried, active.direction = Mode.UNKNOWN, contact.direction
            for r in range(3):
                active.free[r] = contact.rate[r]
            ws.problem.acceleration_scale = max(ws.problem.acceleration_scale, abs(contact.normal_rate))
        if not solve_contact(ws):
            continue
        add_response(ws, ws.problem.forces.start, ws.island.y.start + ws.model.n_q)
        for active in ws.actives:
            contact, impulse = ws.contacts[active.contact], active.normal_force
            # twice the mean of the rates before and after
            rates = add_product(ws, 2.0 * contact.normal_rate, active.index, NORMAL_ROW, ws.problem.forces.start)
            loss -= 0.5 * impulse * rates
            # work of the driven bodies against the impulse, at the rate that they prescribe
            ws.totals.driven_work -= impulse * contact.prescribed_rate[0]
    return loss


@kernel("b1(ws)")
def _has_creeping_contact(ws: Workspace) -> bool:
    """True if an open rigid contact touches and approaches, by more than a negligible rate.

    In time, such an approach would lead the bodies into each other.
    """
    for contact in ws.contacts:
        rests = contact.is_touching and not contact.is_compliant and contact.mode == Mode.OPEN
        if rests and contact.normal_rate < -NEGLIGIBLE * ws.tolerance.velocity:
            return True
    return False


@kernel("b1(ws, ContactRecord)")
def _is_approaching(ws: Workspace, contact: ContactRecord) -> bool:
    """True if a contact touches, is rigid and approaches faster than the velocity tolerance."""
    return not contact.is_compliant and contact.is_touching and contact.normal_rate < -ws.tolerance.velocity


@kernel("b1(ws)")
def replace_coincident_contacts(ws: Workspace) -> bool:
    """Replace closed contacts by approaching ones that coincide with them, stop what still approaches, and record that.

    True if this was done. False, and nothing is replaced, if an approaching contact coincides with no closed one: it
    collides. At least one contact must approach. The event names the last contact that replaces another.
    """
    for contact in ws.contacts:
        if _is_approaching(ws, contact) and closed_coincident(ws, contact.index) == NO_CONTACT:
            return False
    begin_event(ws)
    which = NO_CONTACT
    for contact in ws.contacts:
        if _is_approaching(ws, contact) and replace_coincident(ws, contact.index):
            which = contact.index
    group_touching(ws)
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        if _fastest_approach(ws) != NO_CONTACT:
            _stop_active(ws)
    record_event(ws, Cause.FEATURE_CHANGE, which, NO_PHASES)
    return True
