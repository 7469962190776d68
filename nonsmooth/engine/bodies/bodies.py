"""Bodies, loads and articulations at a state: frames, forces, inverse masses."""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.articulations import evaluate_articulation
from nonsmooth.engine.bodies.kinematics import evaluate_contact
from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.engine.native.kernel import (
    Floats,
    Integers,
    Scalars,
    articulation_at,
    at,
    body_at,
    call_body,
    call_load,
    entry_point,
    frame_at,
    kernel,
    load_at,
    load_wrench,
)
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.vectors import minus, opposite


@kernel("void(S, F, I, f8, i8, i8)")
def _write(S: Scalars, w: Floats, k: Integers, t: float, y: int, number: int) -> None:
    """Let one body write its output block at time ``t`` and the state at offset ``y``."""
    body = body_at(S, w, k, number)
    q, u = at(w, y + body.q), at(w, y + S.n_q + body.u)
    call_body(body.function, t, q, u, at(w, body.parameters), at(w, body.out))


@kernel("void(S, F, I, f8, i8, i8)")
def evaluate_body(S: Scalars, w: Floats, k: Integers, t: float, y: int, number: int) -> None:
    """Let one body write its output block at time ``t`` and the state at offset ``y``, which is a new version of it."""
    body = body_at(S, w, k, number)
    _write(S, w, k, t, y, number)
    body.version += 1
    if body.nu > 0:
        S.free_t = math.nan


@kernel("i8(S, F, I, f8, i8, i8)")
def _stands(S: Scalars, w: Floats, k: Integers, t: float, y: int, number: int) -> int:
    """Return 1 if a body was evaluated last at this time and state."""
    body = body_at(S, w, k, number)
    if body.version == 0 or body.stood != body.version or body.stood_t != t:
        return 0
    for i in range(body.q, body.q + body.nq):
        if w[S.y_stood + i] != w[y + i]:
            return 0
    for i in range(S.n_q + body.u, S.n_q + body.u + body.nu):
        if w[S.y_stood + i] != w[y + i]:
            return 0
    return 1


@kernel("void(S, F, I, f8, i8, i8)")
def evaluate_once(S: Scalars, w: Floats, k: Integers, t: float, y: int, number: int) -> None:
    """Do the same, but leave the version that stands if it is that already.

    What joints and loads do to a block is undone: it is written again, unless the body has none of them.
    """
    body = body_at(S, w, k, number)
    if _stands(S, w, k, t, y, number) == 1:
        if body.flight_function == 0:
            _write(S, w, k, t, y, number)
        return
    evaluate_body(S, w, k, t, y, number)
    body.stood, body.stood_t = body.version, t
    for i in range(body.q, body.q + body.nq):
        w[S.y_stood + i] = w[y + i]
    for i in range(S.n_q + body.u, S.n_q + body.u + body.nu):
        w[S.y_stood + i] = w[y + i]


@kernel("i8(S, F, I, f8, i8)")
def _all_stand(S: Scalars, w: Floats, k: Integers, t: float, y: int) -> int:
    """Return 1 if all bodies with coordinates were evaluated last at this time and state, and nothing acts on them.

    Most of what an instant asks for is asked of bodies that stand.
    """
    if S.free_t != t or S.n_loads + S.n_joints > 0:
        return 0
    differ = 0
    for i in range(S.n_q + S.n_u):
        differ += 1 if w[S.y_stood + i] != w[y + i] else 0
    return 1 if differ == 0 else 0


@kernel("void(S, F, I, f8, i8)")
def evaluate_driven_bodies(S: Scalars, w: Floats, k: Integers, t: float, y: int) -> None:
    """Let the bodies without coordinates write their output blocks, unless they stand there already."""
    if t == S.driven_t:
        return
    S.driven_t = t
    for number in range(S.n_bodies):
        if body_at(S, w, k, number).nu == 0:
            evaluate_body(S, w, k, t, y, number)


@kernel("void(S, F, I, f8, i8)")
def evaluate_integrated_bodies(S: Scalars, w: Floats, k: Integers, t: float, y: int) -> None:
    """Let the bodies that are integrated write their output blocks, where there are neither loads nor joints."""
    interrupted(S, S.n_contacts + S.n_bodies)
    S.free_velocities = y + S.n_q
    S.driven_power = 0.0
    S.load_power = 0.0
    for i in range(S.n_integrated):
        evaluate_body(S, w, k, t, y, k[S.integrated + i])


@entry_point("void(S, F, I, f8, i8, i8)")
def evaluate_free_bodies(S: Scalars, w: Floats, k: Integers, t: float, y: int, every: int) -> None:
    """Let the bodies that have coordinates write their output blocks, then loads and joints act on them.

    That is every one of them (1), or those that are integrated.
    """
    if every == 0 and S.n_loads + S.n_joints == 0:
        evaluate_integrated_bodies(S, w, k, t, y)
        return
    interrupted(S, S.n_contacts + S.n_bodies)
    S.free_velocities = y + S.n_q
    S.driven_power = 0.0
    S.load_power = 0.0
    if S.n_loads + S.n_joints > 0:
        evaluate_driven_bodies(S, w, k, t, y)
    if every == 1 and _all_stand(S, w, k, t, y) == 1:
        return
    for i in range(S.n_bodies if every == 1 else S.n_integrated):
        number = i if every == 1 else k[S.integrated + i]
        body = body_at(S, w, k, number)
        if body.nu == 0:
            continue
        if S.n_loads > 0 and body.flight_function == 0:
            # loads add to what a body may leave unwritten
            force = body.tail + body.nq
            for j in range(body.nu):
                w[force + j] = 0.0
        if every == 1:
            evaluate_once(S, w, k, t, y, number)
        else:
            evaluate_body(S, w, k, t, y, number)
    if every == 1:
        S.free_t = t
    for load in range(S.n_loads):
        _apply(S, w, k, load, t, y)
    if S.n_joints > 0:
        for i in range(S.n_u):
            w[S.u_free + i] = w[y + S.n_q + i]
        S.free_velocities = S.u_free
        for number in range(S.n_articulations):
            if articulation_at(S, w, k, number).rows > 0:
                evaluate_articulation(S, w, k, number)


@kernel("void(S, F, I, f8, i8)")
def evaluate_bodies(S: Scalars, w: Floats, k: Integers, t: float, y: int) -> None:
    """Let every body write its output block at time ``t`` and the state at offset ``y``."""
    evaluate_driven_bodies(S, w, k, t, y)
    evaluate_free_bodies(S, w, k, t, y, 1)


@kernel("void(S, F, I, i8, f8, i8)")
def _apply(S: Scalars, w: Floats, k: Integers, number: int, t: float, y: int) -> None:
    """Add the generalised forces of one load to those of its bodies, and its power."""
    load = load_at(S, w, k, number)
    frame_a, frame_b = at(w, load.frame_a), at(w, load.frame_b)
    call_load(load.function, t, frame_a, frame_b, at(w, load.parameters), at(w, load.out))
    wrench = load_wrench(w, load.out)
    for side in range(2):
        body = body_at(S, w, k, load.body_a if side == 0 else load.body_b)
        frame = load.frame_a if side == 0 else load.frame_b
        n_u = body.nu
        generalised = body.tail + body.nq
        force = opposite(wrench.force) if side == 0 else wrench.force
        moment = opposite(wrench.moment) if side == 0 else wrench.moment
        x, y_, z = minus(wrench.point, frame_at(w, frame).origin)
        fx, fy, fz = force
        mx = moment[0] + y_ * fz - z * fy
        my = moment[1] + z * fx - x * fz
        mz = moment[2] + x * fy - y_ * fx
        for j in range(n_u):
            v = frame + FRAME + j
            o = v + 3 * n_u
            added = (
                fx * w[v] + fy * w[v + n_u] + fz * w[v + 2 * n_u] + mx * w[o] + my * w[o + n_u] + mz * w[o + 2 * n_u]
            )
            w[generalised + j] += added
            S.load_power += added * w[y + S.n_q + body.u + j]


@entry_point()
def evaluate_at(S: Scalars, w: Floats, k: Integers) -> None:
    """Evaluate all bodies and contacts at the present time and state."""
    evaluate_bodies(S, w, k, S.t, S.y)
    for c in range(S.n_contacts):
        evaluate_contact(S, w, k, c, 3)
