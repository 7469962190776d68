"""Bodies, loads and articulations at a state: frames, forces, inverse masses."""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.articulations import evaluate_articulation
from nonsmooth.engine.bodies.kinematics import evaluate_contact
from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.engine.native.kernel import (
    Workspace,
    at,
    call_body,
    call_load,
    entry_point,
    frame_at,
    kernel,
    load_wrench,
)
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.vectors import minus, opposite


@kernel("void(ws, f8, i8, i8)")
def _write(ws: Workspace, t: float, y: int, number: int) -> None:
    """Let one body write its output block at time ``t`` and the state at offset ``y``."""
    body = ws.bodies[number]
    q, u = at(ws.floats, y + body.q), at(ws.floats, y + ws.model.n_q + body.u)
    call_body(body.function, t, q, u, at(ws.floats, body.parameters), at(ws.floats, body.out))


@kernel("void(ws, f8, i8, i8)")
def evaluate_body(ws: Workspace, t: float, y: int, number: int) -> None:
    """Let one body write its output block at time ``t`` and the state at offset ``y``, which is a new version of it."""
    body = ws.bodies[number]
    _write(ws, t, y, number)
    body.version += 1
    if body.n_u > 0:
        ws.island.free_time = math.nan


@kernel("b1(ws, f8, i8, i8)")
def _stands(ws: Workspace, t: float, y: int, number: int) -> bool:
    """Return 1 if a body was evaluated last at this time and state."""
    body = ws.bodies[number]
    if body.version == 0 or body.evaluated_version != body.version or body.evaluated_time != t:
        return False
    for i in range(body.q, body.q + body.n_q):
        if ws.island.y_evaluated[i] != ws.floats[y + i]:
            return False
    for i in range(ws.model.n_q + body.u, ws.model.n_q + body.u + body.n_u):
        if ws.island.y_evaluated[i] != ws.floats[y + i]:
            return False
    return True


@kernel("void(ws, f8, i8, i8)")
def evaluate_once(ws: Workspace, t: float, y: int, number: int) -> None:
    """Do the same, but leave the version that stands if it is that already.

    What joints and loads do to a block is undone: it is written again, unless the body has none of them.
    """
    body = ws.bodies[number]
    if _stands(ws, t, y, number):
        if body.ballistic_function == 0:
            _write(ws, t, y, number)
        return
    evaluate_body(ws, t, y, number)
    body.evaluated_version, body.evaluated_time = body.version, t
    for i in range(body.q, body.q + body.n_q):
        ws.island.y_evaluated[i] = ws.floats[y + i]
    for i in range(ws.model.n_q + body.u, ws.model.n_q + body.u + body.n_u):
        ws.island.y_evaluated[i] = ws.floats[y + i]


@kernel("b1(ws, f8, i8)")
def _all_stand(ws: Workspace, t: float, y: int) -> bool:
    """Return 1 if all bodies with coordinates were evaluated last at this time and state, and nothing acts on them.

    Most of what an instant asks for is asked of bodies that stand.
    """
    if ws.island.free_time != t or ws.model.n_loads + ws.model.n_joints > 0:
        return False
    differ = 0
    for i in range(ws.model.n_q + ws.model.n_u):
        differ += 1 if ws.island.y_evaluated[i] != ws.floats[y + i] else 0
    return differ == 0


@kernel("void(ws, f8, i8)")
def evaluate_driven_bodies(ws: Workspace, t: float, y: int) -> None:
    """Let the bodies without coordinates write their output blocks, unless they stand there already."""
    if t == ws.island.driven_time:
        return
    ws.island.driven_time = t
    for number in range(ws.model.n_bodies):
        if ws.bodies[number].n_u == 0:
            evaluate_body(ws, t, y, number)


@kernel("void(ws, f8, i8)")
def evaluate_integrated_bodies(ws: Workspace, t: float, y: int) -> None:
    """Let the bodies that are integrated write their output blocks, where there are neither loads nor joints."""
    interrupted(ws, ws.island.n_contacts + ws.model.n_bodies)
    ws.island.velocities = y + ws.model.n_q
    ws.step.driven_power = 0.0
    ws.step.load_power = 0.0
    for i in range(ws.island.n_integrated):
        evaluate_body(ws, t, y, ws.island.integrated[i])


@entry_point("void(ws, f8, i8, b1)")
def evaluate_free_bodies(ws: Workspace, t: float, y: int, of_all_bodies: bool) -> None:
    """Let the bodies that have coordinates write their output blocks, then loads and joints act on them.

    That is every one of them (1), or those that are integrated.
    """
    if not of_all_bodies and ws.model.n_loads + ws.model.n_joints == 0:
        evaluate_integrated_bodies(ws, t, y)
        return
    interrupted(ws, ws.island.n_contacts + ws.model.n_bodies)
    ws.island.velocities = y + ws.model.n_q
    ws.step.driven_power = 0.0
    ws.step.load_power = 0.0
    if ws.model.n_loads + ws.model.n_joints > 0:
        evaluate_driven_bodies(ws, t, y)
    if of_all_bodies and _all_stand(ws, t, y):
        return
    for i in range(ws.model.n_bodies if of_all_bodies else ws.island.n_integrated):
        number = i if of_all_bodies else ws.island.integrated[i]
        body = ws.bodies[number]
        if body.n_u == 0:
            continue
        if ws.model.n_loads > 0 and body.ballistic_function == 0:
            # loads add to what a body may leave unwritten
            force = body.tail + body.n_q
            for j in range(body.n_u):
                ws.floats[force + j] = 0.0
        if of_all_bodies:
            evaluate_once(ws, t, y, number)
        else:
            evaluate_body(ws, t, y, number)
    if of_all_bodies:
        ws.island.free_time = t
    for load in range(ws.model.n_loads):
        _apply(ws, load, t, y)
    if ws.model.n_joints > 0:
        for i in range(ws.model.n_u):
            ws.island.u_free[i] = ws.floats[y + ws.model.n_q + i]
        ws.island.velocities = ws.island.u_free.start
        for number in range(ws.model.n_articulations):
            if ws.articulations[number].n_rows > 0:
                evaluate_articulation(ws, number)


@kernel("void(ws, f8, i8)")
def evaluate_bodies(ws: Workspace, t: float, y: int) -> None:
    """Let every body write its output block at time ``t`` and the state at offset ``y``."""
    evaluate_driven_bodies(ws, t, y)
    evaluate_free_bodies(ws, t, y, of_all_bodies=True)


@kernel("void(ws, i8, f8, i8)")
def _apply(ws: Workspace, number: int, t: float, y: int) -> None:
    """Add the generalised forces of one load to those of its bodies, and its power."""
    load = ws.loads[number]
    frame_a, frame_b = at(ws.floats, load.frame_a), at(ws.floats, load.frame_b)
    call_load(load.function, t, frame_a, frame_b, at(ws.floats, load.parameters), at(ws.floats, load.out))
    wrench = load_wrench(ws.floats, load.out)
    for side in range(2):
        body = ws.bodies[load.body_a if side == 0 else load.body_b]
        frame = load.frame_a if side == 0 else load.frame_b
        n_u = body.n_u
        generalised = body.tail + body.n_q
        force = opposite(wrench.force) if side == 0 else wrench.force
        moment = opposite(wrench.moment) if side == 0 else wrench.moment
        x, y_, z = minus(wrench.point, frame_at(ws.floats, frame).origin)
        fx, fy, fz = force
        mx = moment[0] + y_ * fz - z * fy
        my = moment[1] + z * fx - x * fz
        mz = moment[2] + x * fy - y_ * fx
        for j in range(n_u):
            v = frame + FRAME + j
            o = v + 3 * n_u
            added = (
                fx * ws.floats[v]
                + fy * ws.floats[v + n_u]
                + fz * ws.floats[v + 2 * n_u]
                + mx * ws.floats[o]
                + my * ws.floats[o + n_u]
                + mz * ws.floats[o + 2 * n_u]
            )
            ws.floats[generalised + j] += added
            ws.step.load_power += added * ws.floats[y + ws.model.n_q + body.u + j]


@entry_point()
def evaluate_at(ws: Workspace) -> None:
    """Evaluate all bodies and contacts at the present time and state."""
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    for c in range(ws.island.n_contacts):
        evaluate_contact(ws, c, 3)
