"""The inelastic impact with friction: impulses that leave no approach, and oppose the slip after the impact.

It is one step of Moreau's time stepping (J. J. Moreau, in Nonsmooth Mechanics and Applications, Springer (1988) 1-82).
With the velocities z of the contacts before the impact, G the Delassus matrix and p the impulses, the velocities
after it are z + G p, and

    0 <= p_n,  0 <= z_n + (G p)_n,  one of them zero;
    p_t on Coulomb's disc of radius mu p_n, opposite to the slip z_t + (G p)_t, or inside it if that is zero.

If contacts wedge, or are redundant, Gauss-Seidel needs very many sweeps, and Newton's method diverges from a bad start.
Compliance of the contacts, which is a positive number added to the diagonal of G, cures both. So there are three
attempts, the cheapest first:

1. with a negligible compliance, from the given impulses, such as those of the step before;
2. with rigid contacts, from sweeps of Gauss-Seidel;
3. with a large compliance, which is reduced in steps to a negligible one. Each solution starts the search for the next.
"""

from __future__ import annotations

from nonsmooth.engine.contact.gauss_seidel import SWEEPS, sweep
from nonsmooth.engine.contact.newton import STEPS, step_by_newton
from nonsmooth.engine.contact.problem import write_friction
from nonsmooth.engine.delassus.delassus import diagonal_block
from nonsmooth.engine.memory.layout import NORMAL_ROW
from nonsmooth.engine.native.kernel import Workspace, entry_point, kernel
from nonsmooth.engine.numerics.arrays import clear, copy_numbers
from nonsmooth.engine.numerics.vectors import length

_NEGLIGIBLE = 0.5
"""Error of a velocity by compliance that is negligible, in velocity tolerances."""
_RIGID_STEPS = 3
"""Maximum number of Newton steps from a negligible compliance to none. One or two suffice if impulses are unique."""
_REDUCTION = 0.01
"""Ratio of one compliance to the one before. If a step fails, its square root is tried."""
_LARGEST_RATIO = 0.5
"""Ratio of compliances above which the reduction is given up: it would need too many steps."""


@entry_point("b1(ws, f8)")
def inelastic_impulses(ws: Workspace, time: float) -> bool:
    """Find the impulses of the inelastic impact of the active contacts [N s]. True if they are found.

    They leave no approach, and their friction opposes the slip after the impact. Before: ``rate`` holds velocities,
    ``free`` accelerations without contact forces, and ``force`` the impulses to start from. The impact comes after the
    accelerations have acted for a ``time`` [s]. After: ``force`` holds the impulses, and ``free`` the velocities
    without them. If False, they are those of compliant contacts: they leave an approach, but none pulls, no friction
    exceeds its bound or acts along the slip, and they bring in no energy. Coefficients of friction are overwritten.
    """
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        write_friction(ws, active)
        # the solvers know one coefficient; a contact at rest has the static one
        mu = active.static_coefficient if active.is_at_rest else active.friction_coefficient
        active.static_coefficient = active.friction_coefficient = mu
        # slips may stop, so all contacts count as at rest
        active.is_at_rest = active.is_normal_force_unknown = active.sticks = True
        for r in range(3):
            # row n of a compliant contact is its given impulse, not a velocity
            is_given = r == NORMAL_ROW and contact.is_compliant
            active.free[r] = time * active.free[r] + (0.0 if is_given else contact.rate[r])
            # entries 0, 4 and 8 are the diagonal, which a compliance will change
            active.rigid[r] = diagonal_block(ws, active.index).entries[4 * r]
    has_found = _solve_from_guess(ws)
    if not has_found:
        # second attempt: rigid contacts, from sweeps; without compliance, nothing is left to improve
        sweep(ws, SWEEPS)
        if step_by_newton(ws, STEPS):
            return True
        # third attempt: compliant contacts, from no impulses
        clear(ws.floats, ws.problem.forces.start, 3 * ws.problem.n_active)
        has_found = _reduce_compliance(ws)
    if has_found:
        # if rigid impulses are unique, those of a negligible compliance are close to them
        _step_or_restore(ws, _RIGID_STEPS)
    return has_found


@kernel("void(ws, f8)")
def _set_compliance(ws: Workspace, compliance: float) -> None:
    """Add ``compliance`` times the diagonal of G to it: 0 restores the rigid contacts, 1 doubles the diagonal.

    This artificial compliance makes a solution unique and the search for it stable. Both tangents of a contact get the
    same. A contact with a compliant normal law gets none along its normal.
    """
    for active in ws.actives:
        own = diagonal_block(ws, active.index)
        # the normal impulse of a contact with a normal law is given
        is_rigid = not ws.contacts[active.contact].is_compliant
        tangential = compliance * max(active.rigid[1], active.rigid[2])
        own.nn = active.rigid[0] * (1.0 + compliance if is_rigid else 1.0)
        own.t11, own.t22 = active.rigid[1] + tangential, active.rigid[2] + tangential


@kernel("f8(ws)")
def _largest_velocity(ws: Workspace) -> float:
    """Largest change of velocity that the impulse of a contact causes at this contact itself [m/s].

    It is the scale of the error that a compliance makes.
    """
    largest = 0.0
    for active in ws.actives:
        tangential = max(active.rigid[1], active.rigid[2]) * length(active.friction)
        largest = max(largest, active.rigid[0] * active.normal_force, tangential)
    return largest


@kernel("b1(ws, f8)")
def _is_negligible(ws: Workspace, compliance: float) -> bool:
    """True if a ``compliance`` changes the velocities by less than the part ``_NEGLIGIBLE`` of their tolerance."""
    # a compliance is a part of the diagonal of G, so it changes a velocity by this part
    return compliance * _largest_velocity(ws) <= _NEGLIGIBLE * ws.tolerance.velocity


@kernel("b1(ws, i8)")
def _step_or_restore(ws: Workspace, max_steps: int) -> bool:
    """Improve the impulses by at most ``max_steps`` Newton steps. True if they settle. Otherwise they are restored."""
    n, forces, kept = 3 * ws.problem.n_active, ws.problem.forces.start, ws.problem.forces_at_start.start
    copy_numbers(ws.floats, forces, n, kept)
    if step_by_newton(ws, max_steps):
        return True
    copy_numbers(ws.floats, kept, n, forces)
    return False


@kernel("b1(ws)")
def _solve_from_guess(ws: Workspace) -> bool:
    """Find the impulses with a negligible compliance, from the given ones. The contacts are rigid again after it.

    False if this fails, if the given impulses are zero, or if the compliance is not negligible for those found.
    """
    largest = _largest_velocity(ws)
    # without impulses to start from there is no scale for the compliance
    if largest == 0.0:
        return False
    # at most 1, and half of a negligible one, because the impulses to be found may exceed the given ones
    compliance = min(1.0, 0.5 * _NEGLIGIBLE * ws.tolerance.velocity / largest)
    _set_compliance(ws, compliance)
    has_settled = _step_or_restore(ws, STEPS)
    _set_compliance(ws, compliance=0.0)
    return has_settled and _is_negligible(ws, compliance)


@kernel("b1(ws)")
def _reduce_compliance(ws: Workspace) -> bool:
    """Follow the impulses from a large compliance to a negligible one. True if this is reached.

    Each solution starts the search for the next. If one is not found, the next attempt reduces the compliance less, but
    a ratio above ``_LARGEST_RATIO`` ends the search. The contacts are rigid again after it.
    """
    # 1: the diagonal of G is doubled
    compliance, ratio = 1.0, _REDUCTION
    _set_compliance(ws, compliance)
    sweep(ws, SWEEPS)
    if not _step_or_restore(ws, STEPS):
        # not even the first solution is found: skip the loop. The impulses are those of the sweeps, within their cones
        ratio = 1.0
    while ratio <= _LARGEST_RATIO and not _is_negligible(ws, compliance):
        _set_compliance(ws, ratio * compliance)
        if _step_or_restore(ws, STEPS):
            compliance *= ratio
        else:
            # a smaller reduction: two such steps make the one that has failed
            ratio **= 0.5
    _set_compliance(ws, compliance=0.0)
    return _is_negligible(ws, compliance)
