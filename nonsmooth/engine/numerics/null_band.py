"""Least norm and null space of a singular banded system, at the cost of the band.

The null space of G is that of H, which is G itself where it is symmetric, and G^T G where something slides; and
e (H + e)^-1 tends to the projector on it as e goes to zero.  It is applied twice.  A solution comes from the system
with a little added to its diagonal, less its part in the null space, and is refined until nothing remains.
"""

from __future__ import annotations

from nonsmooth.engine.memory.layout import MOST_ENTRIES
from nonsmooth.engine.native.kernel import Floats, Scalars, kernel
from nonsmooth.engine.numerics.band_cholesky import factorise_band, invert_in_band, substitute_band
from nonsmooth.engine.numerics.linear import SINGULAR, band_row, band_width, eliminate

_SHIFT = 1e-8
"""Added to the diagonal of the system, relative to its largest entry: clearly more than counts as zero there."""
_FAINT = 1e-12
"""Added to that of H, relative to its largest entry: clearly less than any force that moves something has."""
_REMOVALS = 4
"""The projector is known to a part of rounding over what was added, and takes off all but that part each time."""
_SYMMETRIC = 1e-12
"""Entries that differ by no more than this part of the largest of the diagonal are the same but for round-off."""
_SETTLED = 1e-15
"""A residual of this part of the right-hand side is round-off."""


@kernel("f8(F, i8, i8, i8)")
def largest_diagonal(w: Floats, a: int, n: int, half: int) -> float:
    """Return the largest entry of the diagonal."""
    largest = 0.0
    for i in range(n):
        largest = max(largest, abs(w[band_row(a, i, n, half) + i]))
    return largest


@kernel("void(F, i8, i8, i8, i8, f8)")
def copy_shifted(w: Floats, a: int, n: int, half: int, out: int, shift: float) -> None:
    """Write the band at ``a`` to ``out``, ``shift`` added to its diagonal."""
    for i in range(n * band_width(n, half)):
        w[out + i] = w[a + i]
    for i in range(n):
        w[band_row(out, i, n, half) + i] += shift


@kernel("i8(S, F, i8)")
def solve_shifted(S: Scalars, w: Floats, n: int) -> int:
    """Solve ``reduced . x = x`` in place, a little added to the diagonal; return 0 if singular all the same."""
    shift = _SHIFT * largest_diagonal(w, S.reduced, n, S.half_band)
    copy_shifted(w, S.reduced, n, S.half_band, S.matrix, shift)
    return eliminate(w, S.matrix, n, S.half_band, S.x, SINGULAR)


@kernel("void(S, F, i8, i8)")
def project_on_null(S: Scalars, w: Floats, n: int, v: int) -> None:
    """Replace the vector at ``v`` by its part in the null space."""
    for _time in range(2):
        substitute_band(w, S.null, n, S.null_half, v)
        for i in range(n):
            w[v + i] *= S.null_shift


@kernel("void(S, F, i8, i8)")
def _remove_null(S: Scalars, w: Floats, n: int, v: int) -> None:
    """Take its part in the null space off the vector at ``v``; ``matrix`` is overwritten."""
    for _time in range(_REMOVALS):
        for i in range(n):
            w[S.matrix + i] = w[v + i]
        project_on_null(S, w, n, S.matrix)
        for i in range(n):
            w[v + i] -= w[S.matrix + i]


@kernel("f8(S, F, i8, i8, i8)")
def _write_residual(S: Scalars, w: Floats, n: int, x: int, out: int) -> float:
    """Write what ``x`` leaves of ``right`` to ``out``; return the largest of it."""
    worst = 0.0
    for i in range(n):
        line = band_row(S.reduced, i, n, S.half_band)
        w[out + i] = w[S.right + i]
        for j in range(max(0, i - S.half_band), min(n, i + S.half_band + 1)):
            w[out + i] -= w[line + j] * w[x + j]
        worst = max(worst, abs(w[out + i]))
    return worst


@kernel("i8(S, F, i8)")
def _is_symmetric(S: Scalars, w: Floats, n: int) -> int:
    small = _SYMMETRIC * largest_diagonal(w, S.reduced, n, S.half_band)
    for i in range(n):
        line = band_row(S.reduced, i, n, S.half_band)
        for j in range(max(0, i - S.half_band), i):
            if abs(w[line + j] - w[band_row(S.reduced, j, n, S.half_band) + i]) > small:
                return 0
    return 1


@kernel("void(S, F, i8)")
def _write_square(S: Scalars, w: Floats, n: int) -> None:
    """Write H, of half band ``null_half``, to ``basis``."""
    half = S.half_band
    if _is_symmetric(S, w, n) == 1:
        S.null_half = half
        copy_shifted(w, S.reduced, n, half, S.basis, 0.0)
        return
    S.null_half = min(2 * half, n - 1)
    for i in range(n * band_width(n, S.null_half)):
        w[S.basis + i] = 0.0
    for line in range(n):
        row = band_row(S.reduced, line, n, half)
        first, end = max(0, line - half), min(n, line + half + 1)
        for i in range(first, end):
            out = band_row(S.basis, i, n, S.null_half)
            if w[row + i] != 0.0:
                for j in range(first, end):
                    w[out + j] += w[row + i] * w[row + j]


@kernel("void(S, F, i8)")
def least_norm_in_band(S: Scalars, w: Floats, n: int) -> None:
    """Solve ``reduced . x = right`` for least norm.

    Leaves H in ``basis``, its factor in ``null``, and the band of the projector on the null space in ``reduced``.
    """
    if n * band_width(n, 2 * S.half_band) > MOST_ENTRIES:
        S.crowded = 1
        return
    _write_square(S, w, n)
    largest = largest_diagonal(w, S.basis, n, S.null_half)
    S.null_shift = _FAINT * (largest if largest > 0.0 else 1.0)
    copy_shifted(w, S.basis, n, S.null_half, S.null, S.null_shift)
    factorise_band(w, S.null, n, S.null_half, 0.1 * S.null_shift)
    # the answer so far grows in sigma, the correction in x
    total, size, before = S.sigma, 0.0, 1e300
    for i in range(n):
        w[total + i] = w[S.x + i] = 0.0
        size = max(size, abs(w[S.right + i]))
    while True:
        left = _write_residual(S, w, n, total, S.sigma + n)
        if not left <= before:
            for i in range(n):
                w[total + i] -= w[S.x + i]
        if not left > _SETTLED * size or not left < 0.5 * before:
            break
        before = left
        for i in range(n):
            w[S.x + i] = w[S.sigma + n + i]
        if solve_shifted(S, w, n) == 0:
            break
        _remove_null(S, w, n, S.x)
        for i in range(n):
            w[total + i] += w[S.x + i]
    for i in range(n):
        w[S.x + i] = w[total + i]
    invert_in_band(w, S.null, n, S.null_half, S.reduced)
    for i in range(n * band_width(n, S.null_half)):
        w[S.reduced + i] *= S.null_shift
