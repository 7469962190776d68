"""How long averaged forces hold: where they lead bodies apart, or into each other, they are averaged for less.

Forces of an averaging are those of the bodies as they lie where it begins.  A contact point that runs along a body, or
a wedge that turns, changes what they do before it is over.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_bodies, evaluate_free_bodies
from nonsmooth.engine.bodies.compliance import copy_inner_states
from nonsmooth.engine.bodies.kinematics import evaluate_contact, evaluate_geometry
from nonsmooth.engine.contact.mean_forces import averaging_span, find_mean_impulses, gap_after, take_mean_forces
from nonsmooth.engine.delassus.delassus import add_response
from nonsmooth.engine.flow.self_check import ALLOWED, energies_of_bodies, scale_energy, tolerated_gap
from nonsmooth.engine.native.kernel import Workspace, kernel

_ALLOWED_PART = 0.1
"""Gaps leave the way that forces meant for them by no more than this part of what the tolerances explain, of a gap and
of the work that it is to the force."""
_LARGEST_DEVIATION = 0.5
"""Of that, so much is foreseen at most: what is beyond the second order of time is not."""
_SMALLEST_FACTOR = 0.1
"""An averaging is cut to no less than this part at once."""


@kernel()
def _normalise(ws: Workspace) -> None:
    """Bring the unit quaternions in ``y_stage`` to unit length."""
    for number in range(ws.model.n_bodies):
        body = ws.bodies[number]
        if body.quaternion < 0:
            continue
        q, square = ws.step.y_stage.start + body.q + body.quaternion, 0.0
        for i in range(4):
            square += ws.floats[q + i] * ws.floats[q + i]
        for i in range(4):
            ws.floats[q + i] /= math.sqrt(square)


@kernel("void(ws, f8)")
def _extrapolate(ws: Workspace, time: float) -> None:
    """Evaluate bodies and gaps of the active contacts where their impulses lead in a ``time``, to its second order."""
    change, velocities = ws.step.y_guess.start + ws.model.n_q, ws.step.y_stage.start + ws.model.n_q
    for i in range(ws.model.n_u):
        ws.floats[change + i] = time * ws.island.du[i]
    add_response(ws, ws.problem.forces.start, change)
    for i in range(ws.model.n_y):
        ws.step.y_stage[i] = ws.island.y[i]
    for i in range(ws.model.n_u):
        ws.floats[velocities + i] += 0.5 * ws.floats[change + i]
    evaluate_free_bodies(ws, ws.island.time, ws.step.y_stage.start, of_all_bodies=True)
    for number in range(ws.model.n_bodies):
        body = ws.bodies[number]
        for i in range(body.n_q):
            ws.step.y_stage[body.q + i] += time * ws.floats[body.tail + i]
    _normalise(ws)
    evaluate_bodies(ws, ws.island.time + time, ws.step.y_stage.start)
    for a in range(ws.problem.n_active):
        evaluate_geometry(ws, ws.actives[a].contact)


@kernel("f8(ws)")
def _allowed_work(ws: Workspace) -> float:
    """Return what a force that leads a gap astray may do unasked: that part of what steps explain of an energy [J]."""
    return float(_ALLOWED_PART * ALLOWED * ws.tolerance.relative * (energies_of_bodies(ws)[0] + scale_energy(ws)))


@kernel("f8(ws, i8, f8, f8, f8)")
def _relative_deviation(ws: Workspace, c: int, way: float, force: float, work: float) -> float:
    """Return how far contact ``c`` is astray by a ``way``, relative to what it may as a ``force`` does a ``work``.

    What counts as closed is not astray.
    """
    allowed = _ALLOWED_PART * tolerated_gap(ws, c)
    if force * allowed > work:
        allowed = work / force
    return float(abs(way) / max(ws.tolerance.gap, allowed))


@kernel("f8(ws, f8)")
def _largest_deviation(ws: Workspace, time: float) -> float:
    """Return how far the impulses of the active contacts in a ``time`` lead gaps astray, relative to what they may.

    Only contacts that are pressed count; the others are free to open.
    """
    work = _allowed_work(ws)
    for a in range(ws.problem.n_active):
        ws.actives[a].gap_after = gap_after(ws, a, time)
    _extrapolate(ws, time)
    worst = 0.0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        contact = ws.contacts[active.contact]
        if not contact.is_compliant and active.normal_force > 0.0 and contact.past_feature <= 0.0:
            way, force = contact.gap - active.gap_after, active.normal_force / time
            part = _relative_deviation(ws, active.contact, way, force, work)
            # where a gap has no number the forces do not hold
            worst = max(worst, part) if part == part else math.inf
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    copy_inner_states(ws, ws.island.y.start)
    for a in range(ws.problem.n_active):
        evaluate_contact(ws, ws.actives[a].contact, 3)
    return worst


@kernel("void(ws, b1)")
def find_mean_forces(ws: Workspace, follows: bool) -> None:
    """Write the mean forces of the active contacts, and what these do at the end of the averaging.

    Their rates and the accelerations without forces must be written.  The ``active_forces`` are those, too.  An
    averaging that follows another one (1) may be longer; none is longer than its forces hold.
    """
    time = find_mean_impulses(ws, averaging_span(ws, follows))
    deviation_of_gaps = _largest_deviation(ws, time)
    while deviation_of_gaps > _LARGEST_DEVIATION and time > ws.tolerance.time:
        # the way of gaps astray grows with the third power of time where a Jacobian turns, with the second else
        part = max(_SMALLEST_FACTOR, 0.8 * math.sqrt(_LARGEST_DEVIATION / deviation_of_gaps)) if deviation_of_gaps < math.inf else _SMALLEST_FACTOR
        time = find_mean_impulses(ws, max(ws.tolerance.time, part * time))
        deviation_of_gaps = _largest_deviation(ws, time)
    take_mean_forces(ws, time)


@kernel("f8(ws)")
def deviation_of_gaps(ws: Workspace) -> float:
    """Return how far averaged forces lead a gap astray at most, as it stands, relative to what they may; keep which."""
    work = _allowed_work(ws)
    ws.island.strayed = 0.0
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        if not contact.is_averaged or contact.is_compliant or contact.past_feature > 0.0:
            continue
        # what was left of it may close, and one that opens comes to rest
        way = abs(contact.gap - contact.mean_gap) - abs(contact.mean_gap) - contact.mean_gap_change
        part = _relative_deviation(ws, c, max(0.0, way), contact.mean_force[0], work)
        if part > ws.island.strayed:
            ws.island.strayed, ws.island.stray_contact = part, c
    return float(ws.island.strayed)
