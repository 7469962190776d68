"""One adaptive Runge-Kutta pair on the float heap, for the flow and for the impact alike."""

from __future__ import annotations

from nonsmooth.engine.memory import tableau
from nonsmooth.engine.memory.layout import LAST_STAGE
from nonsmooth.engine.native.kernel import Floats, Scalars, kernel
from nonsmooth.engine.numerics.vectors import Vector

SAFETY, SHRINK, GROW = 0.92, 0.2, 8.0
"""Part taken of the step that would just meet the tolerance, and the least and most by which steps differ at once."""
_EXPONENT = -0.2
"""The error of a step of fourth order grows with the fifth power of its length."""
_TINY = (SAFETY / GROW) ** 5
"""Below this error the step grows by the most it may."""


@kernel("void(S, F, i8, i8, i8, i8, i8, f8, i8)")
def stage_state(
    S: Scalars, w: Floats, stages: int, start: int, slopes: int, n: int, stage: int, h: float, out: int
) -> None:
    """Write the state at which the slope of ``stage`` is evaluated, by the weights of ``stages``."""
    stage_part(S, w, stages, start, slopes, n, n, stage, h, out)


@kernel("void(S, F, i8, i8, i8, i8, i8, i8, f8, i8)")
def stage_part(
    S: Scalars, w: Floats, stages: int, start: int, slopes: int, n: int, stride: int, stage: int, h: float, out: int
) -> None:
    """Write ``n`` components of that state, the slopes of two stages lying ``stride`` apart."""
    row = stages + 6 * stage
    # one pass each: so short vectors would else take most of their time to be loaded and stored again
    k0, k1, k2 = slopes, slopes + stride, slopes + 2 * stride
    k3, k4, k5 = k2 + stride, k2 + 2 * stride, k2 + 3 * stride
    a, b, c = h * w[row], h * w[row + 1], h * w[row + 2]
    d, e, f = h * w[row + 3], h * w[row + 4], h * w[row + 5]
    if stage == 1:
        for i in range(n):
            w[out + i] = w[start + i] + a * w[k0 + i]
    elif stage == 2:
        for i in range(n):
            w[out + i] = w[start + i] + a * w[k0 + i] + b * w[k1 + i]
    elif stage == 3:
        for i in range(n):
            w[out + i] = w[start + i] + a * w[k0 + i] + b * w[k1 + i] + c * w[k2 + i]
    elif stage == 4:
        for i in range(n):
            w[out + i] = w[start + i] + a * w[k0 + i] + b * w[k1 + i] + c * w[k2 + i] + d * w[k3 + i]
    elif stage == 5:
        for i in range(n):
            first = w[start + i] + a * w[k0 + i] + b * w[k1 + i]
            w[out + i] = first + c * w[k2 + i] + d * w[k3 + i] + e * w[k4 + i]
    else:
        for i in range(n):
            first = w[start + i] + a * w[k0 + i] + b * w[k1 + i]
            w[out + i] = first + c * w[k2 + i] + d * w[k3 + i] + e * w[k4 + i] + f * w[k5 + i]


@kernel("void(S, F, i8, i8, i8, f8, f8, i8)")
def dense_state(S: Scalars, w: Floats, start: int, slopes: int, n: int, h: float, theta: float, out: int) -> None:
    """Write the interpolated state at the fraction ``theta`` of the step."""
    early, late = dense_weights(S, w, h, theta, 0), dense_weights(S, w, h, theta, 1)
    dense_part(w, start, slopes, n, n, early, late, out)


@kernel("f8(S, F, i8, f8)")
def _dense_weight(S: Scalars, w: Floats, stage: int, theta: float) -> float:
    d = S.dense + 4 * stage
    return w[d] + theta * (w[d + 1] + theta * (w[d + 2] + theta * w[d + 3]))


@kernel("v3(S, F, f8, f8, i8)")
def dense_weights(S: Scalars, w: Floats, h: float, theta: float, late: int) -> Vector:
    """Return the weights of slopes in the state at the fraction ``theta`` of a step: of the last three (1), or others.

    That of the second stage has none.
    """
    one, two, three = (4, 5, 6) if late == 1 else (0, 2, 3)
    part = h * theta
    return (
        part * _dense_weight(S, w, one, theta),
        part * _dense_weight(S, w, two, theta),
        part * _dense_weight(S, w, three, theta),
    )


@kernel("void(F, i8, i8, i8, i8, v3, v3, i8)")
def dense_part(w: Floats, start: int, slopes: int, n: int, stride: int, early: Vector, late: Vector, out: int) -> None:
    """Write ``n`` components of the interpolated state, the slopes of two stages lying ``stride`` apart."""
    a, b, c = early
    d, e, f = late
    k2, k3, k4 = slopes + 2 * stride, slopes + 3 * stride, slopes + 4 * stride
    k5, k6 = slopes + 5 * stride, slopes + 6 * stride
    for i in range(n):
        first = w[start + i] + a * w[slopes + i] + b * w[k2 + i] + c * w[k3 + i]
        w[out + i] = first + d * w[k4 + i] + e * w[k5 + i] + f * w[k6 + i]


@kernel("void(S, F, i8, i8, i8, f8, i8)")
def weigh_slopes(S: Scalars, w: Floats, weights: int, slopes: int, n: int, h: float, out: int) -> None:
    """Write ``h`` times the weighted sum of the slopes, by which errors of a step are estimated."""
    weigh_part(S, w, weights, slopes, n, n, h, out)


@kernel("void(S, F, i8, i8, i8, i8, f8, i8)")
def weigh_part(S: Scalars, w: Floats, weights: int, slopes: int, n: int, stride: int, h: float, out: int) -> None:
    """Write ``n`` components of that sum, the slopes of two stages lying ``stride`` apart."""
    a, b, c, d = h * w[weights], h * w[weights + 1], h * w[weights + 2], h * w[weights + 3]
    e, f, g = h * w[weights + 4], h * w[weights + 5], h * w[weights + 6]
    k1, k2, k3 = slopes + stride, slopes + 2 * stride, slopes + 3 * stride
    k4, k5, k6 = k3 + stride, k3 + 2 * stride, k3 + 3 * stride
    for i in range(n):
        first = a * w[slopes + i] + b * w[k1 + i] + c * w[k2 + i] + d * w[k3 + i]
        w[out + i] = first + e * w[k4 + i] + f * w[k5 + i] + g * w[k6 + i]


@kernel("void(S, F, i8, i8, i8, i8, f8, i8)")
def write_implicit_interpolant(
    S: Scalars, w: Floats, start: int, end: int, slopes: int, n: int, h: float, bend: int
) -> None:
    """Write slopes from which the dense output of the explicit pair makes the interpolant of an implicit step of ``h``.

    The first and the last are those at ``start`` and ``end``, and stay; ``bend`` is overwritten.
    """
    weigh_slopes(S, w, S.implicit_bend, slopes, n, 2.0, bend)
    for stage in range(1, LAST_STAGE):
        c = tableau.NODES[stage]
        for i in range(n):
            w[slopes + stage * n + i] = (
                6.0 * c * (1.0 - c) * (w[end + i] - w[start + i]) / h
                + (1.0 - c) * (1.0 - 3.0 * c) * w[slopes + i]
                + c * (3.0 * c - 2.0) * w[slopes + LAST_STAGE * n + i]
                + c * (1.0 - c) * (1.0 - 2.0 * c) * w[bend + i]
            )


@kernel("f8(f8)")
def step_factor(error: float) -> float:
    """Return by how much the next step may differ, the error being relative to its tolerance."""
    if error <= _TINY:
        return GROW
    return float(min(GROW, max(SHRINK, SAFETY * error**_EXPONENT)))


@kernel("f8(f8, f8, f8)")
def trend(error: float, error_before: float, growth: float) -> float:
    """Return by how much the next step may differ if it does as this one, ``growth`` times the one before it, did.

    Towards a singularity steps shrink by a factor each, and what the last error alone allows is too long every time:
    the controller of K. Gustafsson, ACM Trans. Math. Softw. 20 (1994) 496-517.
    """
    return float(max(SHRINK, SAFETY * growth * (error_before / (error * error)) ** -_EXPONENT))
