"""Exact slip directions: the friction of a contact that starts to slide opposes its slip acceleration, Eq. (17).

The direction d of a slip that begins is an unknown of the contact problem. Solvers find it to their tolerance only.
Here it is made exact by Newton's method on the angles of all such directions:

    a_t x d = 0    for each contact at rest that slides,

where x is the two-dimensional cross product. A turn of d by an angle moves the friction by the angle times mu f_n
across d. This product is the unknown, because the system then has no small columns if a contact is almost without load.
The forces of the current directions are found exactly first, so that the other residuals of the system are zero.
Convergence is quadratic from a good guess.
"""

from __future__ import annotations

import math

from nonsmooth.engine.contact.forces import eliminate_reduced, solve_reduced_for_least_norm
from nonsmooth.engine.contact.trial import find_tried_forces
from nonsmooth.engine.contact.unknowns import list_unknowns, starts_to_slide
from nonsmooth.engine.delassus.delassus import diagonal_block, slip_acceleration
from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.memory.layout import SINGULAR
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, at, entry_point, kernel
from nonsmooth.engine.numerics.arrays import copy_numbers
from nonsmooth.engine.numerics.band import open_band
from nonsmooth.engine.numerics.linear import band_row, band_width
from nonsmooth.engine.numerics.null_band import solve_shifted
from nonsmooth.engine.numerics.vectors import length, unit

_STEPS = 25
"""Maximum number of Newton steps. Bad guesses need several steps before convergence is quadratic."""
_LARGEST_TURN = 0.7
"""Largest turn of a direction in one step [rad]. Newton's model of a turn is linear."""
EXACT = 1e-14
"""Acceleration across a slip, relative to the largest acceleration, that is round-off."""
_NEARLY_EXACT = 1e-8
"""The same if steps no longer improve it: near redundant contacts round-off is larger."""


@kernel("b1(ws)")
def has_slip_that_begins(ws: Workspace) -> bool:
    """True if an active contact starts to slide in the modes under trial: its slip direction is an unknown."""
    for active in ws.actives:
        if starts_to_slide(active):
            return True
    return False


@entry_point("b1(ws)")
def find_slip_directions(ws: Workspace) -> bool:
    """Turn the directions of slips that begin until the slip accelerations oppose the friction (Newton's method).

    True if they do, or if no slip begins: the forces are then not computed. Else the forces are those of the final
    directions in the modes under trial. Their signs and bounds are not checked, nor whether a slip is against its
    friction or along it. False if the steps do not converge: directions and forces are then those of the last steps.
    """
    if not has_slip_that_begins(ws):
        return True
    best = math.inf
    for _ in range(_STEPS):
        # the forces of the present directions are exact, so only the rows of turns have residuals
        find_tried_forces(ws)
        n = list_unknowns(ws, with_turns=True)
        worst = _write_residuals(ws, n)
        # near redundant contacts round-off is larger: then it is enough that steps no longer improve
        if worst <= EXACT or (worst <= _NEARLY_EXACT and worst >= best):
            return True
        best = min(best, worst)
        # False: the band has too many entries, and the run stops
        if not open_band(ws, n, ws.problem.reduced.start):
            return False
        for i in range(n):
            _write_row(ws, i, n)
        _solve(ws, n)
        for i in range(n):
            if ws.unknowns[i].is_turn:
                _turn(ws, ws.actives[ws.unknowns[i].contact], ws.problem.x[i])
    return False


@kernel("f8(ws, i8)")
def _write_residuals(ws: Workspace, n: int) -> float:
    """Write the right-hand side of Newton's system. Returns the largest residual over the largest acceleration [1].

    The residual of a turn is the slip acceleration across the slip direction d. The forces are exact for the present
    directions, so the other rows have none.
    """
    worst = 0.0
    for i in range(n):
        unknown = ws.unknowns[i]
        ws.problem.right[i] = 0.0
        if unknown.is_turn:
            active = ws.actives[unknown.contact]
            (d1, d2), (a1, a2) = active.direction, slip_acceleration(ws, active)
            # Newton's right-hand side is minus the residual a_t x d, a cross product in the plane
            ws.problem.right[i] = -(a1 * d2 - a2 * d1)
            residual = abs(ws.problem.right[i]) / max(ws.problem.acceleration_scale, abs(a1), abs(a2))
            worst = max(worst, residual)
    return float(worst)


@kernel("void(ws, i8, i8)")
def _write_row(ws: Workspace, i: int, n: int) -> None:
    """Write row ``i`` of ``n`` of Newton's system to ``reduced``: the change of an acceleration by each unknown.

    It is the acceleration along unknown force ``i``, or across the slip direction d if the unknown is a turn.
    """
    unknown = ws.unknowns[i]
    line, r = band_row(ws.problem.reduced.start, i, n, ws.problem.half_band), unknown.direction
    active = ws.actives[unknown.contact]
    d1, d2 = active.direction
    for block in range(active.first_block, active.end_block):
        other = ws.actives[ws.island.block_column[block]]
        out, end = line + other.first_unknown, line + other.end_unknown
        # the other contact has no unknowns
        if out == end:
            continue
        # a block of the Delassus matrix, row by row
        g = at(ws.floats, ws.island.delassus.start + DELASSUS * block)
        if unknown.is_turn:
            # a cross product with the two tangential rows of the block
            g0, g1, g2 = d2 * g[3] - d1 * g[6], d2 * g[4] - d1 * g[7], d2 * g[5] - d1 * g[8]
        else:
            g0, g1, g2 = g[3 * r], g[3 * r + 1], g[3 * r + 2]
        e1, e2 = other.direction
        # the normal force of a contact that slides carries its friction along
        if other.is_normal_force_unknown:
            ws.floats[out] = g0 if other.sticks else g0 - other.friction_coefficient * (e1 * g1 + e2 * g2)
            out += 1
        if other.sticks:
            ws.floats[out], ws.floats[out + 1] = g1, g2
            out += 2
        # what is left is the turn of the direction of the other contact: it moves the friction by (e2, -e1) per newton
        if out < end:
            ws.floats[out] = e2 * g1 - e1 * g2
    if unknown.is_turn:
        _add_turn(ws, active, i, n)


@kernel("void(ws, ActiveContact, i8, i8)")
def _add_turn(ws: Workspace, active: ActiveContact, i: int, n: int) -> None:
    """Add the change of the residual a_t x d that the turn of d itself causes: a_t . d per unit of mu f_n.

    It is very large if the contact has almost no load. The row is then scaled down, or all other entries of the matrix
    would count as zero.
    """
    own = diagonal_block(ws, active.index)
    force, (d1, d2) = active.friction_coefficient * active.normal_force, active.direction
    # without a load the change is infinite; `_turn` then takes the direction from the acceleration
    if not abs(force) > 0.0:
        return
    line = band_row(ws.problem.reduced.start, i, n, ws.problem.half_band)
    a1, a2 = slip_acceleration(ws, active)
    change = (a1 * d1 + a2 * d2) / force
    ws.floats[line + i] += change
    # size of the other entries of the row
    inverse_mass = max(own.nn, own.t11, own.t22)
    weight = inverse_mass / (inverse_mass + abs(change))
    ws.problem.right[i] *= weight
    # all entries of the row within the band
    for j in range(max(0, i - ws.problem.half_band), min(n, i + ws.problem.half_band + 1)):
        ws.floats[line + j] *= weight


@kernel("void(ws, i8)")
def _solve(ws: Workspace, n: int) -> None:
    """Write Newton's step to ``x``. A singular system is solved for least norm, or with a shift if it is banded.

    The system has ``n`` unknowns: forces [N], and turns times mu f_n [N]. ``reduced`` holds its matrix.
    """
    if eliminate_reduced(ws, n, SINGULAR):
        return
    # orthogonal decompositions would fill a band
    if band_width(n, ws.problem.half_band) < n:
        copy_numbers(ws.floats, ws.problem.right.start, n, ws.problem.x.start)
        # if this fails, too, the step is arbitrary; the residuals after it decide
        solve_shifted(ws, n)
    else:
        solve_reduced_for_least_norm(ws, n, max_rank=n)


@kernel("void(ws, ActiveContact, f8)")
def _turn(ws: Workspace, active: ActiveContact, step: float) -> None:
    """Turn the slip direction of a contact by Newton's ``step`` [N], which is the angle times mu f_n.

    It turns by ``_LARGEST_TURN`` at most. If mu f_n is zero, the angle is unknown, and the slip takes the direction of
    its acceleration, or keeps its own if there is none.
    """
    d1, d2 = active.direction
    force = active.friction_coefficient * active.normal_force
    if abs(force) > 0.0:
        angle = max(-_LARGEST_TURN, min(_LARGEST_TURN, step / force))
        active.direction = (d1 * math.cos(angle) - d2 * math.sin(angle), d2 * math.cos(angle) + d1 * math.sin(angle))
    elif length(slip_acceleration(ws, active)) > 0.0:
        active.direction = unit(slip_acceleration(ws, active))
