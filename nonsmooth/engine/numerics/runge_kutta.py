"""One adaptive Runge-Kutta pair on the float heap, for the flow and for the impact alike."""

from __future__ import annotations

from nonsmooth.engine.memory import tableau
from nonsmooth.engine.memory.layout import LAST_STAGE, N_STAGES
from nonsmooth.engine.native.kernel import Floats, Scalars, kernel

SAFETY, SHRINK, GROW = 0.92, 0.2, 8.0
_EXPONENT = -0.2
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
    weight = h * w[stages + 6 * stage]
    for i in range(n):
        w[out + i] = w[start + i] + weight * w[slopes + i]
    for j in range(1, stage):
        weight = h * w[stages + 6 * stage + j]
        for i in range(n):
            w[out + i] += weight * w[slopes + j * stride + i]


@kernel("void(S, F, i8, i8, i8, f8, f8, i8)")
def dense_state(S: Scalars, w: Floats, start: int, slopes: int, n: int, h: float, theta: float, out: int) -> None:
    """Write the interpolated state at the fraction ``theta`` of the step."""
    dense_part(S, w, start, slopes, n, n, h, theta, out)


@kernel("void(S, F, i8, i8, i8, i8, f8, f8, i8)")
def dense_part(
    S: Scalars, w: Floats, start: int, slopes: int, n: int, stride: int, h: float, theta: float, out: int
) -> None:
    """Write ``n`` components of the interpolated state, the slopes of two stages lying ``stride`` apart."""
    for j in range(N_STAGES):
        d, slope = S.dense + 4 * j, slopes + j * stride
        weight = h * theta * (w[d] + theta * (w[d + 1] + theta * (w[d + 2] + theta * w[d + 3])))
        if j == 0:
            for i in range(n):
                w[out + i] = w[start + i] + weight * w[slope + i]
        elif weight != 0.0:
            for i in range(n):
                w[out + i] += weight * w[slope + i]


@kernel("void(S, F, i8, i8, i8, f8, i8)")
def weigh_slopes(S: Scalars, w: Floats, weights: int, slopes: int, n: int, h: float, out: int) -> None:
    """Write ``h`` times the weighted sum of the slopes, by which errors of a step are estimated."""
    weigh_part(S, w, weights, slopes, n, n, h, out)


@kernel("void(S, F, i8, i8, i8, i8, f8, i8)")
def weigh_part(S: Scalars, w: Floats, weights: int, slopes: int, n: int, stride: int, h: float, out: int) -> None:
    """Write ``n`` components of that sum, the slopes of two stages lying ``stride`` apart."""
    weight = h * w[weights]
    for i in range(n):
        w[out + i] = weight * w[slopes + i]
    for j in range(1, N_STAGES):
        weight = h * w[weights + j]
        for i in range(n):
            w[out + i] += weight * w[slopes + j * stride + i]


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
