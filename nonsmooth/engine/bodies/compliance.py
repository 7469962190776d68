"""Compliant contacts: their normal force is given by gap and gap rate, and the rest of it by laws of traction.

A compliant contact is open or closed as any other, but closed it holds no gap: it pushes.  Its friction may hold it
(STICK), against the bound that the given normal force sets, or rub; a law of traction rubs always.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.kinematics import evaluate_row_response, push_response, wrench_row
from nonsmooth.engine.memory.blocks import FORCE_AND_MOMENT, GAP, GEOMETRY, SPIN, TRACTION, TRACTION_MOMENT
from nonsmooth.engine.memory.layout import N_ACCOUNTS
from nonsmooth.engine.memory.modes import OPEN, STICK
from nonsmooth.engine.native.kernel import (
    Floats,
    Integers,
    Scalars,
    at,
    call_compliance,
    call_rates,
    call_traction,
    kernel,
)


@kernel("void(S, F, I, i8)")
def evaluate_compliant_force(S: Scalars, w: Floats, k: Integers, c: int) -> None:
    """Write the normal force of the compliant contact ``c``, its geometry and rates being known."""
    w[S.compliant_force + c] = call_compliance(
        k[S.normal_function + c],
        -w[S.geometry + GEOMETRY * c + GAP],
        -w[S.rate + 3 * c],
        w[S.closing_rate + c],
        at(w, k[S.normal_parameters + c]),
    )


@kernel("void(S, F, I, i8)")
def _evaluate_motion(S: Scalars, w: Floats, k: Integers, c: int) -> None:
    """Write slip velocity and relative angular velocity of contact ``c`` along its unit tangents and normal."""
    a, b = k[S.frame_a + c] + SPIN, k[S.frame_b + c] + SPIN
    axes = S.axes + 9 * c
    for i in range(2):
        w[S.motion + i] = w[S.rate + 3 * c + 1 + i]
    for r in range(3):
        axis = axes + 3 * ((r + 1) % 3)
        total = 0.0
        for i in range(3):
            total += w[axis + i] * (w[b + i] - w[a + i])
        w[S.motion + 2 + r] = total


@kernel("void(S, F, I, i8, i8)")
def evaluate_traction(S: Scalars, w: Floats, k: Integers, c: int, y: int) -> None:
    """Let the law of traction of contact ``c`` write force, moment and rates of its states."""
    _evaluate_motion(S, w, k, c)
    out = k[S.traction_out + c]
    call_traction(
        k[S.traction_function + c],
        w[S.compliant_force + c],
        at(w, S.motion),
        at(w, state_at(S, k, c, y)),
        at(w, k[S.traction_parameters + c]),
        at(w, out),
    )
    w[S.turned + c] = 0.0
    for i in range(3):
        w[S.turned + c] += w[out + TRACTION_MOMENT + i] * w[S.motion + 2 + i]


@kernel("i8(S, I, i8, i8)")
def state_at(S: Scalars, k: Integers, c: int, y: int) -> int:
    """Return where the inner states of the laws of contact ``c`` stand."""
    return int(y + S.n_q + S.n_u + N_ACCOUNTS + k[S.state + c])


@kernel("void(S, F, I, i8)")
def refresh_states(S: Scalars, w: Floats, k: Integers, y: int) -> None:
    """Let the friction coefficients see the inner states as they are at ``y``."""
    if S.n_states == 0:
        return
    for c in range(S.n_contacts):
        if k[S.state_copy + c] > 0:
            for i in range(k[S.n_state + c]):
                w[k[S.state_copy + c] + i] = w[state_at(S, k, c, y) + i]


@kernel("void(S, F, I, i8)")
def begin_contact(S: Scalars, w: Floats, k: Integers, c: int) -> None:
    """Let the inner states of contact ``c``, which closes, start anew, and keep the rate at which it does."""
    w[S.closing_rate + c] = max(0.0, -w[S.rate + 3 * c])
    for i in range(k[S.n_state + c]):
        w[state_at(S, k, c, S.y) + i] = w[k[S.state_start + c] + i]


@kernel("void(S, F, I, i8, i8)")
def write_state_rates(S: Scalars, w: Floats, k: Integers, y: int, out: int) -> None:
    """Write the rates of the inner states of all contacts to the slope ``out``; those of open contacts are zero."""
    if S.n_states == 0:
        return
    for i in range(S.n_states):
        w[out + S.n_q + S.n_u + N_ACCOUNTS + i] = 0.0
    for c in range(S.n_contacts):
        n = k[S.n_state + c]
        if n == 0 or k[S.mode + c] == OPEN:
            continue
        source = k[S.traction_out + c] + FORCE_AND_MOMENT
        if k[S.state_copy + c] > 0:
            source = k[S.rates_out + c]
            v1, v2 = w[S.rate + 3 * c + 1], w[S.rate + 3 * c + 2]
            speed = 0.0 if k[S.mode + c] == STICK else math.sqrt(v1 * v1 + v2 * v2)
            states, parameters = at(w, state_at(S, k, c, y)), at(w, k[S.rates_parameters + c])
            call_rates(k[S.rates_function + c], speed, states, parameters, at(w, source))
        for i in range(n):
            w[state_at(S, k, c, out) + i] = w[source + i]


@kernel("void(S, F, I, i8, i8)")
def lay_wrench(S: Scalars, w: Floats, k: Integers, c: int, f: int) -> None:
    """Write row 1 and response 0 of all that the compliant contact ``c`` does, its forces standing at ``f``."""
    axes, force, moment = S.axes + 9 * c, S.wrench, S.wrench + 3
    for i in range(3):
        w[force + i] = w[moment + i] = 0.0
        for r in range(3):
            w[force + i] += w[f + r] * w[axes + 3 * r + i]
        if k[S.traction_function + c] != 0:
            out = k[S.traction_out + c] + TRACTION_MOMENT
            for r in range(3):
                w[moment + i] += w[out + r] * w[axes + 3 * ((r + 1) % 3) + i]
    wrench_row(S, w, k, c, 1, force, moment)
    evaluate_row_response(S, w, k, c, 1, 0)


@kernel("void(S, F, I, i8, i8, i8)")
def rub_by_traction(S: Scalars, w: Floats, k: Integers, c: int, f: int, y: int) -> None:
    """Write the forces of a contact with a law of traction to ``f``."""
    evaluate_traction(S, w, k, c, y)
    w[f] = w[S.compliant_force + c]
    for r in range(2):
        w[f + 1 + r] = w[k[S.traction_out + c] + TRACTION + r]


@kernel()
def push_compliant(S: Scalars, w: Floats, k: Integers) -> None:
    """Add to ``du`` what the touching compliant contacts are known to do, all of it or the normal force alone."""
    for c in range(S.n_contacts):
        if k[S.normal_function + c] == 0 or k[S.touching + c] == 0:
            continue
        if k[S.traction_function + c] != 0:
            rub_by_traction(S, w, k, c, S.force + 3 * c, S.y)
            lay_wrench(S, w, k, c, S.force + 3 * c)
            push_response(S, w, k, c, 0, 1.0, S.du)
        else:
            push_response(S, w, k, c, 0, w[S.compliant_force + c], S.du)


@kernel("i8(S, F, I, i8)")
def rubs_unasked(S: Scalars, w: Floats, k: Integers, c: int) -> int:
    """Return 1 if the friction of the compliant contact ``c`` is no question: by a law of traction, or without load."""
    return 1 if k[S.traction_function + c] != 0 or w[S.compliant_force + c] <= 0.0 else 0


@kernel()
def decouple_normals(S: Scalars, w: Floats, k: Integers) -> None:
    """Leave of the normal forces of the active compliant contacts what the friction sees: a given load.

    What they do is in the free accelerations already.  Their rows and columns of G become those of contacts that
    nothing couples, whose forces come out as given.
    """
    for a in range(S.n_active):
        row = S.block_start + S.first_grouped + a
        rigid = k[S.normal_function + k[S.active + a]] == 0
        for block in range(k[row], k[row + 1]):
            g, d = S.delassus + 9 * block, k[S.block_column + block]
            if d == a and not rigid:
                own = w[g] if w[g] > 0.0 else 1.0
                w[S.b + 3 * a] = -own * w[S.compliant_force + k[S.active + a]]
                for i in range(1, 3):
                    w[g + i] = w[g + 3 * i] = 0.0
                w[g] = own
                continue
            for i in range(3):
                if not rigid:
                    w[g + i] = 0.0
                if k[S.normal_function + k[S.active + d]] != 0:
                    w[g + 3 * i] = 0.0
