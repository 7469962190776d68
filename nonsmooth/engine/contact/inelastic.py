"""The inelastic impact on Coulomb's cone: what one step of Moreau's rule asks for."""

from __future__ import annotations

from nonsmooth.engine.contact.accelerated import sweep_accelerated
from nonsmooth.engine.contact.newton import step_by_newton
from nonsmooth.engine.contact.problem import write_friction
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, active_at, contact_at, kernel

_EXACT = 1e-4
"""Part of what counts as no velocity to which rates are found,"""
_TRUE = 0.5
"""and to which they have to be where sweeps lead no nearer."""
_SWEEPS, _ROUNDS = 30, 6
"""Newton's method follows so many sweeps, and twice as many in every further round."""


@kernel("i8(S, F, I, f8)")
def inelastic_impulses(S: Scalars, w: Floats, k: Integers, moment: float) -> int:
    """Write to ``active_forces`` the impulses of the inelastic impact on Coulomb's cone, of which none pulls.

    The search starts from the impulses at hand.  The rates are those at hand and what the ``free_accelerations`` make
    of them in a ``moment`` [s]; those rates take the place of the accelerations.  Return 1 if the impulses settle.
    """
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        contact = contact_at(S, w, k, active.slot)
        write_friction(S, w, k, a)
        gives_way, slips = contact.normal_function != 0, active.at_rest == 0
        rests = gives_way or abs(contact.rate[0]) <= S.velocity_tolerance
        active.mu_static = active.mu = active.mu if slips else active.mu_static
        active.at_rest = active.normal_held = active.tangent_held = 1
        for r in range(3):
            # what counts as zero must not hide what the accelerations do
            still = rests if r == 0 else not slips
            active.free[r] = moment * active.free[r] + (0.0 if still else contact.rate[r])
    sweeps = _SWEEPS
    for _round in range(_ROUNDS):
        if sweep_accelerated(S, w, k, _EXACT * S.velocity_tolerance, sweeps) == 1:
            return 1
        if S.sweep_left <= _TRUE * S.velocity_tolerance or step_by_newton(S, w, k) == 1:
            return 1
        sweeps *= 2
    return 0
