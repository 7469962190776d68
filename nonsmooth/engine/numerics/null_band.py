"""Least-norm solution and null space of a singular banded system G x = r, at the cost of the band.

* Null space. H has the null space of G: H = G if G is symmetric, and H = G^T G otherwise, as when a contact slides. The
  matrix e (H + e)^-1 tends to the projector on the null space as e goes to zero. It is applied twice.
* Solution. The system with a small shift of its diagonal is regular. Its solution, without the part in the null space,
  is refined until the residual is round-off.

The orthogonal decompositions of :mod:`nonsmooth.engine.numerics.least_norm` would fill the matrix.
"""

from __future__ import annotations

import math

from nonsmooth.engine.memory.layout import MOST_ENTRIES, SINGULAR
from nonsmooth.engine.native.kernel import Floats, Workspace, kernel
from nonsmooth.engine.numerics.arrays import clear, copy_numbers, largest_size, subtract_part
from nonsmooth.engine.numerics.band_cholesky import factorise_band, invert_in_band, substitute_band
from nonsmooth.engine.numerics.linear import band_row, band_width, eliminate

_SHIFT = 1e-8
"""Shift of the diagonal of G, relative to its largest entry. It is larger than a pivot that counts as zero."""
_FAINT = 1e-12
"""Shift e of the diagonal of H, relative to its largest entry. It is smaller than any nonzero eigenvalue of H."""
_REMOVALS = 4
"""Passes that remove the null space. Each leaves a part of the size of round-off over the shift."""
_SYMMETRIC = 1e-12
"""Entries whose difference is below this, relative to the largest of the diagonal, are equal up to round-off."""
_SETTLED = 1e-15
"""Residual at which the refinement stops, relative to the right-hand side. It is round-off."""


@kernel("f8(F, i8, i8, i8)")
def largest_diagonal(floats: Floats, a: int, n: int, half: int) -> float:
    """Largest absolute entry on the diagonal of the band matrix of ``n`` rows at ``a``, the scale of its entries.

    Entries that are nan are passed over.
    """
    largest = 0.0
    for i in range(n):
        largest = max(largest, abs(floats[band_row(a, i, n, half) + i]))
    return largest


@kernel("void(F, i8, i8, i8, i8, f8)")
def copy_shifted(floats: Floats, a: int, n: int, half: int, out: int, shift: float) -> None:
    """Write the band matrix of ``n`` rows at ``a`` to ``out``, with ``shift`` added to its diagonal.

    Its half width is ``half``. A shift makes a singular matrix regular; a shift of 0 copies it.
    """
    copy_numbers(floats, a, n * band_width(n, half), out)
    for i in range(n):
        floats[band_row(out, i, n, half) + i] += shift


@kernel("b1(ws, i8)")
def solve_shifted(ws: Workspace, n: int) -> bool:
    """Replace the right-hand side in ``x`` by the solution of the system of ``reduced`` with a shifted diagonal.

    The shift, a small part of the largest entry of the diagonal, makes a singular matrix regular. ``matrix`` is a work
    array. False if the shifted matrix is singular, too: ``x`` is then undefined.
    """
    shift = _SHIFT * largest_diagonal(ws.floats, ws.problem.reduced.start, n, ws.problem.half_band)
    copy_shifted(ws.floats, ws.problem.reduced.start, n, ws.problem.half_band, ws.problem.matrix.start, shift)
    return eliminate(ws.floats, ws.problem.matrix.start, n, ws.problem.half_band, ws.problem.x.start, SINGULAR)


@kernel("void(ws, i8, i8)")
def project_on_null(ws: Workspace, n: int, v: int) -> None:
    """Replace the ``n`` numbers at ``v`` by their part in the null space of the matrix G of the unknown forces.

    H is a symmetric matrix with this null space, and e its shift ``null_shift``. ``null`` holds the Cholesky factor of
    H + e. A solve with it, times e, multiplies the part along an eigenvector of H of eigenvalue l by e / (l + e), which
    is 1 in the null space and next to zero elsewhere.
    """
    # the second solve makes the rest of the other parts the square of that small factor
    for _ in range(2):
        substitute_band(ws.floats, ws.problem.null.start, n, ws.problem.null_half_band, v)
        for i in range(n):
            ws.floats[v + i] *= ws.problem.null_shift


@kernel("void(ws, i8, i8)")
def _remove_null(ws: Workspace, n: int, v: int) -> None:
    """Subtract from the ``n`` numbers at ``v`` their part in the null space of the matrix of the unknown forces.

    So the norm becomes the least. Each pass leaves a small part, by round-off, so that several passes are made.
    ``matrix`` is a work array.
    """
    part = ws.problem.matrix.start
    for _ in range(_REMOVALS):
        copy_numbers(ws.floats, v, n, part)
        project_on_null(ws, n, part)
        subtract_part(ws.floats, v, 1.0, part, n)


@kernel("f8(ws, i8, i8, i8)")
def _write_residual(ws: Workspace, n: int, x: int, out: int) -> float:
    """Write the residual right - reduced . x of the ``n`` numbers at ``x`` to ``out``. Its largest absolute entry.

    ``right`` and ``reduced`` are the right-hand side and the band matrix of the unknown forces. Entries that are nan
    are written, but passed over by the result.
    """
    worst = 0.0
    for i in range(n):
        row = band_row(ws.problem.reduced.start, i, n, ws.problem.half_band)
        ws.floats[out + i] = ws.problem.right[i]
        for j in range(max(0, i - ws.problem.half_band), min(n, i + ws.problem.half_band + 1)):
            ws.floats[out + i] -= ws.floats[row + j] * ws.floats[x + j]
        worst = max(worst, abs(ws.floats[out + i]))
    return worst


@kernel("b1(ws, i8)")
def _is_symmetric(ws: Workspace, n: int) -> bool:
    """True if the matrix of the unknown forces, ``reduced`` of ``n`` rows, is symmetric up to round-off.

    Friction of sliding contacts makes it unsymmetric. A symmetric matrix need not be squared to find its null space.
    """
    small = _SYMMETRIC * largest_diagonal(ws.floats, ws.problem.reduced.start, n, ws.problem.half_band)
    for i in range(n):
        row = band_row(ws.problem.reduced.start, i, n, ws.problem.half_band)
        for j in range(max(0, i - ws.problem.half_band), i):
            # entry (j, i), to be compared with entry (i, j)
            mirrored = band_row(ws.problem.reduced.start, j, n, ws.problem.half_band) + i
            if abs(ws.floats[row + j] - ws.floats[mirrored]) > small:
                return False
    return True


@kernel("void(ws, i8)")
def _write_square(ws: Workspace, n: int) -> None:
    """Write H, a symmetric matrix with the null space of G, to ``basis``, and its half band to ``null_half_band``.

    G is the matrix of ``n`` rows in ``reduced``. H is G itself if G is symmetric, and G^T G otherwise.
    """
    half = ws.problem.half_band
    if _is_symmetric(ws, n):
        ws.problem.null_half_band = half
        copy_shifted(ws.floats, ws.problem.reduced.start, n, half, ws.problem.basis.start, shift=0.0)
        return
    # the product of two matrices of a band has a band twice as wide
    ws.problem.null_half_band = min(2 * half, n - 1)
    clear(ws.floats, ws.problem.basis.start, n * band_width(n, ws.problem.null_half_band))
    # G^T G is the sum, over the rows g of G, of the outer products g g^T
    for k in range(n):
        row = band_row(ws.problem.reduced.start, k, n, half)
        first, end = max(0, k - half), min(n, k + half + 1)
        for i in range(first, end):
            # row i of H gets g_i g^T
            out = band_row(ws.problem.basis.start, i, n, ws.problem.null_half_band)
            if ws.floats[row + i] != 0.0:
                for j in range(first, end):
                    ws.floats[out + j] += ws.floats[row + i] * ws.floats[row + j]


@kernel("void(ws, i8)")
def least_norm_in_band(ws: Workspace, n: int) -> None:
    """Solve the singular G x = r for least norm. ``reduced`` holds the band of G, and ``right`` the ``n`` numbers of r.

    H is a symmetric matrix with the null space of G, and e a small shift. Writes x to ``x``, H to ``basis``, the
    Cholesky factor of H + e to ``null``, and the band of the projector on the null space, e (H + e)^-1, to ``reduced``
    in place of G. These bands have the half width ``null_half_band``. If H may have too many entries for the memory,
    nothing is solved and the run stops.
    """
    # H has at most twice the half band of G
    if n * band_width(n, 2 * ws.problem.half_band) > MOST_ENTRIES:
        # the mark of too many pairs of contacts serves here, too: either of them ends the run with the same message
        ws.run.has_too_many_blocks = True
        return
    _write_square(ws, n)
    half, null = ws.problem.null_half_band, ws.problem.null.start
    largest = largest_diagonal(ws.floats, ws.problem.basis.start, n, half)
    # the shift must not be zero: a zero matrix gets one, too
    ws.problem.null_shift = _FAINT * (largest if largest > 0.0 else 1.0)
    copy_shifted(ws.floats, ws.problem.basis.start, n, half, null, ws.problem.null_shift)
    # each pivot of H + e is at least e, but round-off may make one smaller or even negative: a tenth of e then serves
    factorise_band(ws.floats, null, n, half, least=0.1 * ws.problem.null_shift)
    _refine_solution(ws, n)
    # G is not needed any more, so that its place gets (H + e)^-1
    invert_in_band(ws.floats, null, n, half, ws.problem.reduced.start)
    for i in range(n * band_width(n, half)):
        ws.problem.reduced[i] *= ws.problem.null_shift


@kernel("void(ws, i8)")
def _refine_solution(ws: Workspace, n: int) -> None:
    """Write the solution of least norm of G x = r, with ``n`` unknowns, to ``x``, by iterative refinement.

    The solution is the sum of corrections. Each solves the shifted system for the residual that is left, and loses its
    part in the null space, so that the norm is least. The sum ends when the residual is round-off, or when a correction
    does not halve it. A correction that enlarges the residual is undone. It also ends if the shifted matrix is
    singular. ``sigma`` and ``matrix`` are work arrays.
    """
    # x holds the last correction until the end
    x, total, residual = ws.problem.x.start, ws.problem.sigma.start, ws.problem.sigma.start + n
    clear(ws.floats, x, n)
    clear(ws.floats, total, n)
    size, before = largest_size(ws.floats, ws.problem.right.start, n), math.inf
    while True:
        left = _write_residual(ws, n, total, residual)
        if not left <= before:
            # the residual has grown: undo the last correction
            subtract_part(ws.floats, total, 1.0, x, n)
        # it is round-off, or not halved; infinite values, which cannot be halved, end the loop, too
        if not left > _SETTLED * size or not left < 0.5 * before:
            break
        before = left
        copy_numbers(ws.floats, residual, n, x)
        if not solve_shifted(ws, n):
            break
        _remove_null(ws, n, x)
        # minus -1: add the correction
        subtract_part(ws.floats, total, -1.0, x, n)
    copy_numbers(ws.floats, total, n, x)
