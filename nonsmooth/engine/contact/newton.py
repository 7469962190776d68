"""The solver "newton" of the contact problem: a semismooth Newton method on Coulomb's cones.

The laws of a contact at rest hold if and only if its natural map vanishes (Alart and Curnier, Comput. Methods Appl.
Mech. Eng. 92 (1991) 353-375):

    f_n - max(0, y_n) = 0,
    f_t - (projection of y_t on the disc of radius mu max(0, y_n)) = 0,    y = f - a / g,

where a is the acceleration and g the inverse mass of the contact. Friction that slides adds f_t + mu f_n d = 0 instead.
The map has kinks, and at these the path to the solution may lead over larger values. So the line search compares with a
weighted mean of the past values, not with the last one (Zhang and Hager, SIAM J. Optim. 14 (2004) 1043-1056). Sweeps of
Gauss-Seidel find the start.

The method converges quadratically. Gauss-Seidel alone converges slowly where many contacts press on each other, and
Lemke's method needs a full matrix.
"""

from __future__ import annotations

from nonsmooth.engine.contact.gauss_seidel import sweep
from nonsmooth.engine.contact.trial import tangential_inverse_mass
from nonsmooth.engine.delassus.delassus import acceleration, diagonal_block
from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.memory.layout import FIRST_ROW, NORMAL_ROW, SINGULAR
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, at, entry_point, kernel
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.arrays import copy_numbers
from nonsmooth.engine.numerics.band import open_band
from nonsmooth.engine.numerics.integers import power
from nonsmooth.engine.numerics.linear import band_row, eliminate
from nonsmooth.engine.numerics.vectors import Pair, length

STAGES = 4
"""Number of stages. Each starts from better forces, because each has ten times as many sweeps as the one before."""
_SWEEPS = 10
"""Maximum number of sweeps before the Newton steps of the first stage."""
STEPS = 30
"""Maximum number of Newton steps of a stage. If convergence is not quadratic by then, the start was too far away."""
_HALVINGS = 8
"""Number of lengths of a Newton step that the line search tries, each half of the one before."""
_DECREASE = 1e-4
"""Decrease of the squared map that the line search requires, relative to the mean: Armijo's usual value."""
_MEMORY = 0.85
"""Weight of the past in the mean of the line search: 0 is monotone, 1 a plain mean. It is the authors' value."""
_SHIFT = 1e-8
"""Added to the diagonal, whose entries are about 1, so that redundant forces do not make the matrix singular."""
_SETTLED = 1e-11
"""Length of the natural map, relative to that of the forces, at which they have settled. Trials make them exact."""


@entry_point("b1(ws, i8)")
def search_by_newton(ws: Workspace, stage: int) -> bool:
    """Improve the forces by the sweeps and the Newton steps of a stage, counted from 0. True if they have settled."""
    # each stage has ten times as many sweeps as the one before, and so a better start
    sweep(ws, _SWEEPS * power(10, stage))
    return step_by_newton(ws, STEPS)


@kernel("b1(ws, i8)")
def step_by_newton(ws: Workspace, max_steps: int) -> bool:
    """Improve the forces by Newton steps. True if they settle within ``max_steps``, False after an interrupt, too.

    Forces that have not settled are those of the last step that decreases the natural map, whose zero is the solution.
    """
    n = 3 * ws.problem.n_active
    square = write_natural_map(ws)
    # the line search compares with a weighted mean of the past squares (Zhang and Hager)
    mean, weight = square, 1.0
    for _ in range(max_steps):
        if interrupted(ws, ws.problem.n_active * ws.problem.half_band):
            return False
        size = 0.0
        for i in range(n):
            size += ws.problem.forces[i] * ws.problem.forces[i]
        if square <= _SETTLED * _SETTLED * size:
            return True
        if not _find_step(ws):
            return False
        square = _search_along_step(ws, mean)
        # negative: no length of the step decreases the natural map
        if square < 0.0:
            return False
        mean = (_MEMORY * weight * mean + square) / (_MEMORY * weight + 1.0)
        weight = _MEMORY * weight + 1.0
    return False


@kernel("b1(ws)")
def _find_step(ws: Workspace) -> bool:
    """Write Newton's step to ``x`` [N]. False if the matrix is singular or has too many entries: the run then stops."""
    n = 3 * ws.problem.n_active
    if not _write_jacobian(ws):
        return False
    # the elimination replaces the right-hand side, minus the natural map, by the step
    for i in range(n):
        ws.problem.x[i] = -ws.problem.right[i]
    return eliminate(ws.floats, ws.problem.matrix.start, n, ws.problem.half_band, ws.problem.x.start, SINGULAR)


@kernel("f8(ws, f8)")
def _search_along_step(ws: Workspace, mean: float) -> float:
    """Make the longest step along ``x`` that decreases the squared natural map below its ``mean`` of past steps [N^2].

    Returns the squared map there, or -1 if no step does: the forces are then as before. The natural map vanishes if the
    contact laws hold.
    """
    n, forces, kept, step_length = 3 * ws.problem.n_active, ws.problem.forces.start, ws.problem.forces_kept.start, 1.0
    copy_numbers(ws.floats, forces, n, kept)
    for _ in range(_HALVINGS):
        for i in range(n):
            ws.problem.forces[i] = ws.problem.forces_kept[i] + step_length * ws.problem.x[i]
        square = write_natural_map(ws)
        if square < (1.0 - _DECREASE * step_length) * mean:
            return square
        step_length *= 0.5
    copy_numbers(ws.floats, kept, n, forces)
    return -1.0


@kernel("f8(ws, ActiveContact)")
def _trial_normal_force(ws: Workspace, active: ActiveContact) -> float:
    """Normal force y_n = f_n - a_n / g of a contact before it is projected on positive ones, or the given one [N]."""
    if active.has_given_force:
        return float(active.given_force)
    return float(active.normal_force - active.normal_acceleration / diagonal_block(ws, active.index).nn)


@kernel("v2(ws, ActiveContact)")
def _trial_friction(ws: Workspace, active: ActiveContact) -> Pair:
    """Friction y_t = f_t - a_t / g of a contact before it is projected on Coulomb's disc [N].

    a_t is its slip acceleration, which must be written, and g its tangential inverse mass.
    """
    g = tangential_inverse_mass(ws, active)
    y1 = active.friction[0] - active.slip_acceleration[0] / g
    return y1, active.friction[1] - active.slip_acceleration[1] / g


@kernel("f8(ws)")
def write_natural_map(ws: Workspace) -> float:
    """Write the natural map to ``right`` [N], and the accelerations of the contacts. Returns its square [N^2].

    It vanishes if the contact laws hold: f_n less max(0, y_n), and f_t less the projection of y_t on the disc of radius
    mu max(0, y_n), with y = f - a / g and the inverse mass g. Friction that slides is given by its direction, and needs
    no projection.
    """
    square = 0.0
    for active in ws.actives:
        right = at(ws.floats, ws.problem.right.start + 3 * active.index)
        for r in range(3):
            active.acceleration[r] = acceleration(ws, active, r)
        y = _trial_normal_force(ws, active)
        right[0] = active.normal_force - max(0.0, y)
        radius = active.friction_coefficient * max(0.0, y)
        t1, t2 = active.friction
        if not active.is_at_rest:
            # friction that slides is -mu f_n d
            along = active.friction_coefficient * active.normal_force
            right[1], right[2] = t1 + along * active.direction[0], t2 + along * active.direction[1]
        else:
            y1, y2 = _trial_friction(ws, active)
            size = length((y1, y2))
            # projection on the disc: y_t itself inside, its point on the edge outside
            factor = radius / size if size > radius else 1.0
            right[1], right[2] = t1 - factor * y1, t2 - factor * y2
        for r in range(3):
            square += right[r] * right[r]
    return square


# --- its derivative ---------------------------------------------------------------------------------------------------


@kernel("b1(ws)")
def _write_jacobian(ws: Workspace) -> bool:
    """Write the derivative of the natural map to ``matrix`` [1]. False if its band has too many entries.

    Each contact has three rows, n, t1 and t2, whatever its mode. The accelerations of the contacts must be written.
    """
    n = 3 * ws.problem.n_active
    # the band is computed from the first unknowns
    for a in range(ws.problem.n_active + 1):
        ws.problem.first_unknown[a] = 3 * a
    if not open_band(ws, n, ws.problem.matrix.start):
        return False
    for active in ws.actives:
        own, y = diagonal_block(ws, active.index).nn, _trial_normal_force(ws, active)
        # closed: f_n - y_n = a_n / g; open, or y_n given: f_n
        if y > 0.0 and not active.has_given_force:
            _add_row(ws, active, NORMAL_ROW, own)
            # so that redundant forces do not make the matrix singular
            ws.floats[_entry(ws, active, NORMAL_ROW, NORMAL_ROW)] += _SHIFT
        else:
            # derivative of f_n
            ws.floats[_entry(ws, active, NORMAL_ROW, NORMAL_ROW)] = 1.0
        if active.is_at_rest:
            _add_rows_of_rest(ws, active, active.friction_coefficient * max(0.0, y))
        else:
            for r in range(FIRST_ROW, 3):
                # derivative of f_t + mu f_n d
                ws.floats[_entry(ws, active, r, r)] = 1.0
                ws.floats[_entry(ws, active, r, NORMAL_ROW)] = active.friction_coefficient * active.direction[r - 1]
    return True


@kernel("i8(ws, ActiveContact, i8, i8)")
def _entry(ws: Workspace, active: ActiveContact, r: int, s: int) -> int:
    """Offset of entry (r, s) of the diagonal block of a contact in ``matrix``."""
    first = 3 * active.index
    line = band_row(ws.problem.matrix.start, first + r, 3 * ws.problem.n_active, ws.problem.half_band)
    return line + first + s


@kernel("void(ws, ActiveContact, i8, f8)")
def _add_row(ws: Workspace, active: ActiveContact, r: int, inverse_mass: float) -> None:
    """Add row ``r`` of a contact of the Delassus matrix, divided by its ``inverse_mass`` g [1/kg], to ``matrix``.

    This is the derivative of a component of f - y = a / g by all forces.
    """
    line = band_row(ws.problem.matrix.start, 3 * active.index + r, 3 * ws.problem.n_active, ws.problem.half_band)
    for block in range(active.first_block, active.end_block):
        for s in range(3):
            ws.floats[line + 3 * ws.island.block_column[block] + s] += (
                ws.island.delassus[DELASSUS * block + 3 * r + s] / inverse_mass
            )


@kernel("void(ws, ActiveContact, f8)")
def _add_rows_of_rest(ws: Workspace, active: ActiveContact, radius: float) -> None:
    """Add the two rows of friction of a contact at rest. ``radius`` is that of Coulomb's disc [N].

    A y_t = f_t - a_t / g inside the disc is its own projection, so f_t - y_t = a_t / g is left: the contact sticks. A
    y_t outside of it is projected on the edge: the contact slides.
    """
    y1, y2 = _trial_friction(ws, active)
    size = length((y1, y2))
    if size <= radius:
        g = tangential_inverse_mass(ws, active)
        for r in range(FIRST_ROW, 3):
            _add_row(ws, active, r, g)
            # so that redundant forces do not make the matrix singular
            ws.floats[_entry(ws, active, r, r)] += _SHIFT
        return
    # f_t less its projection: derivative of f_t first
    for r in range(FIRST_ROW, 3):
        ws.floats[_entry(ws, active, r, r)] = 1.0
    # on a disc of radius 0 the projection is 0, whatever y_t
    if radius > 0.0:
        _subtract_projection(ws, active, radius / size, y1 / size, y2 / size)


@kernel("void(ws, ActiveContact, f8, f8, f8)")
def _subtract_projection(ws: Workspace, active: ActiveContact, factor: float, c1: float, c2: float) -> None:
    """Subtract the derivative of the projection on Coulomb's disc from the two rows of friction of a contact.

    The projection is ``factor`` = mu y_n / |y_t| times y_t, and (``c1``, ``c2``) is the unit vector along y_t. (z1, z2)
    is the derivative of y_t by one force. Its part across the unit vector turns the projection. The growth of mu y_n
    moves it along the vector.
    """
    # inverse masses along the normal and the tangents
    own, g_t = diagonal_block(ws, active.index).nn, tangential_inverse_mass(ws, active)
    n, a = 3 * ws.problem.n_active, active.index
    first = band_row(ws.problem.matrix.start, 3 * a + 1, n, ws.problem.half_band)
    second = band_row(ws.problem.matrix.start, 3 * a + 2, n, ws.problem.half_band)
    for block in range(active.first_block, active.end_block):
        for s in range(3):
            # entries 0, 3 and 6 from g on are rows n, t1 and t2 of column s of the block, column j of the matrix
            g, j = at(ws.floats, ws.island.delassus.start + DELASSUS * block + s), 3 * ws.island.block_column[block] + s
            # of y = f - a / g: first -a / g by the force of column j, then f if it is an own force
            z1, z2 = -g[3] / g_t, -g[6] / g_t
            z1 += 1.0 if j == 3 * a + 1 else 0.0
            z2 += 1.0 if j == 3 * a + 2 else 0.0
            # the part of (z1, z2) across the unit vector is this number times (c2, -c1)
            across = c2 * z1 - c1 * z2
            # growth of the radius mu y_n
            growth = 0.0
            if not active.has_given_force:
                growth = active.friction_coefficient * ((1.0 if j == 3 * a else 0.0) - g[0] / own)
            ws.floats[first + j] -= factor * c2 * across + c1 * growth
            ws.floats[second + j] += factor * c1 * across - c2 * growth
