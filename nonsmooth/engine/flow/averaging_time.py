"""Length of an averaging span: it is shortened if its forces lead bodies apart or into each other.

The mean forces of a span are found with the Jacobians at its start. A contact point that runs along a body, or a wedge
that turns, changes these Jacobians before the span ends. So the motion under the forces is extrapolated to the end of
the span, to second order in time, and the true gaps there are compared with those of the linear model. If they deviate
too much, the span is shortened and its forces are found again. A fixed short span would be as safe, but costs many more
contact problems.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_bodies, evaluate_free_bodies
from nonsmooth.engine.bodies.compliance import copy_inner_states
from nonsmooth.engine.bodies.equations import coordinate_rates
from nonsmooth.engine.bodies.kinematics import evaluate_contact, evaluate_geometry
from nonsmooth.engine.contact.mean_forces import averaging_span, find_mean_impulses, gap_after, set_mean_forces
from nonsmooth.engine.delassus.delassus import add_response
from nonsmooth.engine.flow.self_check import energies_of_bodies, scale_energy, tolerated_gap
from nonsmooth.engine.flow.spins import square_of_quaternion
from nonsmooth.engine.native.kernel import ContactRecord, Workspace, kernel
from nonsmooth.engine.numerics.tolerances import ALLOWED

_ALLOWED_PART = 0.1
"""Deviation of a gap from the linear model that is allowed, relative to the allowed error of a gap, or of energy."""
_LARGEST_DEVIATION = 0.5
"""Predicted deviation that is accepted, relative to the allowed one. It is predicted to second order only."""
_SMALLEST_FACTOR = 0.1
"""Smallest factor by which a span is shortened at once."""


@kernel()
def _normalise(ws: Workspace) -> None:
    """Bring the quaternions in ``y_stage`` to unit length, which a straight extrapolation of the state has changed."""
    for body in ws.bodies:
        # a body without quaternion has -1
        if body.quaternion < 0:
            continue
        q = ws.step.y_stage.start + body.q + body.quaternion
        size = math.sqrt(square_of_quaternion(ws.floats, q))
        for i in range(4):
            ws.floats[q + i] /= size


@kernel("void(ws, f8)")
def _extrapolate(ws: Workspace, time: float) -> None:
    """Evaluate the bodies and the gaps of the active contacts after a ``time`` [s] under their impulses in ``forces``.

    The positions are of second order: they follow from the mean of the velocities at both ends of that time.
    ``y_guess`` and ``y_stage`` are overwritten.
    """
    # the change of the velocities is in y_guess, the extrapolated state in y_stage
    change, velocities = ws.step.y_guess.start + ws.model.n_q, ws.step.y_stage.start + ws.model.n_q
    for i in range(ws.model.n_u):
        ws.floats[change + i] = time * ws.island.du[i]
    add_response(ws, ws.problem.forces.start, change)
    for i in range(ws.model.n_y):
        ws.step.y_stage[i] = ws.island.y[i]
    for i in range(ws.model.n_u):
        # the mean velocity over that time
        ws.floats[velocities + i] += 0.5 * ws.floats[change + i]
    # the bodies turn these velocities into rates of their coordinates
    evaluate_free_bodies(ws, ws.island.time, ws.step.y_stage.start, of_all_bodies=True)
    for body in ws.bodies:
        rates = coordinate_rates(ws, body)
        for i in range(body.n_q):
            ws.step.y_stage[body.q + i] += time * rates[i]
    _normalise(ws)
    evaluate_bodies(ws, ws.island.time + time, ws.step.y_stage.start)
    for active in ws.actives:
        evaluate_geometry(ws, active.contact)


@kernel("f8(ws)")
def _allowed_work(ws: Workspace) -> float:
    """Work that a contact force may do by the deviation of its gap [J]: a part of the allowed error of the energy."""
    # kinetic energy, plus that of the velocity scales, so that it does not vanish at rest
    return float(_ALLOWED_PART * ALLOWED * ws.tolerance.relative * (energies_of_bodies(ws)[0] + scale_energy(ws)))


@kernel("f8(ws, ContactRecord, f8, f8, f8)")
def _relative_deviation(ws: Workspace, contact: ContactRecord, deviation: float, force: float, work: float) -> float:
    """Absolute ``deviation`` of a gap [m] from the linear model, relative to the allowed deviation.

    Allowed is a part of the gap that the tolerances allow, but not more than lets the ``force`` [N] do the ``work``
    [J]. A deviation by the gap tolerance is always allowed.
    """
    allowed = _ALLOWED_PART * tolerated_gap(ws, contact.index)
    if force * allowed > work:
        allowed = work / force
    return float(abs(deviation) / max(ws.tolerance.gap, allowed))


@kernel("f8(ws, f8)")
def _largest_deviation(ws: Workspace, time: float) -> float:
    """Largest deviation of a gap from the linear model after a ``time`` [s] of impulses, relative to the allowed one.

    Only rigid contacts with a normal force count, as the others may open. Past the end of its features a contact has no
    true gap. Without any that counts it is 0; a gap that is not a number makes it infinite. Afterwards bodies and
    contacts are evaluated at the present state again.
    """
    work = _allowed_work(ws)
    for active in ws.actives:
        active.gap_after = gap_after(ws, active.index, time)
    _extrapolate(ws, time)
    worst = 0.0
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        if not contact.is_compliant and active.normal_force > 0.0 and contact.past_feature <= 0.0:
            # the normal force is an impulse here
            deviation, force = contact.gap - active.gap_after, active.normal_force / time
            relative = _relative_deviation(ws, contact, deviation, force, work)
            # a number that is not equal to itself is not a number
            worst = max(worst, relative) if relative == relative else math.inf
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    copy_inner_states(ws, ws.island.y.start)
    for active in ws.actives:
        evaluate_contact(ws, active.contact, rows=3)
    return worst


@kernel("void(ws, b1)")
def find_mean_forces(ws: Workspace, follows: bool) -> None:
    """Write the mean forces of the active contacts over an averaging span [N], and the modes at the end of the span.

    The span is shortened until the gaps at its end agree with the linear model by which the forces are found, at most
    to the time tolerance, whose forces are taken as they are. Rates and accelerations without contact forces must be
    written. A span that ``follows`` another one may be longer.
    """
    time = find_mean_impulses(ws, averaging_span(ws, follows))
    deviation = _largest_deviation(ws, time)
    while deviation > _LARGEST_DEVIATION and time > ws.tolerance.time:
        # the deviation grows with the third power of time if a Jacobian turns, else with the second; 0.8 is a margin
        is_finite = deviation < math.inf
        part = max(_SMALLEST_FACTOR, 0.8 * math.sqrt(_LARGEST_DEVIATION / deviation)) if is_finite else _SMALLEST_FACTOR
        time = find_mean_impulses(ws, max(ws.tolerance.time, part * time))
        deviation = _largest_deviation(ws, time)
    set_mean_forces(ws, time)


@kernel("f8(ws)")
def deviation_of_gaps(ws: Workspace) -> float:
    """Largest deviation of a gap under averaged forces from the linear model, relative to the allowed one.

    Writes it to ``strayed``, and its contact to ``stray_contact``. If it is above 1, the next step begins by ending the
    averaging span. Compliant contacts and those past the end of their features do not count. The contacts must be
    evaluated at the end of a step.
    """
    work = _allowed_work(ws)
    ws.island.strayed = 0.0
    for contact in ws.contacts:
        if not contact.is_averaged or contact.is_compliant or contact.past_feature > 0.0:
            continue
        # mean_gap is the gap at the start of the span: an open one may close, and one that opens comes to rest
        deviation = abs(contact.gap - contact.mean_gap) - abs(contact.mean_gap) - contact.mean_gap_change
        # less than these motions is no deviation; number 0 of the force is the normal one
        relative = _relative_deviation(ws, contact, max(0.0, deviation), force=contact.mean_force[0], work=work)
        if relative > ws.island.strayed:
            ws.island.strayed, ws.island.stray_contact = relative, contact.index
    return float(ws.island.strayed)
