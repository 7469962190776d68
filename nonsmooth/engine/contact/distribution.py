"""Distribution of redundant forces: among all forces with the same motion, find some inside Coulomb's cones.

Let f be the forces of least norm and P the projector on the null space of the contact problem. All f + P z give the
same motion. The half squared distance to the cones,

    phi(f) = sum over the contacts of |f - (projection of f on the cone)|^2 / 2,

is convex and has a continuous slope. Newton's method minimises it along the null space, with a line search. Forces
exist if and only if the minimum is zero. Where all normal forces are given, a sum often shows at once that there are
none (:func:`is_out_of_reach`). To find forces at a distance inside the cones, the cones are moved along their
axes.

Linear programming would need polygons in place of the discs of friction. A projection method (alternating between cones
and null space) needs the same pieces, but converges linearly.

With a banded matrix a basis of the null space would fill the memory. The step then minimises phi over all forces, with
a large penalty on leaving the null space, and is projected on it.
"""

from __future__ import annotations

from nonsmooth.engine.contact.unknowns import force_of, set_force
from nonsmooth.engine.memory.layout import FIRST_ROW, NORMAL_ROW, SINGULAR
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, entry_point, kernel
from nonsmooth.engine.numerics.arrays import clear, copy_numbers, largest_size, subtract_part
from nonsmooth.engine.numerics.band_cholesky import factorise_band, substitute_band
from nonsmooth.engine.numerics.linear import band_row, eliminate, product
from nonsmooth.engine.numerics.null_band import copy_shifted, largest_diagonal, project_on_null
from nonsmooth.engine.numerics.vectors import length

_STEPS = 60
"""Maximum number of Newton steps. phi is quadratic in pieces, and each step passes from one piece to another."""
_HALVINGS = 30
"""Number of lengths of a Newton step that the line search tries, each half of the one before."""
_DECREASE = 1e-4
"""Decrease of phi that the line search requires, relative to the slope: Armijo's usual value."""
_SHIFT = 1e-6
"""Added to the Hessian, whose largest eigenvalue is 1, so that the shortest of many equal steps is made."""
_SHIFT_IN_BAND = 1e-3
"""The same in a band, relative to the weight of phi. It is larger because the penalty is limited by round-off."""
_WEIGHT = 1e-7
"""Weight of phi, relative to the penalty on leaving the null space."""


@entry_point("b1(ws, f8, f8)")
def distribute(ws: Workspace, inset: float, allowed: float) -> bool:
    """Move the forces along the null space into Coulomb's cones. True if none is outside by more than ``allowed`` [N].

    Before: the forces are those of least norm, and ``null`` holds the null space (forces that cause no motion). The
    cones of redundant forces are moved inwards by ``inset`` [N]. Newton's method minimises phi, the half squared
    distance. If False, the forces are the last ones, as close to the cones as the steps have come.
    """
    n = ws.problem.n_unknown
    phi = _write_excess(ws, n, inset)
    for _ in range(_STEPS):
        if largest_size(ws.floats, ws.problem.right.start, n) <= allowed:
            return True
        if ws.problem.is_null_space_banded:
            _write_step_in_band(ws, n, inset)
        elif not _find_step(ws, n, inset):
            return False
        slope = 0.0
        # slope of phi along the step: the gradient of phi is the excess over the cones, which `right` holds.
        # The forces before the step are stored in `sigma` for the line search
        for i in range(n):
            slope += ws.problem.right[i] * ws.problem.x[i]
            ws.problem.sigma[i] = force_of(ws, i)
        # a minimum of phi that is not zero: no forces with this motion are inside all cones
        if not slope < 0.0:
            return False
        phi = _search_along_step(ws, n, inset, phi, slope)
        # negative: no length of the step decreases phi
        if phi < 0.0:
            return False
    return False


@kernel("f8(ws, i8, f8, f8, f8)")
def _search_along_step(ws: Workspace, n: int, inset: float, phi: float, slope: float) -> float:
    """Make the longest step along ``x`` that decreases phi sufficiently. Returns the new phi [N^2], or -1 if none does.

    phi is the half squared distance of the forces to the cones. ``sigma`` holds the forces before the step, ``slope``
    the derivative of phi along it [N^2]. If no length does, the forces are those of the shortest one.
    """
    # 1 is Newton's step itself
    step_length = 1.0
    for _ in range(_HALVINGS):
        for i in range(n):
            set_force(ws, i, ws.problem.sigma[i] + step_length * ws.problem.x[i])
        new = _write_excess(ws, n, inset)
        if new <= phi + _DECREASE * step_length * slope:
            return new
        step_length *= 0.5
    return -1.0


@kernel("b1(ws, f8)")
def is_out_of_reach(ws: Workspace, allowed: float) -> bool:
    """True if no friction with this motion is within its bounds by ``allowed`` [N], where all normal forces are given.

    The forces f must be those of least norm, which are orthogonal to the null space. So all forces g with the same
    motion have f . g = |f|^2, while friction g_t within its bounds has f . g <= sum mu f_n |f_t|. It is False if a
    normal force is unknown, or if the null space is banded, where f is less exact. Then :func:`distribute` decides.
    """
    if ws.problem.is_null_space_banded:
        return False
    reach = 0.0
    for i in range(ws.problem.n_unknown):
        unknown = ws.unknowns[i]
        active = ws.actives[unknown.contact]
        if active.is_normal_force_unknown:
            return False
        if unknown.direction == FIRST_ROW:
            size = length(active.friction)
            # along t1 and along t2 friction may exceed its bound by ``allowed`` each
            reach += size * (active.static_coefficient * active.normal_force + 2.0 * allowed - size)
    return reach < 0.0


# --- the distance to the cones ----------------------------------------------------------------------------------------


@kernel("f8(ws, i8, f8)")
def _write_excess(ws: Workspace, n: int, inset: float) -> float:
    """Write the difference between the ``n`` forces and their projections on Coulomb's cones to ``right`` [N].

    Returns phi, half its square [N^2]. The cones of redundant forces are moved inwards by ``inset`` [N]; the disc of
    friction under a given normal force is not. The unknowns of a contact follow each other: i is its normal force,
    i + 1 and i + 2 are its friction.
    """
    square = 0.0
    for i in range(n):
        unknown = ws.unknowns[i]
        active = ws.actives[unknown.contact]
        # with a given normal force, the friction alone is unknown
        if unknown.direction == FIRST_ROW and not active.is_normal_force_unknown:
            square += _write_excess_over_disc(ws, active, i)
        # friction is written along with its normal force
        if unknown.direction != NORMAL_ROW:
            continue
        # component along the axis, from the apex of the cone; a boolean is 0 or 1
        normal = active.normal_force - inset * active.has_redundant_force
        # for a contact that slides, or whose force is projected on the apex: the tensile part
        ws.problem.right[i] = min(0.0, normal)
        if active.sticks:
            t1, t2 = active.friction
            mu, size = active.static_coefficient, length(active.friction)
            ws.problem.right[i + 1] = ws.problem.right[i + 2] = 0.0
            # projected on the apex, on the surface, or inside of the cone
            if mu * size <= -normal:
                ws.problem.right[i + 1], ws.problem.right[i + 2] = t1, t2
            elif size > mu * normal:
                # the distance to the surface is this excess times sqrt(1 + mu^2)
                excess = (size - mu * normal) / (1.0 + mu * mu)
                ws.problem.right[i] = -mu * excess
                ws.problem.right[i + 1], ws.problem.right[i + 2] = excess * t1 / size, excess * t2 / size
            else:
                ws.problem.right[i] = 0.0
            square += ws.problem.right[i + 1] ** 2 + ws.problem.right[i + 2] ** 2
        square += ws.problem.right[i] ** 2
    return 0.5 * square


@kernel("f8(ws, ActiveContact, i8)")
def _write_excess_over_disc(ws: Workspace, active: ActiveContact, i: int) -> float:
    """Write the excess of friction over Coulomb's disc, if the normal force is given. Returns its square [N^2].

    ``i`` is the unknown of the friction along t1, and i + 1 that along t2.
    """
    t1, t2 = active.friction
    bound, size = active.static_coefficient * active.normal_force, length(active.friction)
    excess = max(0.0, size - bound)
    ws.problem.right[i] = ws.problem.right[i + 1] = 0.0
    if excess > 0.0:
        ws.problem.right[i], ws.problem.right[i + 1] = excess * t1 / size, excess * t2 / size
    return float(excess * excess)


@kernel("void(ws, i8, i8, i8, f8, f8)")
def _add_hessian(ws: Workspace, n: int, matrix: int, half: int, weight: float, inset: float) -> None:
    """Add ``weight`` times the Hessian of phi to the band of ``n`` rows and half band ``half`` at ``matrix``.

    phi is the half squared distance of the forces to Coulomb's cones. Those of redundant forces are moved inwards by
    ``inset`` [N]. Contacts are not coupled: each adds to its own rows and columns only.
    """
    for i in range(n):
        unknown = ws.unknowns[i]
        active = ws.actives[unknown.contact]
        # with a given normal force, the friction alone is unknown
        if unknown.direction == FIRST_ROW and not active.is_normal_force_unknown:
            line_1, line_2 = band_row(matrix, i, n, half), band_row(matrix, i + 1, n, half)
            _add_hessian_of_disc(ws, active, i, line_1, line_2, weight)
        # rows of friction are written along with that of the normal force
        if unknown.direction != NORMAL_ROW:
            continue
        # component along the axis, from the apex of the cone; a boolean is 0 or 1
        normal = active.normal_force - inset * active.has_redundant_force
        # offsets of the entries of column i in the rows of n, t1 and t2
        row_n = band_row(matrix, i, n, half) + i
        if active.sticks:
            row_1, row_2 = band_row(matrix, i + 1, n, half) + i, band_row(matrix, i + 2, n, half) + i
            _add_hessian_of_cone(ws, active, normal, row_n, row_1, row_2, weight)
        else:
            # the distance of a sliding contact is that of a tensile force to zero
            ws.floats[row_n] += weight if normal < 0.0 else 0.0


@kernel("void(ws, ActiveContact, i8, i8, i8, f8)")
def _add_hessian_of_disc(ws: Workspace, active: ActiveContact, i: int, line_1: int, line_2: int, weight: float) -> None:
    """Add the Hessian of half the square that :func:`_write_excess_over_disc` returns to two rows of a matrix.

    ``i`` is the unknown of the friction along t1. The rows of i and i + 1 begin at ``line_1`` and ``line_2``. Friction
    inside the disc adds nothing.
    """
    t1, t2 = active.friction
    bound, size = active.static_coefficient * active.normal_force, length(active.friction)
    if size > bound:
        # curvature 1 along the friction; across it between 0, as for a line, and 1, as for a point
        c1, c2, curvature = t1 / size, t2 / size, 1.0 - bound / size
        ws.floats[line_1 + i] += weight * (c1 * c1 + curvature * c2 * c2)
        ws.floats[line_2 + i + 1] += weight * (c2 * c2 + curvature * c1 * c1)
        ws.floats[line_1 + i + 1] += weight * (1.0 - curvature) * c1 * c2
        ws.floats[line_2 + i] += weight * (1.0 - curvature) * c1 * c2


@kernel("void(ws, ActiveContact, f8, i8, i8, i8, f8)")
def _add_hessian_of_cone(
    ws: Workspace, active: ActiveContact, normal: float, row_n: int, row_1: int, row_2: int, weight: float
) -> None:
    """Add the Hessian of half the squared distance of a force to a cone, three rows by three columns.

    ``normal`` is its component along the axis [N]. The rows of n, t1 and t2 have their entries of column n at
    ``row_n``, ``row_1`` and ``row_2``. A force inside the cone adds nothing.
    """
    t1, t2 = active.friction
    mu, size = active.static_coefficient, length(active.friction)
    # projected on the apex, the distance is that to a point; on the surface, that to a cone
    if mu * size <= -normal:
        ws.floats[row_n] += weight
        ws.floats[row_1 + 1] += weight
        ws.floats[row_2 + 2] += weight
    elif size > mu * normal:
        # the gradient of the distance is (-mu, c) / sqrt(1 + mu^2), and the cone curves across the friction only;
        # 1 / s is the weight over 1 + mu^2
        s = (1.0 + mu * mu) / weight
        c1, c2 = t1 / size, t2 / size
        curvature = (size - mu * normal) / (s * size)
        ws.floats[row_n] += mu * mu / s
        ws.floats[row_n + 1] -= mu * c1 / s
        ws.floats[row_n + 2] -= mu * c2 / s
        ws.floats[row_1] -= mu * c1 / s
        ws.floats[row_2] -= mu * c2 / s
        ws.floats[row_1 + 1] += c1 * c1 / s + curvature * c2 * c2
        ws.floats[row_2 + 2] += c2 * c2 / s + curvature * c1 * c1
        ws.floats[row_1 + 2] += c1 * c2 / s - curvature * c1 * c2
        ws.floats[row_2 + 1] += c1 * c2 / s - curvature * c1 * c2


# --- the step ---------------------------------------------------------------------------------------------------------


@kernel("b1(ws, i8, f8)")
def _find_step(ws: Workspace, n: int, inset: float) -> bool:
    """Write Newton's step to ``x`` [N], by the basis of the null space. False if its system is singular.

    The step is a sum of the basis vectors, so it causes no motion. ``matrix`` gets the Hessian, ``reduced`` its
    projection on the basis, and ``sigma`` is overwritten.
    """
    # the last n_free rows of the basis span the null space
    n_free, basis = n - ws.problem.rank, ws.problem.basis.start + ws.problem.rank * n
    clear(ws.floats, ws.problem.matrix.start, n * n)
    # with half band n the matrix is stored in full
    _add_hessian(ws, n, ws.problem.matrix.start, half=n, weight=1.0, inset=inset)
    for k in range(n_free):
        vector = basis + k * n
        for i in range(n):
            # the Hessian couples the unknowns of a contact only
            active, total = ws.actives[ws.unknowns[i].contact], 0.0
            for j in range(active.first_unknown, active.end_unknown):
                total += ws.problem.matrix[i * n + j] * ws.floats[vector + j]
            # `sigma` becomes the Hessian times basis vector k
            ws.problem.sigma[i] = total
        for j in range(n_free):
            ws.problem.reduced[k * n_free + j] = product(ws.floats, 0.0, ws.problem.sigma.start, basis + j * n, n)
        # of many equal steps, the shortest
        ws.problem.reduced[k * n_free + k] += _SHIFT
        ws.problem.x[k] = -product(ws.floats, 0.0, vector, ws.problem.right.start, n)
    if not eliminate(ws.floats, ws.problem.reduced.start, n_free, n_free, ws.problem.x.start, SINGULAR):
        return False
    # `x` holds the factors of the basis vectors; `sigma` keeps them while `x` becomes their sum
    copy_numbers(ws.floats, ws.problem.x.start, n_free, ws.problem.sigma.start)
    clear(ws.floats, ws.problem.x.start, n)
    for k in range(n_free):
        # a negative part is added
        subtract_part(ws.floats, ws.problem.x.start, -ws.problem.sigma[k], basis + k * n, n)
    return True


@kernel("void(ws, i8, f8)")
def _write_step_in_band(ws: Workspace, n: int, inset: float) -> None:
    """Write Newton's step to ``x`` [N], with a penalty on leaving the null space, and project it on that space.

    ``basis`` holds H, whose null space it is: the penalty of a step s is s . H s / 2. The system is
    (H + weight (Hessian of phi + a small multiple of I)) s = -weight (gradient of phi).
    """
    half = ws.problem.null_half_band
    weight = _WEIGHT * largest_diagonal(ws.floats, ws.problem.basis.start, n, half)
    shift = weight * _SHIFT_IN_BAND
    copy_shifted(ws.floats, ws.problem.basis.start, n, half, ws.problem.matrix.start, shift)
    _add_hessian(ws, n, ws.problem.matrix.start, half, weight, inset)
    # round-off may make a pivot too small; each is at least a part of the shift
    factorise_band(ws.floats, ws.problem.matrix.start, n, half, 0.1 * weight * _SHIFT_IN_BAND)
    for i in range(n):
        ws.problem.x[i] = -weight * ws.problem.right[i]
    substitute_band(ws.floats, ws.problem.matrix.start, n, half, ws.problem.x.start)
    project_on_null(ws, n, ws.problem.x.start)
