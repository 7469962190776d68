"""Spins along axes in space: the angular velocities of fast spinning bodies are integrated along axes that do not turn.

In the axes of the body, a force on a spinning body turns as fast as the body does. In space it turns as slowly as the
motion demands. So the angular velocity w of a body with attitude R is integrated as R w, whose rate is R w', and turned
back with the attitude of every stage. All other parts of the engine use its components along the body.

Only bodies that declare it (:attr:`nonsmooth.interfaces.Body.spin`) are integrated so. The gyroscopic torques of an
asymmetric body are slower along the axes of the body. A spin that keeps its direction, as in a plane, keeps it in space
and along the body alike, so it is integrated along the body.
"""

from __future__ import annotations

import math

from nonsmooth.engine.memory.layout import LAST_STAGE, N_STAGES
from nonsmooth.engine.native.kernel import Floats, Workspace, kernel
from nonsmooth.engine.numerics.runge_kutta import dense_part, stage_part, weigh_part
from nonsmooth.engine.numerics.vectors import Vector, cross, dot

_TO_SPACE, _TO_BODY = 1.0, -1.0
"""Sign of the scalar part of a quaternion that rotates a vector from the body to space, or from space to the body."""
_SMALLEST_SINE = 1e-9
"""Sine of the angle between a spin and its rate below which the spin keeps its direction. Round-off is 1e-16."""


@kernel("void(F, i8, i8, f8, i8)")
def _rotate(floats: Floats, q: int, v: int, sign: float, out: int) -> None:
    """Write the vector at ``v``, rotated by the quaternion at ``q`` of any length, to ``out``.

    ``sign``, the sign of the quaternion's scalar part, is ``_TO_SPACE`` (from the axes of the body) or ``_TO_BODY``.
    With a the scalar and e the vector part, the result is v + 2 (a e x v + e x (e x v)) / (a^2 + e . e).
    """
    # all is read before out is written, so that out may be v
    a, axis = sign * floats[q], (floats[q + 1], floats[q + 2], floats[q + 3])
    x, y, z = floats[v], floats[v + 1], floats[v + 2]
    tx, ty, tz = cross(axis, (x, y, z))
    sx, sy, sz = cross(axis, (tx, ty, tz))
    twice = 2.0 / (a * a + dot(axis, axis))
    floats[out] = x + twice * (a * tx + sx)
    floats[out + 1] = y + twice * (a * ty + sy)
    floats[out + 2] = z + twice * (a * tz + sz)


@kernel("f8(F, i8)")
def square_of_quaternion(floats: Floats, q: int) -> float:
    """Square of the length of the quaternion at ``q``, the offset of its four numbers."""
    square = 0.0
    for i in range(4):
        square += floats[q + i] * floats[q + i]
    return square


@kernel("f8(F, i8)")
def normalise(floats: Floats, q: int) -> float:
    """Bring the quaternion at ``q``, the offset of its four numbers, to unit length. Its length before."""
    size = math.sqrt(square_of_quaternion(floats, q))
    factor = 1.0 / size
    for i in range(4):
        floats[q + i] *= factor
    return size


@kernel("i8(ws, i8)")
def _slopes_of(ws: Workspace, number: int) -> int:
    """Offset of the slopes of the spin of body ``number`` along axes in space [1/s^2]: three floats for each stage."""
    return int(ws.island.spin_slopes.start + 3 * N_STAGES * number)


@kernel("b1(F, i8, i8)")
def _changes_direction(floats: Floats, spin: int, rate: int) -> bool:
    """True if the spin at ``spin``, whose rate is at ``rate``, changes its direction, False if it keeps it.

    The direction is kept if the two are parallel, by the sine of the angle between them.
    """
    u, v = (floats[spin], floats[spin + 1], floats[spin + 2]), (floats[rate], floats[rate + 1], floats[rate + 2])
    across = cross(u, v)
    return dot(across, across) > _SMALLEST_SINE * _SMALLEST_SINE * dot(u, u) * dot(v, v)


@kernel()
def choose_spins_in_space(ws: Workspace) -> None:
    """List the integrated bodies whose spin changes direction at the start of the step, in ``spinning``.

    Their spins are integrated along axes in space in this step, because a force on a fast spinning body changes slowly
    there. Only bodies that declare a spin take part, because a gyroscopic torque may be slower along the body.
    """
    ws.island.n_spinning = 0
    for i in range(ws.island.n_integrated):
        number = ws.island.integrated[i]
        body = ws.bodies[number]
        spin = ws.model.n_q + body.u + body.spin
        spin_now, rate = ws.island.y.start + spin, ws.island.slopes.start + spin
        # a body that does not declare its spin has -1
        body.spins_apart = body.spin >= 0 and _changes_direction(ws.floats, spin_now, rate)
        if body.spins_apart:
            ws.island.spinning[ws.island.n_spinning] = number
            ws.island.n_spinning += 1


@kernel("void(ws, i8, i8)")
def store_spin_slope(ws: Workspace, stage: int, state: int) -> None:
    """Store the spin slopes of a stage along axes in space [1/s^2]. ``state`` is where the stage was evaluated.

    At the first stage the spins at the start are stored too. :func:`write_spins_of_stage` normalised the quaternions of
    inner stages. Their slopes grow with their length, so they are scaled back to the lengths before.
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
    """Write the spins of a stage to the state at ``out``, along the bodies, whose quaternions are those of the stage.

    They follow from the slopes in space of the stages before, in a step of ``h`` [s]. The quaternions of inner stages
    are normalised, because the angular velocity grows with the square of their length. That of the last stage is the
    result of the step, which is left as the method gives it.
    """
    for i in range(ws.island.n_spinning):
        number = ws.island.spinning[i]
        body = ws.bodies[number]
        q, u = out + body.q + body.quaternion, out + ws.model.n_q + body.u + body.spin
        start = ws.island.spin_start.start + 3 * number
        # a spin has 3 numbers, and its slopes of two stages are 3 apart
        stage_part(ws, ws.coefficients.stages.start, start, _slopes_of(ws, number), 3, 3, stage, h, u)
        _rotate(ws.floats, q, u, _TO_BODY, u)
        if stage < LAST_STAGE:
            ws.island.quaternion_length[number] = normalise(ws.floats, q)


@kernel("void(ws, f8, i8)")
def write_spin_errors(ws: Workspace, h: float, out: int) -> None:
    """Write the estimated errors of the spins in a step of ``h`` [s] to ``out``, along the bodies at its end [1/s].

    ``out`` is the offset of a state of errors. The errors of spins that are integrated along the body are left.
    """
    for i in range(ws.island.n_spinning):
        number = ws.island.spinning[i]
        body = ws.bodies[number]
        u = out + ws.model.n_q + body.u + body.spin
        # a spin has 3 numbers, and its slopes of two stages are 3 apart
        weigh_part(ws, ws.coefficients.error_weights.start, _slopes_of(ws, number), 3, 3, h, u)
        _rotate(ws.floats, ws.step.y_new.start + body.q + body.quaternion, u, _TO_BODY, u)


@kernel("void(ws, i8, v3, v3, i8)")
def write_spin_within(ws: Workspace, number: int, early: Vector, late: Vector, out: int) -> None:
    """Write the spin of a body within the step to the state at ``out``, whose quaternion is the one there.

    ``early`` and ``late`` are the weights of the interpolant [s]. Spins that are integrated along the body are left,
    and those of an implicit step, whose interpolant is along the body.
    """
    body = ws.bodies[number]
    if not body.spins_apart or ws.island.stage_time > 0.0:
        return
    u = out + ws.model.n_q + body.u + body.spin
    # a spin has 3 numbers, and its slopes of two stages are 3 apart
    dense_part(ws.floats, ws.island.spin_start.start + 3 * number, _slopes_of(ws, number), 3, 3, early, late, u)
    _rotate(ws.floats, out + body.q + body.quaternion, u, _TO_BODY, u)
