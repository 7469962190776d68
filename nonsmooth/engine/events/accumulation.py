"""The end of an accumulation of ever shorter bounces, Eq. (33): of one contact by itself, and of an island."""

from __future__ import annotations

from nonsmooth.engine.bodies.compliance import begin_contact, push_compliant
from nonsmooth.engine.bodies.courses import is_on_course
from nonsmooth.engine.bodies.kinematics import row
from nonsmooth.engine.bodies.touching import slip_speed, touch
from nonsmooth.engine.contact.cone import SWEEPS, gauss_seidel
from nonsmooth.engine.contact.inelastic import inelastic_impulses
from nonsmooth.engine.contact.mean_forces import averaging_time, is_averaged
from nonsmooth.engine.contact.problem import accelerate_touching
from nonsmooth.engine.delassus.delassus import add_product, add_response, assemble_delassus
from nonsmooth.engine.delassus.islands import activate_group, group_closed, group_touching
from nonsmooth.engine.events.averaging import average_active
from nonsmooth.engine.events.record import CLOSING_LOSS, DRIVEN_WORK, record_event, remember
from nonsmooth.engine.events.twins import closed_twin, take_over
from nonsmooth.engine.flow.projection import project_rates
from nonsmooth.engine.flow.self_check import EXPLAINED, NOUGHT
from nonsmooth.engine.memory.modes import CLOSING, FEATURE_CHANGE, OPEN, SLIDE, STICK
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, active_at, contact_at, kernel

_RESTS = 1.0 - 1e-6
"""What comes to rest this near the end of an averaging, in parts of it, is not told from what does not."""


@kernel("void(S, F, I, i8)")
def provisional_mode(S: Scalars, w: Floats, k: Integers, c: int) -> None:
    """Give contact ``c`` the mode that its rates tell, until the instant is settled."""
    contact = contact_at(S, w, k, c)
    rigid = contact.normal_function == 0
    if is_on_course(S, w, k, c) == 1:
        return
    if contact.touching == 0 or contact.released == 1 or (rigid and contact.rate[0] > S.velocity_tolerance):
        contact.mode = OPEN
        return
    if contact.mode == OPEN:
        begin_contact(S, w, k, c)
    speed = slip_speed(S, w, k, c)
    contact.mode = SLIDE if speed > S.velocity_tolerance else STICK
    if speed > S.velocity_tolerance:
        contact.direction = contact.slip[0] / speed, contact.slip[1] / speed


@kernel("i8(S, F, I, i8, f8)")
def _is_short(S: Scalars, w: Floats, k: Integers, c: int, time: float) -> int:
    """Return 1 if contact ``c`` separates, but no faster than it approaches after a ``time``.

    How fast the next step may not be, lest it fly over the touch-down, is kept.
    """
    contact = contact_at(S, w, k, c)
    rate = contact.rate[0]
    approach = -(contact.bias[0] + row(S, w, k, c, 0, S.du))
    if rate <= S.velocity_tolerance or approach <= 0.0:
        return 0
    # the touch-down is due after 2 rate / approach
    S.h_first = min(S.h_first, 3.0 * rate / approach)
    # (a gap that is left closes first)
    short = (rate - approach * time) * time <= -max(0.0, contact.gap)
    return 1 if short and closed_twin(S, w, k, c) < 0 else 0


@kernel("i8(S, F, I)")
def close_contacts(S: Scalars, w: Floats, k: Integers) -> int:
    """End the bounces that have become shorter than their contact time; return how many contacts or islands have one.

    One of a contact by itself is left out.  Where several touch, the forces of their island are averaged, so that all
    land together.  The modes must be those agreed on for this instant.
    """
    S.h_first = 1e300
    group_touching(S, w, k)
    closing = 0
    for group in range(S.n_groups):
        activate_group(S, w, k, group)
        time, fastest = averaging_time(S, w, k), 1e300
        if S.n_active > 1:
            # what is averaged comes to rest within that time, on its way up, which is none that can be told
            time *= _RESTS
            fastest = EXPLAINED * S.gap_tolerance / max(time, S.time_tolerance)
        which = -1
        for a in range(S.n_active):
            c = active_at(S, w, k, a).slot
            if contact_at(S, w, k, c).rate[0] <= fastest and _is_short(S, w, k, c, time) == 1:
                which = c
        if which >= 0 and S.n_active == 1:
            _close(S, w, k, which)
            closing += 1
        elif which >= 0:
            closing += average_active(S, w, k)
    return closing


@kernel("void(S, F, I, i8)")
def _close(S: Scalars, w: Floats, k: Integers, c: int) -> None:
    """Leave out the last bounce of contact ``c``, the only active one, and record that."""
    remember(S, w, k)
    contact = contact_at(S, w, k, c)
    contact.mode = SLIDE if slip_speed(S, w, k, c) > S.velocity_tolerance else STICK
    before = S.driven_work
    _book(S, w, k, project_rates(S, w, k, 1), before)
    record_event(S, w, k, CLOSING, c, 0)


@kernel("void(S, F, I, f8, f8)")
def _book(S: Scalars, w: Floats, k: Integers, loss: float, work_before: float) -> None:
    """Book what a closing takes."""
    w[S.event_head + CLOSING_LOSS] += loss
    w[S.event_head + DRIVEN_WORK] += S.driven_work - work_before
    S.closing_loss += loss


@kernel("void(S, F, I)")
def _stop_active(S: Scalars, w: Floats, k: Integers) -> None:
    """Give the active contacts the impulses of an inelastic impact, of which none pulls, and book what they take."""
    assemble_delassus(S, w, k)
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        for r in range(3):
            active.free[r] = active.force[r] = 0.0
    inelastic_impulses(S, w, k, 0.0)
    add_response(S, w, k, S.active_forces, S.y + S.n_q)
    loss, before = 0.0, S.driven_work
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        contact = contact_at(S, w, k, active.slot)
        for r in range(3):
            impulse, rate = active.force[r], contact.rate[r]
            loss -= 0.5 * impulse * add_product(S, w, k, 2.0 * rate, a, r, S.active_forces)
            S.driven_work -= impulse * contact.prescribed_rate[r]
            contact.event_impulse[r] = impulse
    _book(S, w, k, loss, before)


@kernel("i8(S, F, I)")
def _fastest_of_active(S: Scalars, w: Floats, k: Integers) -> int:
    """Return the active contact that approaches most, or -1 where none does."""
    which, worst = -1, -S.velocity_tolerance
    for a in range(S.n_active):
        c = active_at(S, w, k, a).slot
        rate = contact_at(S, w, k, c).rate[0]
        if rate < worst:
            which, worst = c, rate
    return which


@kernel("f8(S, F, I)")
def slow_speed(S: Scalars, w: Floats, k: Integers) -> float:
    """Return the speed of a gap below which nothing bounces among the active contacts [m/s].

    It is what the greatest approach of the free accelerations, which must be written, makes of it in the shortest
    contact time: Eq. (33), of an island in place of a contact.
    """
    time, approach = 1e300, 0.0
    for a in range(S.n_active):
        c = active_at(S, w, k, a).slot
        contact = contact_at(S, w, k, c)
        time = min(time, contact.contact_time)
        approach = max(approach, -(contact.bias[0] + row(S, w, k, c, 0, S.du)))
    return float(approach * time)


@kernel("i8(S, F, I)")
def stop_slow(S: Scalars, w: Floats, k: Integers) -> int:
    """Stop islands in which what approaches is slow, in place of a collision; return how many.

    So it is, however fast, where an impact has been cut short: another one would be, too.
    """
    accelerate_touching(S, w, k)
    push_compliant(S, w, k)
    group_touching(S, w, k)
    stopped, which = 0, -1
    for group in range(S.n_groups):
        activate_group(S, w, k, group)
        fastest = _fastest_of_active(S, w, k)
        if fastest < 0:
            continue
        if S.truncated == 0 and -contact_at(S, w, k, fastest).rate[0] > slow_speed(S, w, k):
            continue
        if stopped == 0:
            remember(S, w, k)
        stopped, which = stopped + 1, fastest
        _stop_active(S, w, k)
    if stopped > 0:
        touch(S, w, k)
        for c in range(S.n_contacts):
            provisional_mode(S, w, k, c)
        _rest_closed(S, w, k)
        record_event(S, w, k, CLOSING, which, 0)
    return stopped


@kernel("i8(S, F, I)")
def average_slow(S: Scalars, w: Floats, k: Integers) -> int:
    """Let the forces of islands be averaged that approach slowly though they were stopped; return 1 if others approach.

    Where contacts had to give way for impulses to be found, these may leave an approach for ever.
    """
    accelerate_touching(S, w, k)
    push_compliant(S, w, k)
    group_touching(S, w, k)
    others = 0
    for group in range(S.n_groups):
        activate_group(S, w, k, group)
        fastest = _fastest_of_active(S, w, k)
        if fastest < 0:
            continue
        slow = -contact_at(S, w, k, fastest).rate[0] <= slow_speed(S, w, k)
        if not slow or (is_averaged(S, w, k) == 0 and average_active(S, w, k) == 0):
            others = 1
    return others


@kernel("void(S, F, I)")
def _rest_closed(S: Scalars, w: Floats, k: Integers) -> None:
    """Take the approach that impulses leave where contacts had to give way a little for any to be found."""
    group_closed(S, w, k)
    for group in range(S.n_groups):
        activate_group(S, w, k, group)
        fastest = _fastest_of_active(S, w, k)
        if fastest >= 0 and -contact_at(S, w, k, fastest).rate[0] <= slow_speed(S, w, k):
            before = S.driven_work
            _book(S, w, k, project_rates(S, w, k, 1), before)


@kernel("f8(S, F, I)")
def stop_creeping(S: Scalars, w: Floats, k: Integers) -> float:
    """Stop the open contacts that touch and approach, if no faster than what counts as zero; return the energy [J].

    Nothing collides so slowly, but in time the bodies would overlap.  The impulses press and do not rub: so little is
    no friction.
    """
    creeping = 0
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        rests = contact.touching == 1 and contact.normal_function == 0 and contact.mode == OPEN
        if rests and contact.rate[0] < -NOUGHT * S.velocity_tolerance:
            creeping += 1
    if creeping == 0:
        return 0.0
    loss = 0.0
    touch(S, w, k)
    group_touching(S, w, k)
    for group in range(S.n_groups):
        activate_group(S, w, k, group)
        assemble_delassus(S, w, k)
        for a in range(S.n_active):
            active = active_at(S, w, k, a)
            contact = contact_at(S, w, k, active.slot)
            active.at_rest, active.normal_held = 0, 1
            active.mu = active.normal_force = 0.0
            for r in range(3):
                active.free[r] = contact.rate[r]
        gauss_seidel(S, w, k, SWEEPS)
        add_response(S, w, k, S.active_forces, S.y + S.n_q)
        for a in range(S.n_active):
            active = active_at(S, w, k, a)
            contact = contact_at(S, w, k, active.slot)
            loss -= 0.5 * active.normal_force * add_product(S, w, k, 2.0 * contact.rate[0], a, 0, S.active_forces)
            S.driven_work -= active.normal_force * contact.prescribed_rate[0]
    return loss


@kernel("i8(S, F, I)")
def hand_over(S: Scalars, w: Floats, k: Integers) -> int:
    """Let contacts that approach take the place of closed ones where they are; return 1, or 0 where others collide."""
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        rigid = contact.normal_function == 0
        approaches = rigid and contact.touching == 1 and contact.rate[0] < -S.velocity_tolerance
        contact.closes = 1 if approaches else 0
        if approaches and closed_twin(S, w, k, c) < 0:
            return 0
    remember(S, w, k)
    which = -1
    for c in range(S.n_contacts):
        if contact_at(S, w, k, c).closes == 1 and take_over(S, w, k, c) == 1:
            # unless another one that approaches more has taken its twin's place
            which = c
    group_touching(S, w, k)
    for group in range(S.n_groups):
        activate_group(S, w, k, group)
        if _fastest_of_active(S, w, k) >= 0:
            _stop_active(S, w, k)
    record_event(S, w, k, FEATURE_CHANGE, which, 0)
    return 1
