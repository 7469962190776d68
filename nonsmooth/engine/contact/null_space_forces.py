"""The part of redundant forces that the motion does not determine.

The forces of least norm may be tensile or leave Coulomb's cone, although other forces with the same motion do not. So a
force from the null space is added to them. It is chosen as far inside all cones as possible, within a factor of
four, and then stays constant. So forces remain smooth in time, and a new choice is needed only if a force comes to its
bound again. If no force is inside all cones, contacts must open or slide: an event.

With a new choice at each instant, no force would approach its bound gradually, and no guard could locate the event.

The distance is found by bisection of its exponent: for each distance, a convex problem decides
(:mod:`nonsmooth.engine.contact.distribution`).
"""

from __future__ import annotations

import math

from nonsmooth.engine.contact.distribution import distribute
from nonsmooth.engine.contact.trial import NO_FORCE
from nonsmooth.engine.contact.unknowns import force_of, set_force
from nonsmooth.engine.memory.layout import FIRST_ROW, NORMAL_ROW
from nonsmooth.engine.native.kernel import Workspace, entry_point, kernel
from nonsmooth.engine.numerics.arrays import copy_numbers, largest_size, subtract_part
from nonsmooth.engine.numerics.null_band import project_on_null
from nonsmooth.engine.numerics.vectors import length

_LARGE_DISTANCE = 1e-2
"""Distance to the bounds, relative to the largest force, at which forces of least norm are left as they are."""
_QUARTERINGS = 18
"""Maximum number of times that the distance is quartered, down to 1.5e-11 of the largest force, which is round-off."""
_DISTRIBUTED = 1e-12
"""Distance of a force to its cone, relative to the largest force, that counts as zero."""
_SLACK = 2.0 * NO_FORCE
"""Excess over the bounds, relative to the largest force, that is allowed if no forces are inside all cones. The contact
problem accepts as much."""


@entry_point("b1(ws)")
def choose_null_space_force(ws: Workspace) -> bool:
    """Choose the null-space force of each active contact, so that redundant forces are far inside their cones.

    A null-space force causes no motion. True if all forces are then within their bounds. ``x`` must hold the forces of
    least norm [N]. If the choice fails, the forces closest to the cones are taken, and ``slack`` is what their bounds
    may be exceeded by [N]. ``x`` is as before in the end, and the forces of the contacts are overwritten.
    """
    n, x, least_norm = ws.problem.n_unknown, ws.problem.x.start, ws.problem.forces_at_start.start
    largest = largest_size(ws.floats, x, n)
    copy_numbers(ws.floats, x, n, least_norm)
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        contact.slack = 0.0
        for r in range(3):
            contact.null_space_force[r] = 0.0
    _set_least_norm(ws)
    # forces of least norm that are far inside are kept: the null-space force is zero
    if _least_distance(ws) >= _LARGE_DISTANCE * largest:
        return True
    has_found = _choose_farthest(ws, largest)
    if not has_found:
        _set_least_norm(ws)
        # no forces are inside all cones; those closest to the cones themselves (inset 0) are taken
        distribute(ws, inset=0.0, allowed=_DISTRIBUTED * largest)
        for active in ws.actives:
            ws.contacts[active.contact].slack = _SLACK * largest
    for i in range(n):
        unknown = ws.unknowns[i]
        contact = ws.contacts[ws.actives[unknown.contact].contact]
        # `forces_at_start` holds the forces of least norm
        contact.null_space_force[unknown.direction] = force_of(ws, i) - ws.problem.forces_at_start[i]
    # `distribute` has used x for its steps
    copy_numbers(ws.floats, least_norm, n, x)
    return has_found


@kernel()
def _set_least_norm(ws: Workspace) -> None:
    """Set the unknown contact forces to those of least norm, which ``forces_at_start`` holds [N]."""
    for i in range(ws.problem.n_unknown):
        set_force(ws, i, ws.problem.forces_at_start[i])


@kernel("f8(ws)")
def _least_distance(ws: Workspace) -> float:
    """Smallest distance of the redundant forces to their bounds [N]. It is negative if a force exceeds its bound.

    The bounds are a normal force of zero, and Coulomb's disc. Without redundant forces it is infinite.
    """
    least = math.inf
    for i in range(ws.problem.n_unknown):
        unknown = ws.unknowns[i]
        active = ws.actives[unknown.contact]
        has_given_normal = unknown.direction == FIRST_ROW and not active.is_normal_force_unknown
        # with a given normal force, the friction alone is unknown
        if has_given_normal and active.has_redundant_force:
            least = min(least, active.static_coefficient * active.normal_force - length(active.friction))
        # friction is checked along with its normal force
        if unknown.direction != NORMAL_ROW or not active.has_redundant_force:
            continue
        distance = active.normal_force
        if active.sticks:
            distance = min(distance, active.static_coefficient * distance - length(active.friction))
        least = min(least, distance)
    return least


@kernel("b1(ws, f8)")
def _choose_farthest(ws: Workspace, largest: float) -> bool:
    """Find forces as far inside their cones as possible, within a factor of four. False if there are none.

    The distance is ``largest`` / 4^n [N]. The number n of quarterings is doubled until forces exist, then bisected.
    The search ends after ``_QUARTERINGS``. If True, the contact forces are those found.
    """
    # with n = 0 the distance would be the largest force itself: no forces
    feasible, infeasible = 1, 0
    while not _choose_at_distance(ws, largest, feasible):
        if feasible == _QUARTERINGS:
            return False
        infeasible, feasible = feasible, min(2 * feasible, _QUARTERINGS)
    last = feasible
    # the farthest choice has the least n that is feasible
    while feasible - infeasible > 1:
        last = (feasible + infeasible) // 2
        if _choose_at_distance(ws, largest, last):
            feasible = last
        else:
            infeasible = last
    # the forces are those of the last attempt, which may have failed
    return last == feasible or _choose_at_distance(ws, largest, feasible)


@kernel("b1(ws, f8, i8)")
def _choose_at_distance(ws: Workspace, largest: float, n_quarterings: int) -> bool:
    """Find forces at least ``largest`` / 4^n_quarterings [N] inside their cones. True if there are any."""
    # from the forces of least norm, along the null space: the motion stays the same
    _set_least_norm(ws)
    # a float as exponent: with an integer exponent, numba's power contains code that raises an error, and machine code
    # with such code would need numba at every start of a program
    return distribute(ws, inset=0.25 ** float(n_quarterings) * largest, allowed=_DISTRIBUTED * largest)


@kernel()
def add_null_space_force(ws: Workspace) -> None:
    """Add the null-space force of the contacts to the unknowns ``x`` [N], projected on the present null space.

    The null space may have turned since the force was chosen. The projection keeps the motion unchanged.
    """
    n = ws.problem.n_unknown
    for i in range(n):
        unknown = ws.unknowns[i]
        contact = ws.contacts[ws.actives[unknown.contact].contact]
        ws.problem.sigma[i] = contact.null_space_force[unknown.direction]
    if ws.problem.is_null_space_banded:
        project_on_null(ws, n, ws.problem.sigma.start)
        # minus -1: add
        subtract_part(ws.floats, ws.problem.x.start, -1.0, ws.problem.sigma.start, n)
        return
    for i in range(n):
        for j in range(n):
            ws.problem.x[i] += ws.problem.null[i * n + j] * ws.problem.sigma[j]


@kernel()
def shift_forces(ws: Workspace) -> None:
    """Add the chosen null-space force to the contact forces [N], which must be those of least norm.

    The motion stays the same. So redundant forces change continuously until a new choice is made.
    """
    for i in range(ws.problem.n_unknown):
        ws.problem.x[i] = force_of(ws, i)
    add_null_space_force(ws)
    for i in range(ws.problem.n_unknown):
        set_force(ws, i, ws.problem.x[i])
