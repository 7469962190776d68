"""One step inside an impact: explicit, or implicit where the direction of a slip next to rest makes it stiff.

A contact that leaves its bound slowly, or slips on little more than friction takes, stays near rest for long.  The
direction of its slip v follows the forces within an impulse of the order of |v|, and explicit steps may be no longer.
Linearly implicit Euler steps, 1 to 6 in one of ``h``, have no such bound; their results are extrapolated to the limit
(Hairer and Wanner, Solving Ordinary Differential Equations II, section IV.9).
"""

from __future__ import annotations

from nonsmooth.engine.delassus.delassus import diagonal_block
from nonsmooth.engine.impact.rates import DEFORMATION, STRIDE, evaluate_impact_rates, impact_slope
from nonsmooth.engine.memory import tableau
from nonsmooth.engine.memory.layout import LAST_STAGE, N_STAGES, STIFF_SLIPS
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, active_at, at, impact_state, kernel, stiff_slip_at
from nonsmooth.engine.numerics.linear import eliminate
from nonsmooth.engine.numerics.runge_kutta import stage_state, weigh_slopes
from nonsmooth.engine.numerics.vectors import length

_EXTRAPOLATED = 6
"""Results that are extrapolated; they lie where the stages of the explicit step do, behind the first."""
_STIFF = 1.0
"""Relaxations of a direction within a step that an explicit one bears."""
_NEAR = 1e-3
"""The Jacobian is one of differences over this part of the slip; it need not be exact."""
_UNUSABLE = 1e300
_STRAIGHT = 1e-13
"""Second differences of slopes below this, relative to the slopes, count as zero."""


@kernel("f8(S, F, I, f8)")
def try_impact_step(S: Scalars, w: Floats, k: Integers, h: float) -> float:
    """Take one step of ``h`` in pseudo-time to ``impact_new``; return its error relative to the tolerance."""
    n = STRIDE * S.n_active
    for stage in range(1, N_STAGES):
        out = S.impact_new if stage == LAST_STAGE else S.impact_stage
        stage_state(S, w, S.stages, S.impact_y, S.impact_slopes, n, stage, h, out)
        impact_slope(S, w, k, out, S.impact_slopes + stage * n)
    weigh_slopes(S, w, S.error_weights, S.impact_slopes, n, h, S.impact_stage)
    error = _relative_error(S, w, k)
    if not error <= 1.0:
        stiff = _find_stiff(S, w, k, h)
        if stiff > 0:
            return _try_implicit_step(S, w, k, h, stiff)
        evaluate_impact_rates(S, w, k, S.impact_new)
    return error


@kernel("f8(S, F, I)")
def _relative_error(S: Scalars, w: Floats, k: Integers) -> float:
    """Return the largest of the errors in ``impact_stage``, relative to the tolerance."""
    worst = 0.0
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        inverse = 1.0 / active.impulse_scale
        for r in range(STRIDE):
            if r >= DEFORMATION:
                inverse = 1.0 / (active.deformation_scale if r == DEFORMATION else active.energy_scale)
            error = inverse * abs(w[S.impact_stage + STRIDE * a + r])
            if error > worst or error != error:
                worst = error
    return worst / float(S.impact_rtol)


@kernel("i8(S, F, I, f8)")
def _find_stiff(S: Scalars, w: Floats, k: Integers, h: float) -> int:
    """List the components of slips that turn too fast for an explicit step of ``h``; return how many."""
    evaluate_impact_rates(S, w, k, S.impact_y)
    stiff = 0
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        speed = length(active.slip)
        if active.tangent_held == 1 or not speed > active.rest_slip or stiff == STIFF_SLIPS:
            continue
        friction, own = impact_state(w, S.impact_slopes, a).friction, diagonal_block(S, w, k, a)
        if h * length(friction) * max(own.t11, own.t22) > _STIFF * speed:
            for r in range(1, 3):
                slip = stiff_slip_at(S, w, k, stiff)
                slip.contact, slip.direction = a, r
                stiff += 1
    return stiff


@kernel("f8(S, F, I, f8, i8)")
def _try_implicit_step(S: Scalars, w: Floats, k: Integers, h: float, stiff: int) -> float:
    """Take one step of ``h`` to ``impact_new``, implicit in so many components of slip; return its relative error.

    Leaves slopes from which the dense output of the explicit step makes the cubic through both ends.
    """
    n = STRIDE * S.n_active
    _differentiate(S, w, k, stiff)
    for j in range(_EXTRAPOLATED):
        for i in range(n):
            w[S.impact_new + i] = w[S.impact_y + i]
        slope = S.impact_slopes
        for part in range(j + 1):
            if part > 0:
                slope = S.impact_stage
                impact_slope(S, w, k, S.impact_new, slope)
            if _euler_step(S, w, k, h / (j + 1), stiff, slope) == 0:
                return _UNUSABLE
        for i in range(n):
            value = w[S.impact_new + i]
            for q in range(j):
                row = S.impact_slopes + (q + 1) * n + i
                before, w[row] = w[row], value
                value += (value - before) * (j - q) / (q + 1)
            w[S.impact_slopes + (j + 1) * n + i] = value
    last = S.impact_slopes + _EXTRAPOLATED * n
    for i in range(n):
        w[S.impact_new + i] = w[last + i]
        w[S.impact_stage + i] = w[last + i] - w[last - n + i]
    error = _relative_error(S, w, k)
    impact_slope(S, w, k, S.impact_new, last)
    for stage in range(1, 6):
        c = tableau.NODES[stage]
        for i in range(n):
            rise = (w[S.impact_new + i] - w[S.impact_y + i]) / h
            w[S.impact_slopes + stage * n + i] = (
                6.0 * c * (1.0 - c) * rise
                + (1.0 - c) * (1.0 - 3.0 * c) * w[S.impact_slopes + i]
                + c * (3.0 * c - 2.0) * w[last + i]
            )
    return error


@kernel("void(S, F, I, i8)")
def _differentiate(S: Scalars, w: Floats, k: Integers, stiff: int) -> None:
    """Write the derivatives of the slope by the ``stiff`` components of slip, and the slips that those make."""
    n = STRIDE * S.n_active
    for j in range(stiff):
        slip = stiff_slip_at(S, w, k, j)
        active = active_at(S, w, k, slip.contact)
        column = S.stiff_slopes + j * n
        evaluate_impact_rates(S, w, k, S.impact_y)
        kept, change = active.rate_before[slip.direction], _NEAR * length(active.slip)
        active.rate_before[slip.direction] += change
        change = active.rate_before[slip.direction] - kept
        impact_slope(S, w, k, S.impact_y, column)
        active.rate_before[slip.direction] = kept
        for i in range(n):
            w[column + i] = (w[column + i] - w[S.impact_slopes + i]) / change
        for i in range(stiff):
            w[S.stiff_rates + stiff * i + j] = _slip_of(S, w, k, i, column)


@kernel("f8(S, F, I, i8, i8)")
def _slip_of(S: Scalars, w: Floats, k: Integers, i: int, impulses: int) -> float:
    """Return the stiff component ``i`` of slip that the impulses make, which lie in a state."""
    slip = stiff_slip_at(S, w, k, i)
    active = active_at(S, w, k, slip.contact)
    total = 0.0
    for block in range(active.first_block, active.end_block):
        g = at(w, S.delassus + 9 * block + 3 * slip.direction)
        p = impact_state(w, impulses, k[S.block_column + block]).impulse
        total += g[0] * p[0] + g[1] * p[1] + g[2] * p[2]
    return total


@kernel("i8(S, F, I, f8, i8, i8)")
def _euler_step(S: Scalars, w: Floats, k: Integers, h: float, stiff: int, slope: int) -> int:
    """Move ``impact_new`` by one linearly implicit Euler step; return 0 if that is singular.

    The change is h (slope + D v) with the derivatives D by the slips and their changes v = V change, which is
    (1 - h V D) v = h V slope.
    """
    n = STRIDE * S.n_active
    for i in range(stiff):
        for j in range(stiff):
            w[S.stiff_matrix + stiff * i + j] = (1.0 if i == j else 0.0) - h * w[S.stiff_rates + stiff * i + j]
        w[S.stiff_slip + i] = h * _slip_of(S, w, k, i, slope)
    if eliminate(w, S.stiff_matrix, stiff, stiff, S.stiff_slip, 0.0) == 0:
        return 0
    for i in range(n):
        w[S.impact_new + i] += h * w[slope + i]
    for j in range(stiff):
        change = h * w[S.stiff_slip + j]
        for i in range(n):
            w[S.impact_new + i] += change * w[S.stiff_slopes + j * n + i]
    return 1


@kernel("i8(S, F, I, f8)")
def try_linear_step(S: Scalars, w: Floats, k: Integers, h: float) -> int:
    """Take one step of ``h`` to ``impact_new`` by the midpoint rule; return 1 if the slope is linear and it is exact.

    A lone contact whose slip keeps its direction moves like that; the slope at the end tells.
    """
    n = STRIDE * S.n_active
    middle, end = S.impact_slopes + n, S.impact_slopes + LAST_STAGE * n
    for i in range(n):
        w[S.impact_stage + i] = w[S.impact_y + i] + 0.5 * h * w[S.impact_slopes + i]
    impact_slope(S, w, k, S.impact_stage, middle)
    for i in range(n):
        w[S.impact_new + i] = w[S.impact_y + i] + h * w[middle + i]
    impact_slope(S, w, k, S.impact_new, end)
    # a component that is round-off next to the contact's force is as straight as that force
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        force = abs(active.force[0]) + abs(active.force[1]) + abs(active.force[2])
        for i in range(STRIDE * a, STRIDE * (a + 1)):
            first, half, last = w[S.impact_slopes + i], w[middle + i], w[end + i]
            size = abs(first) + abs(last) + abs(half)
            if i < STRIDE * a + DEFORMATION:
                size = max(size, force)
            if not abs(first + last - 2.0 * half) <= _STRAIGHT * size:
                return 0
    return 1
