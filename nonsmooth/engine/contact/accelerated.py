"""Sweeps of Gauss-Seidel, accelerated after Anderson (1965): how the last sweeps changed foretells where they lead.

Wedged contacts and redundant ones pass forces round by small parts, and sweeps alone take thousands.
"""

from __future__ import annotations

from nonsmooth.engine.contact.gauss_seidel import sweep
from nonsmooth.engine.contact.newton import write_natural_map
from nonsmooth.engine.delassus.delassus import diagonal_block
from nonsmooth.engine.memory.layout import SWEEPS_KEPT
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, active_at, kernel
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.linear import eliminate
from nonsmooth.engine.numerics.vectors import length

_SINGULAR = 1e-13
"""Pivots of squares of changes below this part of the largest are round-off."""


@kernel("f8(S, F, I)")
def _velocity_residual(S: Scalars, w: Floats, k: Integers) -> float:
    """Return by what velocity or acceleration the forces miss the natural map at most."""
    write_natural_map(S, w, k)
    worst = 0.0
    for a in range(S.n_active):
        block = diagonal_block(S, w, k, a)
        for r in range(3):
            worst = max(worst, block.entries[4 * r] * abs(w[S.right + 3 * a + r]))
    return worst


@kernel("i8(S, F, i8)")
def _weigh(S: Scalars, w: Floats, kept: int) -> int:
    """Write to ``sweep_weights`` how the last change is made of the ``kept`` differences; return 0 if they are one."""
    n, stride = 3 * S.n_active, 3 * S.n_slots
    largest = 0.0
    for i in range(kept):
        one = S.sweep_changes + i * stride
        for j in range(i, kept):
            two, total = S.sweep_changes + j * stride, 0.0
            for c in range(n):
                total += w[one + c] * w[two + c]
            w[S.sweep_squares + i * kept + j] = w[S.sweep_squares + j * kept + i] = total
        largest, total = max(largest, w[S.sweep_squares + i * kept + i]), 0.0
        for c in range(n):
            total += w[one + c] * w[S.sweep_change + c]
        w[S.sweep_weights + i] = total
    return int(eliminate(w, S.sweep_squares, kept, kept, S.sweep_weights, _SINGULAR)) if largest > 0.0 else 0


@kernel("void(S, F, I, i8)")
def _foretell(S: Scalars, w: Floats, k: Integers, kept: int) -> None:
    """Write the forces to which the last sweeps lead, cut to their cones."""
    n, stride = 3 * S.n_active, 3 * S.n_slots
    for j in range(kept):
        weight, ends = w[S.sweep_weights + j], S.sweep_ends + j * stride
        for i in range(n):
            w[S.active_forces + i] -= weight * w[ends + i]
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        active.normal_force = max(0.0, active.normal_force)
        t1, t2 = active.friction
        size, bound = length((t1, t2)), active.mu * active.normal_force
        if size > bound:
            active.friction = t1 * (bound / size), t2 * (bound / size)


@kernel("i8(S, F, I, f8, i8)")
def sweep_accelerated(S: Scalars, w: Floats, k: Integers, least: float, most: int) -> int:
    """Improve the forces until they leave rates wrong by ``least`` at most; return 1 if ``most`` sweeps do that.

    By how much they are wrong before the last sweep foretells better ones is ``sweep_left``.

    All contacts must be at rest, or their slips unknown.
    """
    n, stride = 3 * S.n_active, 3 * S.n_slots
    followed = 0
    for _sweep in range(most):
        if interrupted(S, S.n_active) == 1:
            return 0
        for i in range(n):
            w[S.sweep_start + i] = w[S.active_forces + i]
        sweep(S, w, k, 1)
        left = S.sweep_left = _velocity_residual(S, w, k)
        if left <= least:
            return 1
        place = stride * ((followed - 1) % SWEEPS_KEPT)
        for i in range(n):
            change = w[S.active_forces + i] - w[S.sweep_start + i]
            if followed > 0:
                w[S.sweep_changes + place + i] = change - w[S.sweep_change + i]
                w[S.sweep_ends + place + i] = w[S.active_forces + i] - w[S.sweep_end + i]
            w[S.sweep_change + i], w[S.sweep_end + i] = change, w[S.active_forces + i]
        kept = min(followed, SWEEPS_KEPT)
        followed += 1
        if kept > 0 and _weigh(S, w, kept) == 1:
            _foretell(S, w, k, kept)
            if _velocity_residual(S, w, k) > left:
                for i in range(n):
                    w[S.active_forces + i] = w[S.sweep_end + i]
                followed = 0
    return 0
