"""Angular velocities along axes that turn with their body, integrated along axes that do not.

Along its own axes a force on a body that spins turns as fast as the body does, in space as slowly as the motion asks
for.  The angular velocity w of a body with attitude R is integrated as R w, whose rate is R w', and turned back with
the attitude of every stage; everything else knows its components along the body.  That is for bodies which ask for it
(:attr:`nonsmooth.interfaces.Body.spin`): what an asymmetric one has of its own is slower along its axes.  A spin that
keeps its direction, as in a plane, has it in space and along the body alike, and is left along the body.
"""

from __future__ import annotations

import math

from nonsmooth.engine.memory.layout import LAST_STAGE, N_STAGES
from nonsmooth.engine.native.kernel import Floats, Workspace, kernel
from nonsmooth.engine.numerics.runge_kutta import dense_part, stage_part, weigh_part
from nonsmooth.engine.numerics.vectors import Vector, cross, dot

_TO_SPACE, _TO_BODY = 1.0, -1.0
"""Sign of the scalar part of the quaternion that turns a vector there."""
_SMALLEST_SINE = 1e-9
"""Sine of the angle between a spin and its rate, along the body, up to which it keeps its direction: that of motion in
a plane is round-off, 1e-16, and a step in which a spin turns by so much of its change is as long in either axes."""


@kernel("void(F, i8, i8, f8, i8)")
def _rotate(w: Floats, q: int, v: int, way: float, out: int) -> None:
    """Write the vector at ``v`` turned by the quaternion at ``q``, of any length, to space (1) or back (-1)."""
    a, axis = way * w[q], (w[q + 1], w[q + 2], w[q + 3])
    x, y, z = w[v], w[v + 1], w[v + 2]
    tx, ty, tz = cross(axis, (x, y, z))
    sx, sy, sz = cross(axis, (tx, ty, tz))
    twice = 2.0 / (a * a + dot(axis, axis))
    w[out] = x + twice * (a * tx + sx)
    w[out + 1] = y + twice * (a * ty + sy)
    w[out + 2] = z + twice * (a * tz + sz)


@kernel("i8(ws, i8)")
def _slopes_of(ws: Workspace, number: int) -> int:
    """Return where the slopes in space of one body's spin stand, those of one stage behind those of another."""
    return int(ws.island.spin_slopes.start + 3 * N_STAGES * number)


@kernel("b1(F, i8, i8)")
def _changes_direction(w: Floats, spin: int, rate: int) -> bool:
    """Return 1 if a spin does not keep its direction."""
    u, v = (w[spin], w[spin + 1], w[spin + 2]), (w[rate], w[rate + 1], w[rate + 2])
    across = cross(u, v)
    return dot(across, across) > _SMALLEST_SINE * _SMALLEST_SINE * dot(u, u) * dot(v, v)


@kernel()
def choose_spins_in_space(ws: Workspace) -> None:
    """List the bodies whose spin turns from where the step begins: it is integrated along axes in space."""
    ws.island.n_spinning = 0
    for i in range(ws.island.n_integrated):
        number = ws.island.integrated[i]
        body = ws.bodies[number]
        u = ws.model.n_q + body.u + body.spin
        body.spins_apart = (
            _changes_direction(ws.floats, ws.island.y.start + u, ws.island.slopes.start + u) if body.spin >= 0 else False
        )
        if body.spins_apart:
            ws.island.spinning[ws.island.n_spinning] = number
            ws.island.n_spinning += 1


@kernel("void(ws, i8, i8)")
def store_spin_slope(ws: Workspace, stage: int, state: int) -> None:
    """Keep the slopes of a stage, evaluated at ``state``, along axes in space; before the first one the spins, too.

    Those of its quaternions become what they are at the length that these had.
    """
    for i in range(ws.island.n_spinning):
        number = ws.island.spinning[i]
        body = ws.bodies[number]
        q, u = body.q + body.quaternion, ws.model.n_q + body.u + body.spin
        slope = ws.island.slopes.start + stage * ws.model.n_y
        _rotate(ws.floats, state + q, slope + u, _TO_SPACE, _slopes_of(ws, number) + 3 * stage)
        if stage == 0:
            _rotate(ws.floats, state + q, state + u, _TO_SPACE, ws.island.spin_start.start + 3 * number)
        elif stage < LAST_STAGE:
            for j in range(4):
                ws.floats[slope + q + j] *= ws.island.quaternion_length[number]


@kernel("void(ws, i8, f8, i8)")
def write_spins_of_stage(ws: Workspace, stage: int, h: float, out: int) -> None:
    """Write the spins of a stage to the state at ``out``, whose quaternions are those of the stage.

    They are brought to unit length where the step does not end: as long as they are the body would spin faster by
    their square.
    """
    for i in range(ws.island.n_spinning):
        number = ws.island.spinning[i]
        body = ws.bodies[number]
        q, u = out + body.q + body.quaternion, out + ws.model.n_q + body.u + body.spin
        stage_part(
            ws,
            ws.coefficients.stages.start,
            ws.island.spin_start.start + 3 * number,
            _slopes_of(ws, number),
            3,
            3,
            stage,
            h,
            u,
        )
        _rotate(ws.floats, q, u, _TO_BODY, u)
        if stage < LAST_STAGE:
            square = (
                ws.floats[q] * ws.floats[q]
                + ws.floats[q + 1] * ws.floats[q + 1]
                + ws.floats[q + 2] * ws.floats[q + 2]
                + ws.floats[q + 3] * ws.floats[q + 3]
            )
            size = math.sqrt(square)
            ws.island.quaternion_length[number] = size
            factor = 1.0 / size
            for j in range(4):
                ws.floats[q + j] *= factor


@kernel("void(ws, f8, i8)")
def write_spin_errors(ws: Workspace, h: float, out: int) -> None:
    """Write the errors of the spins in a step of ``h`` to ``out``, along the bodies where the step ends."""
    for i in range(ws.island.n_spinning):
        number = ws.island.spinning[i]
        body = ws.bodies[number]
        u = out + ws.model.n_q + body.u + body.spin
        weigh_part(ws, ws.coefficients.error_weights.start, _slopes_of(ws, number), 3, 3, h, u)
        _rotate(ws.floats, ws.step.y_new.start + body.q + body.quaternion, u, _TO_BODY, u)


@kernel("void(ws, i8, v3, v3, i8)")
def write_spin_within(ws: Workspace, number: int, early: Vector, late: Vector, out: int) -> None:
    """Write the spin of one body within the step to the state at ``out``, whose quaternion is the one there.

    An implicit step has its interpolant along the bodies.
    """
    body = ws.bodies[number]
    if not body.spins_apart or ws.island.stage_time > 0.0:
        return
    u = out + ws.model.n_q + body.u + body.spin
    dense_part(ws.floats, ws.island.spin_start.start + 3 * number, _slopes_of(ws, number), 3, 3, early, late, u)
    _rotate(ws.floats, out + body.q + body.quaternion, u, _TO_BODY, u)
