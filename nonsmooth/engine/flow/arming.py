"""Arming: a guard fires at zero once it has been positive by more than round-off.

Round-off may turn the sign of a guard that is about zero. A guard is armed when it has been positive by more
than round-off, and an armed guard fires at zero. A disarmed guard fires only when it is negative beyond the tolerances.
"""

from __future__ import annotations

from nonsmooth.engine.flow.deflation import start_from_zero
from nonsmooth.engine.flow.guard_numbers import (
    contact_at,
    end_of,
    first_user_guard,
    friction_guard,
    friction_of,
    is_friction_guard,
    is_of_open_contact,
    normal_guard,
    normal_of,
    number_of_guards,
)
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import ContactRecord, GuardRecord, Workspace, kernel
from nonsmooth.engine.numerics.tolerances import NEGLIGIBLE

NO_BOUND = -1.0, 0.0, 0.0
"""Bounds of a gap's acceleration that were not evaluated. A bound that was evaluated is never negative."""


@kernel()
def store_end(ws: Workspace) -> None:
    """Copy gaps, rates and guards, as evaluated last, to the fields ``*_at_end``, from which the next step starts.

    The bodies must be evaluated at the end of the step. The search for events within the step overwrites the present
    values. After an event this is called at the start of the next step.
    """
    for contact in ws.contacts:
        contact.gap_rate_at_end = contact.gap_rate
        contact.gap_at_end = contact.gap
        contact.overlap_at_end = contact.overlap
        contact.past_feature_at_end = contact.past_feature
        contact.velocity_at_end = contact.velocity
    for i in range(number_of_guards(ws)):
        ws.guards[i].at_end = ws.guards[i].value


@kernel()
def store_start(ws: Workspace) -> None:
    """Take what is known of the gaps at the end of the last step as that at the start of this one.

    From gaps, their rates and bounds, distances past the features, and offsets of the contact points, the search for
    gaps that close within the step starts. After an event the bounds of the gap's acceleration are not evaluated yet:
    that is done only for gaps that may close. ``follows_a_step`` is true if no event has come since the last step.
    """
    for contact in ws.contacts:
        contact.gap_at_start, contact.gap_rate_at_start = contact.gap_at_end, contact.gap_rate_at_end
        contact.past_feature_at_start, contact.speed_at_start = contact.past_feature_at_end, contact.speed_at_end
        bound = contact.acceleration_bound_at_end if ws.island.follows_a_step else NO_BOUND
        contact.acceleration_bound_at_start = bound
        contact.offset_at_start = contact.offset_at_end
    for carrier in ws.carriers:
        carrier.speed_at_start = carrier.speed_at_end


@kernel()
def arm_guards(ws: Workspace) -> None:
    """Prepare all guards for the step that begins: those of contacts, of the user, and of the ends of features.

    Each starts from its value at the end of the last step. A guard of a contact that starts about zero is deflated: its
    root at the start is divided out, so that its next root is the first. A guard that starts positive is armed: it
    fires at its next root.
    """
    for contact in ws.contacts:
        _start(normal_of(ws, contact))
        _start(friction_of(ws, contact))
        _deflate_normal(ws, contact)
        _deflate_friction(ws, contact)
        _arm(ws, contact)
        end = end_of(ws, contact)
        _start(end)
        end.is_armed = end.initial > 0.0
    for user in ws.own_guards:
        guard = ws.guards[first_user_guard(ws) + user.index]
        _start(guard)
        if user.has_just_fired:
            # it starts at zero, with a growth rate that is not known: 0 leaves it disarmed until it has grown
            guard.is_deflated = True
            guard.initial = 0.0
        user.has_just_fired = False
        guard.is_armed = guard.initial > 0.0


@kernel("void(GuardRecord)")
def _start(guard: GuardRecord) -> None:
    """Set a guard to its value at the end of the last step, not deflated."""
    # base is the value from which its growth counts if it is deflated afterwards
    guard.is_deflated = False
    guard.base = guard.initial = guard.at_end


@kernel("void(ws, ContactRecord)")
def _deflate_normal(ws: Workspace, contact: ContactRecord) -> None:
    """Deflate the normal guard if it starts about zero, so that its root at the start does not fire again.

    The guard is the gap of an open contact, or the distance of a closed compliant one to its reach, the gap up to which
    it acts. A gap that does not separate gets a slack: while other contacts hold the bodies, it may drift within
    round-off. The force of a closed rigid contact is not deflated.
    """
    normal, round_off = normal_of(ws, contact), NEGLIGIBLE * ws.tolerance.gap
    starts_about_zero = normal.initial <= ws.tolerance.gap
    if not starts_about_zero:
        return
    if contact.mode == Mode.OPEN:
        # a rate that is not a number counts as separating
        separates = not contact.gap_rate_at_end <= ws.tolerance.velocity
        start_from_zero(normal, slack=0.0 if separates else round_off, rate=contact.gap_rate_at_end)
    elif contact.is_compliant:
        # it has just closed, and opens when it returns to this gap; its distance to the reach grows as the gap closes
        start_from_zero(normal, round_off, -contact.gap_rate_at_end)


@kernel("void(ws, ContactRecord)")
def _deflate_friction(ws: Workspace, contact: ContactRecord) -> None:
    """Deflate the friction guard of a sliding contact, its slip [m/s], if that has just begun and is about zero."""
    friction = friction_of(ws, contact)
    if contact.mode == Mode.SLIDE and friction.initial <= ws.tolerance.velocity:
        # the growth rate is not known: 0 leaves the guard disarmed until the slip has grown
        start_from_zero(friction, slack=NEGLIGIBLE * ws.tolerance.velocity, rate=0.0)


@kernel("void(ws, ContactRecord)")
def _arm(ws: Workspace, contact: ContactRecord) -> None:
    """Arm the normal and the friction guard of a contact, so that they may fire, if they start above their thresholds.

    A gap that starts closed is armed at once: its guard is its growth, which is negative as soon as it closes further.
    """
    c, normal, friction = contact.index, normal_of(ws, contact), friction_of(ws, contact)
    starts_closed = contact.mode == Mode.OPEN and normal.is_deflated
    normal.is_armed = starts_closed or normal.initial > _arming_threshold(ws, normal_guard(c))
    friction.is_armed = friction.initial > _arming_threshold(ws, friction_guard(ws, c))


@kernel("f8(ws, i8)")
def _arming_threshold(ws: Workspace, i: int) -> float:
    """Value above which guard ``i`` of a contact is armed: the round-off of forces [N] for a force, 0 for gap or slip.

    A force within round-off of zero must not arm its guard. The distance of friction to its static bound has this
    threshold only without a normal force, because it is then round-off too.
    """
    contact = contact_at(ws, i)
    if contact.mode == Mode.OPEN or contact.is_compliant:
        return 0.0
    presses = normal_of(ws, contact).initial > contact.force_round_off
    if is_friction_guard(ws, i) and (presses or contact.mode != Mode.STICK):
        return 0.0
    return contact.force_round_off


@kernel("void(ws, b1)")
def arm_further(ws: Workspace, forces_are_known: bool) -> None:
    """Arm, within a step, the guards that were positive at the last evaluation, so that they fire at their next zero.

    A force must be above its round-off. Without known forces the guards of closed contacts are skipped, because they
    were not evaluated.
    """
    for i in range(number_of_guards(ws)):
        guard, is_of_contact = ws.guards[i], i < first_user_guard(ws)
        threshold = _arming_threshold(ws, i) if is_of_contact else 0.0
        is_known = not is_of_contact or forces_are_known or is_of_open_contact(ws, i)
        if guard.value > threshold and is_known:
            guard.is_armed = True
