"""The end of an accumulation of ever shorter bounces, Eq. (33): of one contact by itself, and of an island."""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.compliance import start_inner_states, accelerate_by_compliance
from nonsmooth.engine.bodies.courses import has_own_step
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
from nonsmooth.engine.events.coincident import closed_coincident, replace_coincident
from nonsmooth.engine.flow.projection import project_rates
from nonsmooth.engine.flow.self_check import ALLOWED, NEGLIGIBLE
from nonsmooth.engine.memory.layout import NORMAL_ROW
from nonsmooth.engine.memory.modes import NO_RELEASE, Cause, Mode, Truncation
from nonsmooth.engine.native.kernel import Workspace, kernel

_PART_AT_REST = 1.0 - 1e-6
"""What comes to rest this near the end of an averaging, in parts of it, is not told from what does not."""


@kernel("void(ws, i8)")
def set_provisional_mode(ws: Workspace, c: int) -> None:
    """Give contact ``c`` the mode that its rates tell, until the instant is settled."""
    contact = ws.contacts[c]
    rigid = not contact.is_compliant
    if has_own_step(ws, c):
        return
    if not contact.is_touching or contact.release != NO_RELEASE or (rigid and contact.rate[0] > ws.tolerance.velocity):
        contact.mode = Mode.OPEN
        return
    if contact.mode == Mode.OPEN:
        start_inner_states(ws, c)
    speed = slip_speed(ws, c)
    contact.mode = Mode.SLIDE if speed > ws.tolerance.velocity else Mode.STICK
    if speed > ws.tolerance.velocity:
        contact.direction = contact.slip[0] / speed, contact.slip[1] / speed


@kernel("b1(ws, i8, f8)")
def _is_short(ws: Workspace, c: int, time: float) -> bool:
    """Return 1 if contact ``c`` separates, but no faster than it approaches after a ``time``.

    How fast the next step may not be, lest it fly over the touch-down, is kept.
    """
    contact = ws.contacts[c]
    rate = contact.rate[0]
    approach = -(contact.bias[0] + row(ws, c, NORMAL_ROW, ws.island.du.start))
    if rate <= ws.tolerance.velocity or approach <= 0.0:
        return False
    # the touch-down is due after 2 rate / approach
    ws.island.first_step = min(ws.island.first_step, 3.0 * rate / approach)
    # (a gap that is left closes first)
    short = (rate - approach * time) * time <= -max(0.0, contact.gap)
    return short and closed_coincident(ws, c) < 0


@kernel("i8(ws)")
def end_short_bounces(ws: Workspace) -> int:
    """End the bounces that have become shorter than their contact time; return how many contacts or islands have one.

    One of a contact by itself is left out.  Where several touch, the forces of their island are averaged, so that all
    land together.  The modes must be those agreed on for this instant.
    """
    ws.island.first_step = math.inf
    group_touching(ws)
    closing = 0
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        time, fastest = averaging_time(ws), math.inf
        if ws.problem.n_active > 1:
            # what is averaged comes to rest within that time, on its way up, which is none that can be told
            time *= _PART_AT_REST
            fastest = ALLOWED * ws.tolerance.gap / max(time, ws.tolerance.time)
        which = -1
        for a in range(ws.problem.n_active):
            c = ws.actives[a].contact
            if ws.contacts[c].rate[0] <= fastest and _is_short(ws, c, time):
                which = c
        if which >= 0 and ws.problem.n_active == 1:
            _end_bounce(ws, which)
            closing += 1
        elif which >= 0:
            closing += average_active(ws)
    return closing


@kernel("void(ws, i8)")
def _end_bounce(ws: Workspace, c: int) -> None:
    """Leave out the last bounce of contact ``c``, the only active one, and record that."""
    remember(ws)
    contact = ws.contacts[c]
    contact.mode = Mode.SLIDE if slip_speed(ws, c) > ws.tolerance.velocity else Mode.STICK
    before = ws.totals.driven_work
    _add_loss(ws, project_rates(ws, at_event=True), before)
    record_event(ws, Cause.CLOSING, c, 0)


@kernel("void(ws, f8, f8)")
def _add_loss(ws: Workspace, loss: float, work_before: float) -> None:
    """Book what a closing takes."""
    ws.event.head[CLOSING_LOSS] += loss
    ws.event.head[DRIVEN_WORK] += ws.totals.driven_work - work_before
    ws.totals.closing_loss += loss


@kernel()
def _stop_active(ws: Workspace) -> None:
    """Give the active contacts the impulses of an inelastic impact, of which none pulls, and book what they take."""
    assemble_delassus(ws)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        for r in range(3):
            active.free[r] = active.force[r] = 0.0
    inelastic_impulses(ws, 0.0)
    add_response(ws, ws.problem.forces.start, ws.island.y.start + ws.model.n_q)
    loss, before = 0.0, ws.totals.driven_work
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        contact = ws.contacts[active.contact]
        for r in range(3):
            impulse, rate = active.force[r], contact.rate[r]
            loss -= 0.5 * impulse * add_product(ws, 2.0 * rate, a, r, ws.problem.forces.start)
            ws.totals.driven_work -= impulse * contact.prescribed_rate[r]
            contact.event_impulse[r] = impulse
    _add_loss(ws, loss, before)


@kernel("i8(ws)")
def _fastest_approach(ws: Workspace) -> int:
    """Return the active contact that approaches most, or -1 where none does."""
    which, worst = -1, -ws.tolerance.velocity
    for a in range(ws.problem.n_active):
        c = ws.actives[a].contact
        rate = ws.contacts[c].rate[0]
        if rate < worst:
            which, worst = c, rate
    return which


@kernel("f8(ws)")
def slow_speed(ws: Workspace) -> float:
    """Return the speed of a gap below which nothing bounces among the active contacts [m/s].

    It is what the greatest approach of the free accelerations, which must be written, makes of it in the shortest
    contact time: Eq. (33), of an island in place of a contact.
    """
    time, approach = math.inf, 0.0
    for a in range(ws.problem.n_active):
        c = ws.actives[a].contact
        contact = ws.contacts[c]
        time = min(time, contact.contact_time)
        approach = max(approach, -(contact.bias[0] + row(ws, c, NORMAL_ROW, ws.island.du.start)))
    return float(approach * time)


@kernel("i8(ws)")
def stop_slow_islands(ws: Workspace) -> int:
    """Stop islands in which what approaches is slow, in place of a collision; return how many.

    So it is, however fast, where an impact has been cut short: another one would be, too.
    """
    accelerate_touching(ws)
    accelerate_by_compliance(ws)
    group_touching(ws)
    stopped, which = 0, -1
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        fastest = _fastest_approach(ws)
        if fastest < 0:
            continue
        if ws.event.truncation == Truncation.NONE and -ws.contacts[fastest].rate[0] > slow_speed(ws):
            continue
        if stopped == 0:
            remember(ws)
        stopped, which = stopped + 1, fastest
        _stop_active(ws)
    if stopped > 0:
        touch(ws)
        for c in range(ws.island.n_contacts):
            set_provisional_mode(ws, c)
        _stop_slow_closed(ws)
        record_event(ws, Cause.CLOSING, which, 0)
    return stopped


@kernel("b1(ws)")
def average_slow_islands(ws: Workspace) -> bool:
    """Let the forces of islands be averaged that approach slowly though they were stopped; return 1 if others approach.

    Where contacts had to give way for impulses to be found, these may leave an approach for ever.
    """
    accelerate_touching(ws)
    accelerate_by_compliance(ws)
    group_touching(ws)
    others = False
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        fastest = _fastest_approach(ws)
        if fastest < 0:
            continue
        slow = -ws.contacts[fastest].rate[0] <= slow_speed(ws)
        if not slow or (not is_averaged(ws) and not average_active(ws)):
            others = True
    return others


@kernel()
def _stop_slow_closed(ws: Workspace) -> None:
    """Take the approach that impulses leave where contacts had to give way a little for any to be found."""
    group_closed(ws)
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        fastest = _fastest_approach(ws)
        if fastest >= 0 and -ws.contacts[fastest].rate[0] <= slow_speed(ws):
            before = ws.totals.driven_work
            _add_loss(ws, project_rates(ws, at_event=True), before)


@kernel("f8(ws)")
def stop_creeping(ws: Workspace) -> float:
    """Stop the open contacts that touch and approach, if no faster than what counts as zero; return the energy [J].

    Nothing collides so slowly, but in time the bodies would overlap.  The impulses press and do not rub: so little is
    no friction.
    """
    creeping = 0
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        rests = contact.is_touching and not contact.is_compliant and contact.mode == Mode.OPEN
        if rests and contact.rate[0] < -NEGLIGIBLE * ws.tolerance.velocity:
            creeping += 1
    if creeping == 0:
        return 0.0
    loss = 0.0
    touch(ws)
    group_touching(ws)
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        assemble_delassus(ws)
        for a in range(ws.problem.n_active):
            active = ws.actives[a]
            contact = ws.contacts[active.contact]
            active.is_at_rest, active.is_normal_force_unknown = False, True
            active.friction_coefficient = active.normal_force = 0.0
            active.direction = contact.direction
            for r in range(3):
                active.free[r] = contact.rate[r]
        gauss_seidel(ws, SWEEPS)
        add_response(ws, ws.problem.forces.start, ws.island.y.start + ws.model.n_q)
        for a in range(ws.problem.n_active):
            active = ws.actives[a]
            contact = ws.contacts[active.contact]
            loss -= (
                0.5
                * active.normal_force
                * add_product(ws, 2.0 * contact.rate[0], a, NORMAL_ROW, ws.problem.forces.start)
            )
            ws.totals.driven_work -= active.normal_force * contact.prescribed_rate[0]
    return loss


@kernel("b1(ws)")
def replace_coincident_contacts(ws: Workspace) -> bool:
    """Let contacts that approach take the place of closed ones where they are; return 1, or 0 where others collide."""
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        rigid = not contact.is_compliant
        approaches = rigid and contact.is_touching and contact.rate[0] < -ws.tolerance.velocity
        contact.takes_over = approaches
        if approaches and closed_coincident(ws, c) < 0:
            return False
    remember(ws)
    which = -1
    for c in range(ws.island.n_contacts):
        if ws.contacts[c].takes_over and replace_coincident(ws, c):
            # unless another one that approaches more has taken its twin's place
            which = c
    group_touching(ws)
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        if _fastest_approach(ws) >= 0:
            _stop_active(ws)
    record_event(ws, Cause.FEATURE_CHANGE, which, 0)
    return True
