"""Forces that are not unique, distributed so that every contact keeps Coulomb's bound, the motion left as it is."""

from __future__ import annotations

from nonsmooth.engine.contact.unknowns import force_of, set_force
from nonsmooth.engine.native.kernel import (
    Workspace,
    entry_point,
    kernel,
)
from nonsmooth.engine.numerics.band_cholesky import factorise_band, substitute_band
from nonsmooth.engine.numerics.linear import SINGULAR, band_row, eliminate, product, subtract_part
from nonsmooth.engine.numerics.null_band import copy_shifted, largest_diagonal, project_on_null
from nonsmooth.engine.numerics.vectors import length

_STEPS = 60
"""Newton steps in the null space: each passes from one piece of a distance to the cones to another."""
_FLOOR = 1e-6
"""Added to the Hessian, whose largest eigenvalue is 1: the shortest move that does is made, not one of round-off."""
_FLOOR_IN_BAND = 1e-3
"""More where what leaves the null space has to stay far above it:"""
_CHEAP = 1e-7
"""the Hessian counts by this, relative to H."""


@kernel("f8(ws, i8, i8)")
def _disc_excess(ws: Workspace, i: int, a: int) -> float:
    """Write the friction of a contact with a given normal force less its projection on the disc; return its square."""
    active = ws.actives[a]
    t1, t2 = active.friction
    bound, size = active.static_coefficient * active.normal_force, length(active.friction)
    out = max(0.0, size - bound)
    ws.problem.right[i] = ws.problem.right[i + 1] = 0.0
    if out > 0.0:
        ws.problem.right[i], ws.problem.right[i + 1] = out * t1 / size, out * t2 / size
    return float(out * out)


@kernel("void(ws, i8, i8, i8, i8, f8)")
def _add_disc_curve(ws: Workspace, i: int, a: int, line1: int, line2: int, factor: float) -> None:
    """Add the Hessian of the half square of what :func:`_disc_excess` writes."""
    active = ws.actives[a]
    t1, t2 = active.friction
    bound, size = active.static_coefficient * active.normal_force, length(active.friction)
    if size > bound:
        c1, c2, round_ = t1 / size, t2 / size, 1.0 - bound / size
        ws.floats[line1 + i] += factor * (c1 * c1 + round_ * c2 * c2)
        ws.floats[line2 + i + 1] += factor * (c2 * c2 + round_ * c1 * c1)
        ws.floats[line1 + i + 1] += factor * (1.0 - round_) * c1 * c2
        ws.floats[line2 + i] += factor * (1.0 - round_) * c1 * c2


@kernel("f8(ws, i8, f8)")
def _excess(ws: Workspace, n: int, inset: float) -> float:
    """Write f less its projection on the cones to ``right``; return half its square."""
    square = 0.0
    for i in range(n):
        unknown = ws.unknowns[i]
        a = unknown.contact
        active = ws.actives[a]
        if unknown.direction == 1 and not active.is_normal_force_unknown:
            square += _disc_excess(ws, i, a)
        if unknown.direction != 0:
            continue
        normal = active.normal_force - inset * active.has_redundant_force
        ws.problem.right[i] = min(0.0, normal)
        if active.sticks:
            t1, t2 = active.friction
            mu, size = active.static_coefficient, length(active.friction)
            ws.problem.right[i + 1] = ws.problem.right[i + 2] = 0.0
            if mu * size <= -normal:
                ws.problem.right[i + 1], ws.problem.right[i + 2] = t1, t2
            elif size > mu * normal:
                out = (size - mu * normal) / (1.0 + mu * mu)
                ws.problem.right[i] = -mu * out
                ws.problem.right[i + 1], ws.problem.right[i + 2] = out * t1 / size, out * t2 / size
            else:
                ws.problem.right[i] = 0.0
            square += ws.problem.right[i + 1] ** 2 + ws.problem.right[i + 2] ** 2
        square += ws.problem.right[i] ** 2
    return 0.5 * square


@kernel("void(ws, i8, i8, i8, f8, f8)")
def _add_curve(ws: Workspace, n: int, matrix: int, half: int, factor: float, inset: float) -> None:
    """Add the Hessian of the half square, block by block and times a factor, to the band at ``matrix``."""
    for i in range(n):
        unknown = ws.unknowns[i]
        a = unknown.contact
        active = ws.actives[a]
        if unknown.direction == 1 and not active.is_normal_force_unknown:
            _add_disc_curve(ws, i, a, band_row(matrix, i, n, half), band_row(matrix, i + 1, n, half), factor)
        if unknown.direction != 0:
            continue
        normal, h = active.normal_force - inset * active.has_redundant_force, band_row(matrix, i, n, half) + i
        if not active.sticks:
            ws.floats[h] += factor if normal < 0.0 else 0.0
            continue
        h1, h2 = band_row(matrix, i + 1, n, half) + i, band_row(matrix, i + 2, n, half) + i
        t1, t2 = active.friction
        mu, size = active.static_coefficient, length(active.friction)
        if mu * size <= -normal:
            ws.floats[h] += factor
            ws.floats[h1 + 1] += factor
            ws.floats[h2 + 2] += factor
        elif size > mu * normal:
            s = (1.0 + mu * mu) / factor
            c1, c2 = t1 / size, t2 / size
            round_ = (size - mu * normal) / (s * size)
            ws.floats[h] += mu * mu / s
            ws.floats[h + 1] -= mu * c1 / s
            ws.floats[h + 2] -= mu * c2 / s
            ws.floats[h1] -= mu * c1 / s
            ws.floats[h2] -= mu * c2 / s
            ws.floats[h1 + 1] += c1 * c1 / s + round_ * c2 * c2
            ws.floats[h2 + 2] += c2 * c2 / s + round_ * c1 * c1
            ws.floats[h1 + 2] += c1 * c2 / s - round_ * c1 * c2
            ws.floats[h2 + 1] += c1 * c2 / s - round_ * c1 * c2


@kernel("b1(ws, i8, f8)")
def _step(ws: Workspace, n: int, inset: float) -> bool:
    """Write Newton's step along the basis of the null space to ``x``; return 0 if there is none."""
    free, basis = n - ws.problem.rank, ws.problem.basis.start + ws.problem.rank * n
    for i in range(n * n):
        ws.problem.matrix[i] = 0.0
    _add_curve(ws, n, ws.problem.matrix.start, n, 1.0, inset)
    for c in range(free):
        row = basis + c * n
        for i in range(n):
            active, total = ws.actives[ws.unknowns[i].contact], 0.0
            for j in range(active.first_unknown, active.end_unknown):
                total += ws.problem.matrix[i * n + j] * ws.floats[row + j]
            ws.problem.sigma[i] = total
        for d in range(free):
            ws.problem.reduced[c * free + d] = product(ws.floats, 0.0, ws.problem.sigma.start, basis + d * n, n)
        ws.problem.reduced[c * free + c] += _FLOOR
        ws.problem.x[c] = -product(ws.floats, 0.0, row, ws.problem.right.start, n)
    if not eliminate(ws.floats, ws.problem.reduced.start, free, free, ws.problem.x.start, SINGULAR):
        return False
    for c in range(free):
        ws.problem.sigma[c] = ws.problem.x[c]
    for i in range(n):
        ws.problem.x[i] = 0.0
    for c in range(free):
        subtract_part(ws.floats, ws.problem.x.start, -ws.problem.sigma[c], basis + c * n, n)
    return True


@kernel("b1(ws, i8, f8)")
def _step_in_band(ws: Workspace, n: int, inset: float) -> bool:
    """Write Newton's step to ``x``: what leaves the null space, by H in ``basis``, is made dear, and cut off then."""
    weight = _CHEAP * largest_diagonal(ws.floats, ws.problem.basis.start, n, ws.problem.null_half_band)
    copy_shifted(
        ws.floats,
        ws.problem.basis.start,
        n,
        ws.problem.null_half_band,
        ws.problem.matrix.start,
        weight * _FLOOR_IN_BAND,
    )
    _add_curve(ws, n, ws.problem.matrix.start, ws.problem.null_half_band, weight, inset)
    factorise_band(ws.floats, ws.problem.matrix.start, n, ws.problem.null_half_band, 0.1 * weight * _FLOOR_IN_BAND)
    for i in range(n):
        ws.problem.x[i] = -weight * ws.problem.right[i]
    substitute_band(ws.floats, ws.problem.matrix.start, n, ws.problem.null_half_band, ws.problem.x.start)
    project_on_null(ws, n, ws.problem.x.start)
    return True


@entry_point("b1(ws, f8, f8)")
def distribute(ws: Workspace, inset: float, arrived: float) -> bool:
    """Move the forces along the null space into the cones; return 1 if they arrive.

    ``active_forces`` is the answer of least norm, ``null`` tells what may be added to it.  The half square of the
    distance to the cones, moved up by ``inset`` [N] where forces are not unique, is convex along the null space, and
    its smallest value is sought by Newton's method until no force is out by more than ``arrived`` [N].
    """
    n = ws.problem.n_unknown
    square = _excess(ws, n, inset)
    for _round in range(_STEPS):
        worst = 0.0
        for i in range(n):
            worst = max(worst, abs(ws.problem.right[i]))
        if worst <= arrived:
            return True
        if not (_step_in_band(ws, n, inset) if ws.problem.is_null_space_banded else _step(ws, n, inset)):
            return False
        slope = 0.0
        for i in range(n):
            slope += ws.problem.right[i] * ws.problem.x[i]
            ws.problem.sigma[i] = force_of(ws, i)
        # where the distance has its smallest value, and it is not zero, there are no such forces
        if not slope < 0.0:
            return False
        share, moved = 1.0, False
        for _halving in range(30):
            for i in range(n):
                set_force(ws, i, ws.problem.sigma[i] + share * ws.problem.x[i])
            new = _excess(ws, n, inset)
            if new <= square + 1e-4 * share * slope:
                square, moved = new, True
                break
            share *= 0.5
        if not moved:
            return False
    return False
