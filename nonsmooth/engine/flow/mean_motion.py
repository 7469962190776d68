"""How long averaged forces hold: where they lead bodies apart, or into each other, they are averaged for less.

Forces of an averaging are those of the bodies as they lie where it begins.  A contact point that runs along a body, or
a wedge that turns, changes what they do before it is over.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_bodies, evaluate_free_bodies
from nonsmooth.engine.bodies.compliance import refresh_states
from nonsmooth.engine.bodies.kinematics import evaluate_contact, evaluate_geometry
from nonsmooth.engine.contact.mean_forces import averaging_span, find_mean_impulses, gap_after, take_mean_forces
from nonsmooth.engine.delassus.delassus import add_response
from nonsmooth.engine.flow.self_check import EXPLAINED, energy_of_bodies, scale_energy, tolerated_gap
from nonsmooth.engine.memory.modes import OPEN
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, active_at, body_at, contact_at, kernel

_SHARE = 0.1
"""Gaps leave the way that forces meant for them by no more than this part of what the tolerances explain, of a gap and
of the work that it is to the force."""
_AHEAD = 0.5
"""Of that, so much is foreseen at most: what is beyond the second order of time is not."""
_SHORTER = 0.1
"""An averaging is cut to no less than this part at once."""


@kernel("void(S, F, I)")
def _normalise(S: Scalars, w: Floats, k: Integers) -> None:
    """Bring the unit quaternions in ``y_stage`` to unit length."""
    for number in range(S.n_bodies):
        body = body_at(S, w, k, number)
        if body.quaternion < 0:
            continue
        q, square = S.y_stage + body.q + body.quaternion, 0.0
        for i in range(4):
            square += w[q + i] * w[q + i]
        for i in range(4):
            w[q + i] /= math.sqrt(square)


@kernel("void(S, F, I, f8)")
def _go_on(S: Scalars, w: Floats, k: Integers, time: float) -> None:
    """Evaluate bodies and gaps of the active contacts where their impulses lead in a ``time``, to its second order."""
    change, velocities = S.y_guess + S.n_q, S.y_stage + S.n_q
    for i in range(S.n_u):
        w[change + i] = time * w[S.du + i]
    add_response(S, w, k, S.active_forces, change)
    for i in range(S.n_y):
        w[S.y_stage + i] = w[S.y + i]
    for i in range(S.n_u):
        w[velocities + i] += 0.5 * w[change + i]
    evaluate_free_bodies(S, w, k, S.t, S.y_stage, 1)
    for number in range(S.n_bodies):
        body = body_at(S, w, k, number)
        for i in range(body.nq):
            w[S.y_stage + body.q + i] += time * w[body.tail + i]
    _normalise(S, w, k)
    evaluate_bodies(S, w, k, S.t + time, S.y_stage)
    for a in range(S.n_active):
        evaluate_geometry(S, w, k, active_at(S, w, k, a).slot)


@kernel("f8(S, F, I)")
def _explained_work(S: Scalars, w: Floats, k: Integers) -> float:
    """Return what a force that leads a gap astray may do unasked: that part of what steps explain of an energy [J]."""
    return float(_SHARE * EXPLAINED * S.rtol * (energy_of_bodies(S, w, k, 0) + scale_energy(S, w, k)))


@kernel("f8(S, F, I, i8, f8, f8, f8)")
def _astray(S: Scalars, w: Floats, k: Integers, c: int, way: float, force: float, work: float) -> float:
    """Return how far contact ``c`` is astray by a ``way``, relative to what it may as a ``force`` does a ``work``.

    What counts as closed is not astray.
    """
    allowed = _SHARE * tolerated_gap(S, w, k, c)
    if force * allowed > work:
        allowed = work / force
    return float(abs(way) / max(S.gap_tolerance, allowed))


@kernel("f8(S, F, I, f8)")
def _departure(S: Scalars, w: Floats, k: Integers, time: float) -> float:
    """Return how far the impulses of the active contacts in a ``time`` lead gaps astray, relative to what they may.

    Only contacts that are pressed count; the others are free to open.
    """
    work = _explained_work(S, w, k)
    for a in range(S.n_active):
        active_at(S, w, k, a).gap_meant = gap_after(S, w, k, a, time)
    _go_on(S, w, k, time)
    worst = 0.0
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        contact = contact_at(S, w, k, active.slot)
        if contact.normal_function == 0 and active.normal_force > 0.0 and contact.beyond <= 0.0:
            way, force = contact.gap - active.gap_meant, active.normal_force / time
            part = _astray(S, w, k, active.slot, way, force, work)
            # where a gap has no number the forces do not hold
            worst = max(worst, part) if part == part else math.inf
    evaluate_bodies(S, w, k, S.t, S.y)
    refresh_states(S, w, k, S.y)
    for a in range(S.n_active):
        evaluate_contact(S, w, k, active_at(S, w, k, a).slot, 3)
    return worst


@kernel("void(S, F, I, i8)")
def find_mean_forces(S: Scalars, w: Floats, k: Integers, follows: int) -> None:
    """Write the mean forces of the active contacts, and what these do at the end of the averaging.

    Their rates and the accelerations without forces must be written.  The ``active_forces`` are those, too.  An
    averaging that follows another one (1) may be longer; none is longer than its forces hold.
    """
    time = find_mean_impulses(S, w, k, averaging_span(S, w, k, follows))
    astray = _departure(S, w, k, time)
    while astray > _AHEAD and time > S.time_tolerance:
        # the way of gaps astray grows with the third power of time where a Jacobian turns, with the second else
        part = max(_SHORTER, 0.8 * math.sqrt(_AHEAD / astray)) if astray < math.inf else _SHORTER
        time = find_mean_impulses(S, w, k, max(S.time_tolerance, part * time))
        astray = _departure(S, w, k, time)
    take_mean_forces(S, w, k, time)


@kernel("f8(S, F, I)")
def astray(S: Scalars, w: Floats, k: Integers) -> float:
    """Return how far averaged forces lead a gap astray at most, as it stands, relative to what they may; keep which."""
    work = _explained_work(S, w, k)
    S.strayed = 0.0
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.averaged == OPEN or contact.normal_function != 0 or contact.beyond > 0.0:
            continue
        # what was left of it may close, and one that opens comes to rest
        way = abs(contact.gap - contact.mean_gap) - abs(contact.mean_gap) - contact.mean_way
        part = _astray(S, w, k, c, max(0.0, way), contact.mean_force[0], work)
        if part > S.strayed:
            S.strayed, S.stray = part, c
    return float(S.strayed)
