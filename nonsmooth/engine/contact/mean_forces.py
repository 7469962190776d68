"""Forces of an island that are constant over a contact time, where those of the instant lead nowhere.

A step of Moreau's rule over the time T: with z0 the rates at its start, b the accelerations without forces, and
z1 = z0 + T (b + G f) the rates at its end, 0 <= z1_N, f_N >= 0, z1_N f_N = 0, and friction on Coulomb's cone against
the slip z1_T, or holding it at zero.  There is always a solution, as there need not be one of the instant; what happens
within T is not told apart, as nothing rigid tells it in less than a contact time.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.compliance import decouple_normals
from nonsmooth.engine.bodies.kinematics import row
from nonsmooth.engine.contact.inelastic import inelastic_impulses
from nonsmooth.engine.contact.trial import tangential_inverse_mass
from nonsmooth.engine.delassus.delassus import add_product, assemble_delassus
from nonsmooth.engine.memory.layout import FIRST_ROW, NORMAL_ROW, SECOND_ROW
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Workspace, kernel
from nonsmooth.engine.numerics.vectors import length

_LONGEST = 50.0
"""Forces are averaged over so many contact times at most."""


@kernel("b1(ws)")
def is_averaged(ws: Workspace) -> bool:
    """Return 1 if the forces of the active contacts are averaged."""
    for a in range(ws.problem.n_active):
        if ws.contacts[ws.actives[a].contact].is_averaged:
            return True
    return False


@kernel("f8(ws)")
def averaging_time(ws: Workspace) -> float:
    """Return over what time the forces of the active contacts may be averaged [s]: the shortest contact time.

    It is 0 where one has none, or all give way.
    """
    time = math.inf
    for a in range(ws.problem.n_active):
        contact = ws.contacts[ws.actives[a].contact]
        if not contact.is_compliant:
            time = min(time, contact.contact_time)
    return time if time < math.inf else 0.0


@kernel("b1(ws)")
def is_settled(ws: Workspace) -> bool:
    """Return 1 if no active contact slips so slowly that its friction would stop it within a contact time."""
    for a in range(ws.problem.n_active):
        contact = ws.contacts[ws.actives[a].contact]
        speed = length(contact.slip)
        friction = length((contact.force[1], contact.force[2]))
        slow = speed <= contact.contact_time * contact.slip_per_force * friction
        if slow and speed > ws.tolerance.velocity and contact.force[0] > 0.0:
            return False
    return True


@kernel("f8(ws, b1)")
def averaging_span(ws: Workspace, follows: bool) -> float:
    """Return over what time the forces of the active contacts are averaged next [s]; as long as they can if it follows.

    That is what the last averaging, to the end of which they came, left of accuracy.
    """
    least = averaging_time(ws)
    if not follows:
        return float(least)
    span = _LONGEST * least
    for a in range(ws.problem.n_active):
        contact = ws.contacts[ws.actives[a].contact]
        if contact.is_averaged:
            span = min(span, contact.mean_span if contact.mean_span > 0.0 else least)
    return float(span)


@kernel()
def measure_spans(ws: Workspace) -> None:
    """Write how long the next averaging may be: the rates of gaps that one leaves grow with its square.

    One that was shorter than a contact time for the way of gaps may be twice as long.
    """
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        if contact.is_averaged:
            left = max(abs(contact.rate[0]), 0.25 * ws.tolerance.velocity)
            accurate = contact.mean_span * math.sqrt(ws.tolerance.velocity / left)
            contact.mean_span = max(accurate, min(2.0 * contact.mean_span, contact.contact_time))


@kernel("void(ws, f8)")
def _keep_span(ws: Workspace, span: float) -> None:
    """Keep the span of this averaging if all active contacts end it as they ended the last, else half of it.

    A contact time is not halved: what happens within it is not told apart.
    """
    kept = span
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if ws.contacts[active.contact].mode_after_averaging != active.mode_tried:
            kept = max(0.5 * span, min(span, averaging_time(ws)))
    for a in range(ws.problem.n_active):
        ws.contacts[ws.actives[a].contact].mean_span = kept


@kernel("b1(ws, f8)")
def _solve(ws: Workspace, time: float) -> bool:
    """Write the impulses of the active contacts in a ``time`` to ``active_forces``; return 1 if they are found."""
    assemble_delassus(ws)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        contact = ws.contacts[active.contact]
        contact.slip_per_force = tangential_inverse_mass(ws, active)
        for r in range(3):
            active.free[r] = contact.bias[r] + row(ws, active.contact, r, ws.island.du.start)
            active.force[r] = time * contact.mean_force[r] if contact.is_averaged else 0.0
        # what is left of a gap may close
        active.free[0] += max(0.0, contact.gap) / (time * time)
    decouple_normals(ws)
    return int(inelastic_impulses(ws, time))


@kernel("f8(ws, f8)")
def find_mean_impulses(ws: Workspace, time: float) -> float:
    """Write the impulses of the active contacts to ``active_forces``; return in what time: the ``time``, or a shorter.

    Their rates and the accelerations without forces must be written.
    """
    if not _solve(ws, time) and time > averaging_time(ws):
        time = averaging_time(ws)
        _solve(ws, time)
    return time


@kernel("f8(ws, i8, f8)")
def gap_after(ws: Workspace, a: int, time: float) -> float:
    """Return the gap of an active contact after its impulses in a ``time``, as if no row of a Jacobian changed [m]."""
    active = ws.actives[a]
    contact = ws.contacts[active.contact]
    rate = add_product(ws, active.free[0], a, NORMAL_ROW, ws.problem.forces.start)
    # of these rates those that close the gap are part
    closing = max(0.0, contact.gap)
    return float(contact.gap - 0.5 * closing + 0.5 * time * (contact.rate[0] + rate))


@kernel("void(ws, f8)")
def take_mean_forces(ws: Workspace, time: float) -> None:
    """Let the impulses of the active contacts be given in a ``time`` from now on; write what they do at its end.

    The ``active_forces`` become mean forces, too.
    """
    ws.island.averaged_until = min(ws.island.averaged_until, ws.island.time + time)
    ws.island.strayed = 0.0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        v1 = add_product(ws, active.free[1], a, FIRST_ROW, ws.problem.forces.start)
        v2 = add_product(ws, active.free[2], a, SECOND_ROW, ws.problem.forces.start)
        speed = length((v1, v2))
        active.mode_tried = Mode.OPEN
        if active.normal_force > 0.0:
            active.mode_tried = Mode.SLIDE if speed > ws.tolerance.velocity else Mode.STICK
        active.direction = v1 / speed if speed > 0.0 else 1.0, v2 / speed if speed > 0.0 else 0.0
    _keep_span(ws, time)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        contact = ws.contacts[active.contact]
        # a gap that opens comes to rest there
        way = time * max(0.0, contact.rate[0])
        contact.mean_gap_change = way + (contact.mean_gap_change if contact.is_averaged else 0.0)
        contact.mode_after_averaging = active.mode_tried
        contact.mean_gap = contact.gap
        for r in range(3):
            active.force[r] /= time
            contact.mean_force[r] = active.force[r]
