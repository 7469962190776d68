"""The part of the forces that the motion does not determine, held fixed as long as it keeps every bound.

Of closed contacts whose forces are not unique the flow finds those of least norm.  These may pull, or leave Coulomb's
cone, though others that do neither give the same motion.  So a force from the null space is added to them, chosen to
stay as far from every bound as can be, within a factor, and kept while time goes on.  That such forces keep the
bounds shows that the contacts hold; where they come to a bound a new one is chosen, and only where there is none
the contacts let go.
"""

from __future__ import annotations

from nonsmooth.engine.contact.distribution import distribute
from nonsmooth.engine.contact.trial import NO_FORCE
from nonsmooth.engine.contact.unknowns import force_of, set_force
from nonsmooth.engine.native.kernel import (
    Workspace,
    entry_point,
    kernel,
)
from nonsmooth.engine.numerics.null_band import project_on_null
from nonsmooth.engine.numerics.vectors import length

_AMPLE = 1e-2
"""A distance to the bounds of this part of the largest force is as good as more."""
_RUNGS = 18
"""A distance of the largest force quartered more often than that, 1.5e-11 of it, is none."""
_ARRIVED = 1e-12
"""Forces may be so much out of their cones, relative to the largest, where they count as within."""
_SLACK = 2.0 * NO_FORCE
"""Then a bound that is passed by this part of the largest force holds, as it does to the contact problem."""


@kernel("f8(ws, i8)")
def _least_distance(ws: Workspace, n: int) -> float:
    """Return how far the forces that are not unique are from their bounds at least [N]."""
    least = 1e300
    for i in range(n):
        unknown = ws.unknowns[i]
        active = ws.actives[unknown.contact]
        if unknown.direction == 1 and not active.is_normal_force_unknown and active.has_redundant_force:
            least = min(least, active.static_coefficient * active.normal_force - length(active.friction))
        if unknown.direction != 0 or not active.has_redundant_force:
            continue
        distance = active.normal_force
        if active.sticks:
            distance = min(distance, active.static_coefficient * distance - length(active.friction))
        least = min(least, distance)
    return least


@kernel("void(ws, i8)")
def _keep_null_space_force(ws: Workspace, n: int) -> None:
    """Keep by how much the ``active_forces`` differ from ``x``, those of least norm."""
    for i in range(n):
        unknown = ws.unknowns[i]
        contact = ws.contacts[ws.actives[unknown.contact].contact]
        contact.null_space_force[unknown.direction] = force_of(ws, i) - ws.problem.forces_at_start[i]


@kernel("b1(ws, f8, i8)")
def _choose(ws: Workspace, largest: float, rung: int) -> bool:
    """Choose forces off every bound by so many quarterings of the largest, from those of least norm; 1 if there are."""
    for i in range(ws.problem.n_unknown):
        set_force(ws, i, ws.problem.forces_at_start[i])
    return distribute(ws, 0.25**rung * largest, _ARRIVED * largest)


@kernel("b1(ws, f8)")
def _choose_farthest(ws: Workspace, largest: float) -> bool:
    """Choose forces as far off every bound as can be, within a factor; false if there are none."""
    near, far = 1, 0
    while not _choose(ws, largest, near):
        if near == _RUNGS:
            return False
        far, near = near, min(2 * near, _RUNGS)
    rung = near
    while near - far > 1:
        rung = (near + far) // 2
        if _choose(ws, largest, rung):
            near = rung
        else:
            far = rung
    return rung == near or _choose(ws, largest, near)


@entry_point("b1(ws)")
def choose_null_space_force(ws: Workspace) -> bool:
    """Choose the null-space force, ``x`` being the forces of least norm; true if it keeps off every bound."""
    n = ws.problem.n_unknown
    largest = 0.0
    for a in range(ws.problem.n_active):
        contact = ws.contacts[ws.actives[a].contact]
        contact.slack = 0.0
        for r in range(3):
            contact.null_space_force[r] = 0.0
    for i in range(n):
        ws.problem.forces_at_start[i] = ws.problem.x[i]
        set_force(ws, i, ws.problem.x[i])
        largest = max(largest, abs(ws.problem.x[i]))
    if _least_distance(ws, n) >= _AMPLE * largest:
        return True
    found = _choose_farthest(ws, largest)
    if not found:
        for i in range(n):
            set_force(ws, i, ws.problem.forces_at_start[i])
        distribute(ws, 0.0, _ARRIVED * largest)
        for a in range(ws.problem.n_active):
            ws.contacts[ws.actives[a].contact].slack = _SLACK * largest
    _keep_null_space_force(ws, n)
    for i in range(n):
        ws.problem.x[i] = ws.problem.forces_at_start[i]
    return found


@kernel()
def add_null_space_force(ws: Workspace) -> None:
    """Add what of the null-space force lies in the present null space to the unknowns ``x``."""
    n = ws.problem.n_unknown
    for i in range(n):
        unknown = ws.unknowns[i]
        contact = ws.contacts[ws.actives[unknown.contact].contact]
        ws.problem.sigma[i] = contact.null_space_force[unknown.direction]
    if ws.problem.is_null_space_banded:
        project_on_null(ws, n, ws.problem.sigma.start)
        for i in range(n):
            ws.problem.x[i] += ws.problem.sigma[i]
        return
    for i in range(n):
        for j in range(n):
            ws.problem.x[i] += ws.problem.null[i * n + j] * ws.problem.sigma[j]


@kernel()
def shift_forces(ws: Workspace) -> None:
    """Add what of the null-space force lies in the present null space to the ``active_forces``, those of least norm."""
    for i in range(ws.problem.n_unknown):
        ws.problem.x[i] = force_of(ws, i)
    add_null_space_force(ws)
    for i in range(ws.problem.n_unknown):
        set_force(ws, i, ws.problem.x[i])
