"""Semismooth Newton on the cones: the natural map of Alart and Curnier (1991), with a line search.

The search is the non-monotone one of Zhang and Hager (SIAM J. Optim. 14 (2004) 1043-1056): at the kinks of the map the
way to a solution leads over larger values.  The equations of a contact at rest, y = f - rho a being where its force
would go:

    f_N - max(0, y_N) = 0,    f_T - (projection of y_T on the disc of radius mu max(0, y_N)) = 0

They hold iff Eqs. (16) and (17) do.  Sweeps of Gauss-Seidel bring the start near.
"""

from __future__ import annotations

from nonsmooth.engine.contact.gauss_seidel import sweep
from nonsmooth.engine.contact.trial import tangential_inverse_mass
from nonsmooth.engine.delassus.delassus import add_product, diagonal_block
from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.memory.layout import NORMAL_ROW
from nonsmooth.engine.native.kernel import Workspace, at, entry_point, kernel
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.band import open_band
from nonsmooth.engine.numerics.linear import SINGULAR, band_row, eliminate
from nonsmooth.engine.numerics.vectors import length

STAGES = 4
"""Starts from ever better forces: where steps lead nowhere, sweeps do in time."""
_SWEEPS = 10
"""Before the first stage; ten times more before each that follows."""
STEPS = 30
"""Newton steps of one stage: they are quadratic or lead nowhere."""
_HALVINGS = 8
"""Of one step, down to which the natural map must become less than its mean over the steps before,"""
_MEMORY = 0.85
"""in which each counts by this part of the one behind it."""
_FLOOR = 1e-8
"""Added to the diagonal, whose entries are near 1: forces that are not unique must not stop the elimination."""
_SETTLED = 1e-11
"""Length of the natural map, relative to that of the forces, at which they are left to be made exact."""


@kernel("v2(ws, i8)")
def _aim(ws: Workspace, a: int) -> tuple[float, float]:
    """Return where the friction of the active contact ``a`` would go if nothing cut it."""
    active, slope = ws.actives[a], tangential_inverse_mass(ws, ws.actives[a])
    y1 = active.friction[0] - active.slip_acceleration[0] / slope
    return y1, active.friction[1] - active.slip_acceleration[1] / slope


@kernel("f8(ws)")
def write_natural_map(ws: Workspace) -> float:
    """Write the natural map to ``right``; return its square."""
    square = 0.0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        right = at(ws.floats, ws.problem.right.start + 3 * a)
        for r in range(3):
            active.acceleration[r] = add_product(ws, active.free[r], a, r, ws.problem.forces.start)
        y = active.normal_force - active.normal_acceleration / diagonal_block(ws, a).nn
        right[0] = active.normal_force - max(0.0, y)
        radius = active.friction_coefficient * max(0.0, y)
        t1, t2 = active.friction
        if not active.is_at_rest:
            pull = active.friction_coefficient * active.normal_force
            right[1], right[2] = t1 + pull * active.direction[0], t2 + pull * active.direction[1]
        else:
            y1, y2 = _aim(ws, a)
            size = length((y1, y2))
            cut = radius / size if size > radius else 1.0
            right[1], right[2] = t1 - cut * y1, t2 - cut * y2
        for r in range(3):
            square += right[r] * right[r]
    return square


@kernel("void(ws, i8, i8, f8)")
def _add_row(ws: Workspace, a: int, r: int, slope: float) -> None:
    """Add a row of G, that is of contact ``a``, over a slope to the same row of ``matrix``."""
    active = ws.actives[a]
    line = band_row(ws.problem.matrix.start, 3 * a + r, 3 * ws.problem.n_active, ws.problem.half_band)
    for block in range(active.first_block, active.end_block):
        for s in range(3):
            ws.floats[line + 3 * ws.island.block_column[block] + s] += (
                ws.island.delassus[DELASSUS * block + 3 * r + s] / slope
            )


@kernel("void(ws, i8, f8, f8, f8)")
def _add_cut(ws: Workspace, a: int, cut: float, c1: float, c2: float) -> None:
    """Add the derivative of the friction that is cut to the disc, along (c1, c2), to its two rows of ``matrix``."""
    active = ws.actives[a]
    own, slope = diagonal_block(ws, a).nn, tangential_inverse_mass(ws, active)
    n = 3 * ws.problem.n_active
    first, second = (
        band_row(ws.problem.matrix.start, 3 * a + 1, n, ws.problem.half_band),
        band_row(ws.problem.matrix.start, 3 * a + 2, n, ws.problem.half_band),
    )
    for block in range(active.first_block, active.end_block):
        for s in range(3):
            g, j = at(ws.floats, ws.island.delassus.start + DELASSUS * block + s), 3 * ws.island.block_column[block] + s
            z1, z2 = -g[3] / slope, -g[6] / slope
            z1 += 1.0 if j == 3 * a + 1 else 0.0
            z2 += 1.0 if j == 3 * a + 2 else 0.0
            across = c2 * z1 - c1 * z2
            grown = active.friction_coefficient * ((1.0 if j == 3 * a else 0.0) - g[0] / own)
            ws.floats[first + j] -= cut * c2 * across + c1 * grown
            ws.floats[second + j] += cut * c1 * across - c2 * grown


@kernel("b1(ws)")
def _write_jacobian(ws: Workspace) -> bool:
    """Write the derivative of the natural map at the forces at hand to ``matrix``; return 0 if it is too wide."""
    n = 3 * ws.problem.n_active
    for a in range(ws.problem.n_active + 1):
        ws.actives[a].first_unknown = 3 * a
    if not open_band(ws, n, ws.problem.matrix.start):
        return False
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        line = 3 * a
        own = diagonal_block(ws, a).nn
        y = active.normal_force - active.normal_acceleration / own
        row = band_row(ws.problem.matrix.start, line, n, ws.problem.half_band)
        if y > 0.0:
            _add_row(ws, a, NORMAL_ROW, own)
            ws.floats[row + line] += _FLOOR
        else:
            ws.floats[row + line] = 1.0
        for r in range(1, 3):
            row = band_row(ws.problem.matrix.start, line + r, n, ws.problem.half_band)
            ws.floats[row + line + r] = 1.0
            if not active.is_at_rest:
                ws.floats[row + line] = active.friction_coefficient * active.direction[r - 1]
        if not active.is_at_rest:
            continue
        slope = tangential_inverse_mass(ws, active)
        y1, y2 = _aim(ws, a)
        size, radius = length((y1, y2)), active.friction_coefficient * max(0.0, y)
        if size <= radius:
            for r in range(1, 3):
                row = band_row(ws.problem.matrix.start, line + r, n, ws.problem.half_band)
                ws.floats[row + line + r] = 0.0
                _add_row(ws, a, r, slope)
                ws.floats[row + line + r] += _FLOOR
        elif radius > 0.0:
            _add_cut(ws, a, radius / size, y1 / size, y2 / size)
    return True


@entry_point("b1(ws, i8)")
def search_by_newton(ws: Workspace, stage: int) -> bool:
    """Improve the forces by sweeps, ten times more of them in every stage, and Newton steps; return 1 if settled."""
    sweeps = _SWEEPS
    for _stage in range(stage):
        sweeps *= 10
    sweep(ws, sweeps)
    return step_by_newton(ws, STEPS)


@kernel("b1(ws, i8)")
def step_by_newton(ws: Workspace, steps: int) -> bool:
    """Improve the forces by so many Newton steps at most; return 1 if settled."""
    width = 3 * ws.problem.n_active
    square = write_natural_map(ws)
    mean, weight = square, 1.0
    for _step in range(steps):
        if interrupted(ws, ws.problem.n_active * ws.problem.half_band):
            return False
        size = 0.0
        for i in range(width):
            size += ws.problem.forces[i] * ws.problem.forces[i]
        if square <= _SETTLED * _SETTLED * size:
            return True
        if not _write_jacobian(ws):
            return False
        for i in range(width):
            ws.problem.x[i] = -ws.problem.right[i]
        if not eliminate(ws.floats, ws.problem.matrix.start, width, ws.problem.half_band, ws.problem.x.start, SINGULAR):
            return False
        for i in range(width):
            ws.problem.forces_kept[i] = ws.problem.forces[i]
        share, better = 1.0, False
        for _halving in range(_HALVINGS):
            for i in range(width):
                ws.problem.forces[i] = ws.problem.forces_kept[i] + share * ws.problem.x[i]
            new = write_natural_map(ws)
            if new < (1.0 - 1e-4 * share) * mean:
                square, better = new, True
                break
            share *= 0.5
        if not better:
            for i in range(width):
                ws.problem.forces[i] = ws.problem.forces_kept[i]
            return False
        mean = (_MEMORY * weight * mean + square) / (_MEMORY * weight + 1.0)
        weight = _MEMORY * weight + 1.0
    return False
