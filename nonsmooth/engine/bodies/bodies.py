"""Bodies, loads and linkages at a state: frames, forces, inverse masses."""

from __future__ import annotations

from nonsmooth.engine.bodies.kinematics import evaluate_contact
from nonsmooth.engine.bodies.linkages import evaluate_linkage
from nonsmooth.engine.memory.blocks import FORCE, FRAME, LOAD_MOMENT, LOAD_POINT
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, at, call_body, call_load, kernel, room
from nonsmooth.engine.native.watch import interrupted


@kernel("void(S, F, I, f8, i8, i8)")
def evaluate_body(S: Scalars, w: Floats, k: Integers, t: float, y: int, body: int) -> None:
    """Let one body write its output block at time ``t`` and the state at offset ``y``."""
    call_body(
        k[S.body_function + body],
        t,
        at(w, y + k[S.body_q + body]),
        at(w, y + S.n_q + k[S.body_u + body]),
        at(w, k[S.body_parameters + body]),
        at(w, k[S.body_out + body]),
    )


@kernel("void(S, F, I, f8, i8)")
def evaluate_driven_bodies(S: Scalars, w: Floats, k: Integers, t: float, y: int) -> None:
    """Let the bodies without coordinates write their output blocks, unless they stand there already."""
    if t == S.driven_t:
        return
    S.driven_t = t
    for body in range(S.n_bodies):
        if k[S.body_nu + body] == 0:
            evaluate_body(S, w, k, t, y, body)


@room("void(S, F, I, f8, i8)")
def evaluate_free_bodies(S: Scalars, w: Floats, k: Integers, t: float, y: int) -> None:
    """Let the bodies that have coordinates write their output blocks, then loads and joints act on them."""
    interrupted(S, S.n_contacts + S.n_bodies)
    S.own = y + S.n_q
    S.driven_power = 0.0
    S.load_power = 0.0
    if S.n_loads + S.n_joints > 0:
        evaluate_driven_bodies(S, w, k, t, y)
    for body in range(S.n_bodies):
        n_u = k[S.body_nu + body]
        if n_u == 0:
            continue
        if S.n_loads > 0:
            # loads add to what a body may leave unwritten
            force = k[S.body_tail + body] + k[S.body_nq + body]
            for i in range(n_u):
                w[force + i] = 0.0
        evaluate_body(S, w, k, t, y, body)
    for load in range(S.n_loads):
        _apply(S, w, k, load, t, y)
    if S.n_joints > 0:
        for i in range(S.n_u):
            w[S.u_own + i] = w[y + S.n_q + i]
        S.own = S.u_own
        for linkage in range(S.n_linkages):
            if k[S.linkage_rows + linkage] > 0:
                evaluate_linkage(S, w, k, linkage)


@kernel("void(S, F, I, f8, i8)")
def evaluate_bodies(S: Scalars, w: Floats, k: Integers, t: float, y: int) -> None:
    """Let every body write its output block at time ``t`` and the state at offset ``y``."""
    evaluate_driven_bodies(S, w, k, t, y)
    evaluate_free_bodies(S, w, k, t, y)


@kernel("void(S, F, I, i8, f8, i8)")
def _apply(S: Scalars, w: Floats, k: Integers, load: int, t: float, y: int) -> None:
    """Add the generalised forces of one load to those of its bodies, and its power."""
    out = k[S.load_out + load]
    call_load(
        k[S.load_function + load],
        t,
        at(w, k[S.load_frame_a + load]),
        at(w, k[S.load_frame_b + load]),
        at(w, k[S.load_parameters + load]),
        at(w, out),
    )
    force_at, point, moment = out + FORCE, out + LOAD_POINT, out + LOAD_MOMENT
    for side in range(2):
        body = k[S.load_body_a + load] if side == 0 else k[S.load_body_b + load]
        frame = k[S.load_frame_a + load] if side == 0 else k[S.load_frame_b + load]
        n_u = k[S.body_nu + body]
        force = k[S.body_tail + body] + k[S.body_nq + body]
        sign = -1.0 if side == 0 else 1.0
        fx, fy, fz = sign * w[force_at], sign * w[force_at + 1], sign * w[force_at + 2]
        x, y_, z = w[point] - w[frame], w[point + 1] - w[frame + 1], w[point + 2] - w[frame + 2]
        mx = sign * w[moment] + y_ * fz - z * fy
        my = sign * w[moment + 1] + z * fx - x * fz
        mz = sign * w[moment + 2] + x * fy - y_ * fx
        for j in range(n_u):
            v = frame + FRAME + j
            o = v + 3 * n_u
            added = (
                fx * w[v] + fy * w[v + n_u] + fz * w[v + 2 * n_u] + mx * w[o] + my * w[o + n_u] + mz * w[o + 2 * n_u]
            )
            w[force + j] += added
            S.load_power += added * w[y + S.n_q + k[S.body_u + body] + j]


@room()
def evaluate_at(S: Scalars, w: Floats, k: Integers) -> None:
    """Evaluate all bodies and contacts at the present time and state."""
    evaluate_bodies(S, w, k, S.t, S.y)
    for c in range(S.n_contacts):
        evaluate_contact(S, w, k, c, 3)
