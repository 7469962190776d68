"""Closing: the end of an accumulation of ever shorter bounces, Eq. (33)."""

from __future__ import annotations

from nonsmooth.engine.bodies.compliance import begin_contact
from nonsmooth.engine.bodies.kinematics import row
from nonsmooth.engine.bodies.touching import slip_speed, touch
from nonsmooth.engine.contact.cone import SWEEPS, gauss_seidel
from nonsmooth.engine.delassus.delassus import add_product, add_response, assemble_delassus
from nonsmooth.engine.delassus.islands import activate_group, group_members, group_touching
from nonsmooth.engine.events.contact_time import slow_modes
from nonsmooth.engine.events.record import CLOSING_LOSS, DRIVEN_WORK, record_event, remember
from nonsmooth.engine.events.twins import closed_twin, take_over
from nonsmooth.engine.flow.projection import project_rates
from nonsmooth.engine.memory.modes import CLOSING, FEATURE_CHANGE, OPEN, SLIDE, STICK
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, active_at, contact_at, kernel

_CREEPING = 1e-3
"""An approach below this part of what counts as zero is none."""


@kernel("i8(S, F, I)")
def _choose(S: Scalars, w: Floats, k: Integers) -> int:
    """Mark the contacts whose bounces have become shorter than their contact time; return how many.

    What a jam has opened at this instant does not bounce: closed again it would jam again.
    """
    closing = 0
    S.h_first = 1e300
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        contact.closes = 0
        rate = contact.rate[0]
        if contact.touching == 0 or contact.normal_function != 0 or rate <= S.velocity_tolerance:
            continue
        approach = -(contact.bias[0] + row(S, w, k, c, 0, S.du))
        if approach > 0.0:
            # the next step shall not fly over the touch-down that is due after 2 rate / approach
            S.h_first = min(S.h_first, 3.0 * rate / approach)
        bounces = S.jammed == 0 and approach > 0.0 and rate <= approach * contact.contact_time
        if bounces and closed_twin(S, w, k, c) < 0:
            closing += 1
            contact.closes = 1
    return closing


@kernel("i8(S, F, I)")
def _join(S: Scalars, w: Floats, k: Integers) -> int:
    """Close the contacts at rest that closing others makes approach, which is no collision; return how many."""
    touch(S, w, k)
    joining = 0
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        rigid = contact.normal_function == 0
        if rigid and contact.touching == 1 and contact.member == 0 and contact.rate[0] < -S.velocity_tolerance:
            joining += 1
            contact.member = 1
            if take_over(S, w, k, c) == 0:
                begin_contact(S, w, k, c)
                contact.mode = SLIDE if slip_speed(S, w, k, c) > S.velocity_tolerance else STICK
    return joining


@kernel("void(S, F, I)")
def _begin_modes(S: Scalars, w: Floats, k: Integers) -> None:
    """Give the marked contacts modes, by their slips."""
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.closes == 1:
            contact.mode = SLIDE if slip_speed(S, w, k, c) > S.velocity_tolerance else STICK


@kernel("f8(S, F, I)")
def _shut(S: Scalars, w: Floats, k: Integers) -> float:
    """Bring the touching contacts that are closed to rest; return the energy that it takes [J].

    Others are left alone, unless they are drawn in.
    """
    loss = 0.0
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        contact.member = 1 if contact.touching == 1 and contact.mode != OPEN else 0
    for _round in range(S.n_contacts):
        group_members(S, w, k)
        for group in range(S.n_groups):
            activate_group(S, w, k, group)
            loss += project_rates(S, w, k, 1)
        if _join(S, w, k) == 0:
            break
    return loss


@kernel("i8(S, F, I)")
def _left_over(S: Scalars, w: Floats, k: Integers) -> int:
    """Try to shut the marked contacts, and undo it; return the one of them that goes on separating most, or -1.

    Contacts that all but repeat one another cannot be brought to rest together.
    """
    for i in range(S.n_u):
        w[S.y_stage + S.n_q + i] = w[S.y + S.n_q + i]
    work = S.driven_work
    _begin_modes(S, w, k)
    _shut(S, w, k)
    which, worst = -1, S.velocity_tolerance
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.closes == 1 and contact.rate[0] > worst:
            which, worst = c, contact.rate[0]
    S.driven_work = work
    for i in range(S.n_u):
        w[S.y + S.n_q + i] = w[S.y_stage + S.n_q + i]
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        contact.mode = contact.mode_agreed
    touch(S, w, k)
    return which


@kernel("i8(S, F, I)")
def close_contacts(S: Scalars, w: Floats, k: Integers) -> int:
    """Close the contacts whose bounces have become shorter than their contact time; return how many.

    The modes must be those agreed on for this instant.
    """
    closing = _choose(S, w, k)
    while closing > 0:
        which = _left_over(S, w, k)
        if which < 0:
            break
        contact_at(S, w, k, which).closes = 0
        closing -= 1
    if closing == 0:
        return 0
    remember(S, w, k)
    _begin_modes(S, w, k)
    _close(S, w, k, CLOSING)
    return closing


@kernel("i8(S, F, I)")
def close_slow(S: Scalars, w: Floats, k: Integers) -> int:
    """Close islands in which what approaches is slow, in place of a collision; return 1 if all that approach are."""
    if slow_modes(S, w, k) == 0:
        return 0
    remember(S, w, k)
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        contact.closes = 1 if contact.touching == 1 and contact.rate[0] < -S.velocity_tolerance else 0
        if contact.mode == OPEN and contact.mode_agreed != OPEN:
            begin_contact(S, w, k, c)
        contact.mode = contact.mode_agreed
    _close(S, w, k, CLOSING)
    return 1


@kernel("void(S, F, I, i8)")
def _close(S: Scalars, w: Floats, k: Integers, cause: int) -> None:
    """Shut the marked contacts, book what it takes, and record it."""
    before = S.driven_work
    w[S.event_head + CLOSING_LOSS] = _shut(S, w, k)
    w[S.event_head + DRIVEN_WORK] = S.driven_work - before
    S.closing_loss += w[S.event_head + CLOSING_LOSS]
    which = -1
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.closes == 1:
            which = c
    record_event(S, w, k, cause, which, 0)


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
        if rests and contact.rate[0] < -_CREEPING * S.velocity_tolerance:
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
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.closes == 1 and take_over(S, w, k, c) == 0:
            # another one that approaches more has taken its twin's place
            contact.closes = 0
    _close(S, w, k, FEATURE_CHANGE)
    return 1
