"""Steps of an adaptive Runge-Kutta pair with dense output, for motion and for impacts.

States and slopes are stored among the floats of the workspace, the slopes of all stages one after another. The weights
are those of :mod:`nonsmooth.engine.memory.tableau`.
"""

from __future__ import annotations

from nonsmooth.engine.memory.layout import LAST_STAGE
from nonsmooth.engine.native.kernel import Floats, Workspace, kernel
from nonsmooth.engine.numerics.vectors import Vector

SAFETY = 0.92
"""Step relative to the one whose error would equal the tolerance."""
SHRINK, GROW = 0.2, 8.0
"""Smallest and largest ratio of a step to the one before it."""
_EXPONENT = -0.2
"""The error of a step of fourth order grows with the fifth power of its length."""
_TINY = (SAFETY / GROW) ** 5
"""Error, relative to the tolerance, below which the step grows by the largest ratio."""


@kernel("void(ws, i8, i8, i8, i8, i8, i8, f8, i8)")
def stage_part(
    ws: Workspace, stages: int, start: int, slopes: int, n: int, stride: int, stage: int, h: float, out: int
) -> None:
    """Write ``n`` numbers of the state at which the slope of ``stage`` is evaluated: start + h sum_j a_j slope_j.

    ``start`` is the offset of the numbers at the start of the step of length ``h``, ``slopes`` that of their slopes
    of stage 0, ``out`` that of the result. The slopes of two stages are ``stride`` apart. The weights a_j are in the
    table at ``stages``, six in each row, a row for each stage. ``stage`` is 1 to 6: stage 0 is the start itself.
    """
    row = stages + 6 * stage
    # one loop over all slopes: vectors are so short that a loop per slope would spend its time on loads and stores.
    # Slopes of later stages are not read, as they are not evaluated yet
    k0, k1, k2 = slopes, slopes + stride, slopes + 2 * stride
    k3, k4, k5 = k2 + stride, k2 + 2 * stride, k2 + 3 * stride
    a, b, c = h * ws.floats[row], h * ws.floats[row + 1], h * ws.floats[row + 2]
    d, e, f = h * ws.floats[row + 3], h * ws.floats[row + 4], h * ws.floats[row + 5]
    if stage == 1:
        for i in range(n):
            ws.floats[out + i] = ws.floats[start + i] + a * ws.floats[k0 + i]
    elif stage == 2:
        for i in range(n):
            ws.floats[out + i] = ws.floats[start + i] + a * ws.floats[k0 + i] + b * ws.floats[k1 + i]
    elif stage == 3:
        for i in range(n):
            first = ws.floats[start + i] + a * ws.floats[k0 + i] + b * ws.floats[k1 + i]
            ws.floats[out + i] = first + c * ws.floats[k2 + i]
    elif stage == 4:
        for i in range(n):
            first = ws.floats[start + i] + a * ws.floats[k0 + i] + b * ws.floats[k1 + i]
            ws.floats[out + i] = first + c * ws.floats[k2 + i] + d * ws.floats[k3 + i]
    elif stage == 5:
        for i in range(n):
            first = ws.floats[start + i] + a * ws.floats[k0 + i] + b * ws.floats[k1 + i]
            ws.floats[out + i] = first + c * ws.floats[k2 + i] + d * ws.floats[k3 + i] + e * ws.floats[k4 + i]
    else:
        for i in range(n):
            first = ws.floats[start + i] + a * ws.floats[k0 + i] + b * ws.floats[k1 + i] + c * ws.floats[k2 + i]
            ws.floats[out + i] = first + d * ws.floats[k3 + i] + e * ws.floats[k4 + i] + f * ws.floats[k5 + i]


@kernel("void(ws, i8, i8, i8, f8, f8, i8)")
def dense_state(ws: Workspace, start: int, slopes: int, n: int, h: float, theta: float, out: int) -> None:
    """Write the ``n`` numbers of the interpolated state at the fraction ``theta`` of a step of length ``h``.

    ``start``, ``slopes`` and ``out`` are offsets of the state at the start, the slopes of all stages and the result.
    """
    # weights of the slopes of stages 0, 2 and 3, and of stages 4, 5 and 6
    early, late = dense_weights(ws, h, theta, is_late=False), dense_weights(ws, h, theta, is_late=True)
    # all n numbers of the state, so that the slopes of two stages are n apart
    dense_part(ws.floats, start, slopes, n, n, early, late, out)


@kernel("f8(ws, i8, f8)")
def _dense_weight(ws: Workspace, stage: int, theta: float) -> float:
    """Weight w [1] of the slope k of a stage in the interpolant y(theta) = y_0 + h theta sum w(theta) k.

    It is a cubic of ``theta``, the fraction of the step, whose four coefficients for each stage are in ``dense``.
    """
    d = ws.coefficients.dense.start + 4 * stage
    return float(ws.floats[d] + theta * (ws.floats[d + 1] + theta * (ws.floats[d + 2] + theta * ws.floats[d + 3])))


@kernel("v3(ws, f8, f8, b1)")
def dense_weights(ws: Workspace, h: float, theta: float, is_late: bool) -> Vector:
    """Weights of three slopes in the interpolated state at the fraction ``theta`` of a step of length ``h`` [s].

    They belong to stages 4, 5 and 6 if ``is_late``, to 0, 2 and 3 otherwise. The slope of stage 1 has no weight. Two
    calls give all six, for :func:`dense_part`. Each includes the length of the step, by which slopes are multiplied.
    """
    one, two, three = (4, 5, 6) if is_late else (0, 2, 3)
    part = h * theta
    return (
        part * _dense_weight(ws, one, theta),
        part * _dense_weight(ws, two, theta),
        part * _dense_weight(ws, three, theta),
    )


@kernel("void(F, i8, i8, i8, i8, v3, v3, i8)")
def dense_part(
    floats: Floats, start: int, slopes: int, n: int, stride: int, early: Vector, late: Vector, out: int
) -> None:
    """Write ``n`` numbers of the interpolated state to ``out``: start plus the weighted sum of the slopes.

    ``start`` is the offset of the numbers at the start of the step, ``slopes`` that of their slopes of stage 0. The
    slopes of two stages are ``stride`` apart. ``early`` and ``late`` are the weights of :func:`dense_weights` [s], for
    stages 0, 2 and 3, and for stages 4, 5 and 6. That of stage 1 is zero.
    """
    a, b, c = early
    d, e, f = late
    k2, k3, k4 = slopes + 2 * stride, slopes + 3 * stride, slopes + 4 * stride
    k5, k6 = slopes + 5 * stride, slopes + 6 * stride
    for i in range(n):
        first = floats[start + i] + a * floats[slopes + i] + b * floats[k2 + i] + c * floats[k3 + i]
        floats[out + i] = first + d * floats[k4 + i] + e * floats[k5 + i] + f * floats[k6 + i]


@kernel("void(ws, i8, i8, i8, i8, f8, i8)")
def weigh_part(ws: Workspace, weights: int, slopes: int, n: int, stride: int, h: float, out: int) -> None:
    """Write ``n`` numbers of ``h`` times the weighted sum of the seven slopes to ``out``, as for the error of a step.

    The seven numbers from the offset ``weights`` are those of the stages. ``slopes`` is the offset of the slopes of
    stage 0. The slopes of two stages are ``stride`` apart.
    """
    a, b = h * ws.floats[weights], h * ws.floats[weights + 1]
    c, d = h * ws.floats[weights + 2], h * ws.floats[weights + 3]
    e, f, g = h * ws.floats[weights + 4], h * ws.floats[weights + 5], h * ws.floats[weights + 6]
    k1, k2, k3 = slopes + stride, slopes + 2 * stride, slopes + 3 * stride
    k4, k5, k6 = k3 + stride, k3 + 2 * stride, k3 + 3 * stride
    for i in range(n):
        first = a * ws.floats[slopes + i] + b * ws.floats[k1 + i] + c * ws.floats[k2 + i] + d * ws.floats[k3 + i]
        ws.floats[out + i] = first + e * ws.floats[k4 + i] + f * ws.floats[k5 + i] + g * ws.floats[k6 + i]


@kernel("void(ws, i8, i8, i8, i8, f8, i8)")
def write_implicit_interpolant(ws: Workspace, start: int, end: int, slopes: int, n: int, h: float, bend: int) -> None:
    """Write slopes with which the dense output of the explicit pair gives the interpolant of an implicit step of ``h``.

    The interpolant is the cubic Hermite one plus h theta^2 (1 - theta)^2 b, where b is a weighted sum of the slopes.
    The slopes of stages 1 to 5 are replaced by its derivative at the nodes of the explicit pair, whose dense output is
    exact for polynomials of fourth degree, as this one. The first and the last slope belong to the states at ``start``
    and ``end``, and are kept. ``bend`` is a work array of ``n`` numbers.
    """
    # 2.0 gives twice b: the derivative of theta^2 (1 - theta)^2 is 2 theta (1 - theta) (1 - 2 theta)
    weigh_part(ws, ws.coefficients.implicit_bend.start, slopes, n, n, 2.0, bend)
    for stage in range(1, LAST_STAGE):
        c = ws.coefficients.nodes[stage]
        for i in range(n):
            # derivative of the Hermite cubic, from the end values and both end slopes, then that of the added term
            ws.floats[slopes + stage * n + i] = (
                6.0 * c * (1.0 - c) * (ws.floats[end + i] - ws.floats[start + i]) / h
                + (1.0 - c) * (1.0 - 3.0 * c) * ws.floats[slopes + i]
                + c * (3.0 * c - 2.0) * ws.floats[slopes + LAST_STAGE * n + i]
                + c * (1.0 - c) * (1.0 - 2.0 * c) * ws.floats[bend + i]
            )


@kernel("f8(f8)")
def step_factor(error: float) -> float:
    """Ratio of the length of the next step to that of this one, from its ``error`` relative to the tolerance.

    The error grows with the fifth power of the length. The next one should be ``SAFETY`` to this power. The ratio is
    kept between ``SHRINK`` and ``GROW``. If the error is above 1, this step is tried again with the new length.
    """
    # also for an error of zero, which has no negative power
    if error <= _TINY:
        return GROW
    return float(min(GROW, max(SHRINK, SAFETY * error**_EXPONENT)))


@kernel("f8(f8, f8, f8)")
def trend(error: float, error_before: float, growth: float) -> float:
    """Ratio of the length of the next step to that of this one, from the last two errors relative to the tolerance.

    This step is ``growth`` times as long as the one before it. Towards a singularity each step must be shorter than the
    last one, and :func:`step_factor`, which knows the last error only, always allows too long a step. The ratio has a
    lower bound only: the caller takes the smaller ratio of both functions.
    """
    # the error is C h^5, and C is assumed to grow by the same ratio again (K. Gustafsson, ACM Trans. Math. Softw. 20
    # (1994) 496-517). An error of zero is not allowed
    return float(max(SHRINK, SAFETY * growth * (error_before / (error * error)) ** -_EXPONENT))
