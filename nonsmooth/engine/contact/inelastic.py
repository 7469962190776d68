"""The inelastic impact on Coulomb's cone: what one step of Moreau's rule asks for.

Wedged contacts and redundant ones pass impulses round for long, and from a start far away Newton's method finds none.
Contacts that give way a little do neither.  So impulses that are at hand, of the averaging before, lead to those of
contacts that give way next to not at all.  Others are followed from contacts that give way as much as the bodies do to
those that do not at all: every answer is the start of the next.
"""

from __future__ import annotations

from nonsmooth.engine.contact.gauss_seidel import SWEEPS, sweep
from nonsmooth.engine.contact.newton import STEPS, step_by_newton
from nonsmooth.engine.contact.problem import write_friction
from nonsmooth.engine.delassus.delassus import diagonal_block
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, active_at, contact_at, entry_point, kernel
from nonsmooth.engine.numerics.vectors import length

_TRUE = 0.5
"""Contacts give way no more where that makes rates wrong by no more than this part of what counts as none."""
_LAST = 3
"""Newton steps from there to contacts that do not give way: where impulses are unique, one or two do."""
_RATIO = 0.01
"""Contacts give way by this part of what they did before,"""
_STUCK = 0.5
"""or by the root of it where that leads nowhere; above this it does not at all."""


@kernel("void(S, F, I)")
def _keep_rigid(S: Scalars, w: Floats, k: Integers) -> None:
    for a in range(S.n_active):
        for r in range(3):
            active_at(S, w, k, a).rigid[r] = diagonal_block(S, w, k, a).entries[4 * r]


@kernel("void(S, F, I, f8)")
def _soften(S: Scalars, w: Floats, k: Integers, part: float) -> None:
    """Let the active contacts give way by a ``part`` of what the bodies do."""
    for a in range(S.n_active):
        active, own = active_at(S, w, k, a), diagonal_block(S, w, k, a)
        # the normal impulse of a contact with a law of its own is given
        rigid = contact_at(S, w, k, active.slot).normal_function == 0
        along = part * max(active.rigid[1], active.rigid[2])
        own.nn = active.rigid[0] * (1.0 + part if rigid else 1.0)
        own.t11, own.t22 = active.rigid[1] + along, active.rigid[2] + along


@kernel("f8(S, F, I)")
def _fastest(S: Scalars, w: Floats, k: Integers) -> float:
    """Return what rate the impulses would bring about at their own contacts at most."""
    fastest = 0.0
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        along = max(active.rigid[1], active.rigid[2]) * length(active.friction)
        fastest = max(fastest, active.rigid[0] * active.normal_force, along)
    return fastest


@kernel("void(S, F, I)")
def _keep(S: Scalars, w: Floats, k: Integers) -> None:
    for i in range(3 * S.n_active):
        w[S.active_forces_first + i] = w[S.active_forces + i]


@kernel("i8(S, F, I, i8)")
def _step_or_stay(S: Scalars, w: Floats, k: Integers, steps: int) -> int:
    """Go to the next answer by Newton's method, or stay at the last (0)."""
    _keep(S, w, k)
    if step_by_newton(S, w, k, steps) == 1:
        return 1
    for i in range(3 * S.n_active):
        w[S.active_forces + i] = w[S.active_forces_first + i]
    return 0


@kernel("i8(S, F, I, f8)")
def _next_to_rigid(S: Scalars, w: Floats, k: Integers, part: float) -> int:
    """Return 1 if contacts that give way by a ``part`` make no rates wrong by more than counts."""
    return 1 if part * _fastest(S, w, k) <= _TRUE * S.velocity_tolerance else 0


@kernel("i8(S, F, I)")
def _go_on(S: Scalars, w: Floats, k: Integers) -> int:
    """Go from the impulses at hand to those of contacts that give way next to not at all, or stay (0)."""
    fastest = _fastest(S, w, k)
    if fastest == 0.0:
        return 0
    # half of what may be, as the impulses to be found may be larger than those at hand
    part = min(1.0, 0.5 * _TRUE * S.velocity_tolerance / fastest)
    _soften(S, w, k, part)
    settled = _step_or_stay(S, w, k, STEPS)
    _soften(S, w, k, 0.0)
    return settled * _next_to_rigid(S, w, k, part)


@kernel("i8(S, F, I)")
def _follow(S: Scalars, w: Floats, k: Integers) -> int:
    """Follow impulses from contacts that give way to those that do next to not at all; return 1 if that leads there."""
    found, ratio = 1.0, _RATIO
    _soften(S, w, k, found)
    sweep(S, w, k, SWEEPS)
    if step_by_newton(S, w, k, STEPS) == 0:
        ratio = 1.0
    while ratio <= _STUCK and _next_to_rigid(S, w, k, found) == 0:
        _soften(S, w, k, ratio * found)
        if _step_or_stay(S, w, k, STEPS) == 1:
            found *= ratio
        else:
            ratio **= 0.5
    _soften(S, w, k, 0.0)
    return _next_to_rigid(S, w, k, found)


@entry_point("i8(S, F, I, f8)")
def inelastic_impulses(S: Scalars, w: Floats, k: Integers, moment: float) -> int:
    """Write to ``active_forces`` the impulses of the inelastic impact on Coulomb's cone, of which none pulls.

    The search starts from the impulses at hand.  The rates are those at hand and what the ``free_accelerations`` make
    of them in a ``moment`` [s]; those rates take the place of the accelerations.  Return 1 if the impulses settle.
    """
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        contact = contact_at(S, w, k, active.slot)
        write_friction(S, w, k, a)
        active.mu_static = active.mu = active.mu if active.at_rest == 0 else active.mu_static
        active.at_rest = active.normal_held = active.tangent_held = 1
        for r in range(3):
            given = r == 0 and contact.normal_function != 0
            active.free[r] = moment * active.free[r] + (0.0 if given else contact.rate[r])
    _keep_rigid(S, w, k)
    found = _go_on(S, w, k)
    if found == 0:
        sweep(S, w, k, SWEEPS)
        if step_by_newton(S, w, k, STEPS) == 1:
            return 1
        for i in range(3 * S.n_active):
            w[S.active_forces + i] = 0.0
        found = _follow(S, w, k)
    if found == 1:
        # where they are unique those of contacts that do not give way are next to them
        _step_or_stay(S, w, k, _LAST)
    return found
