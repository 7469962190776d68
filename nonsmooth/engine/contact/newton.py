"""Semismooth Newton on the cones: the natural map of Alart and Curnier (1991), with a line search.

The equations of a contact at rest, y = f - rho a being where its force would go:

    f_N - max(0, y_N) = 0,    f_T - (projection of y_T on the disc of radius mu max(0, y_N)) = 0

They hold iff Eqs. (16) and (17) do.  Sweeps of Gauss-Seidel bring the start near.
"""

from __future__ import annotations

import math

from nonsmooth.engine.contact.forces import DEAR
from nonsmooth.engine.contact.gauss_seidel import sweep
from nonsmooth.engine.contact.trial import slope_of_slip
from nonsmooth.engine.delassus.delassus import add_product, own_block
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, kernel, room
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.band import open_band
from nonsmooth.engine.numerics.linear import SINGULAR, band_row, eliminate

STAGES = 4
_SWEEPS = 10
_STEPS = 30
_HALVINGS = 8
_FLOOR = 1e-8
"""Added to the diagonal, whose entries are near 1: forces that are not unique must not stop the elimination."""
_SETTLED = 1e-11


@kernel("f8(S, F, I)")
def _residual(S: Scalars, w: Floats, k: Integers) -> float:
    """Write the natural map to ``right``; return its square."""
    square = 0.0
    for a in range(S.n_active):
        line = 3 * a
        for r in range(3):
            w[S.acceleration + line + r] = add_product(S, w, k, w[S.b + line + r], a, r, S.f)
        y = w[S.f + line] - w[S.acceleration + line] / w[own_block(S, k, a)]
        w[S.right + line] = w[S.f + line] - max(0.0, y)
        radius = w[S.mu + a] * max(0.0, y)
        t1, t2 = w[S.f + line + 1], w[S.f + line + 2]
        if k[S.at_rest + a] == 0:
            pull = w[S.mu + a] * w[S.f + line]
            w[S.right + line + 1] = t1 + pull * w[S.d + 2 * a]
            w[S.right + line + 2] = t2 + pull * w[S.d + 2 * a + 1]
        else:
            g = slope_of_slip(S, w, k, a)
            y1 = t1 - w[S.acceleration + line + 1] / g
            y2 = t2 - w[S.acceleration + line + 2] / g
            length = math.sqrt(y1 * y1 + y2 * y2)
            cut = radius / length if length > radius else 1.0
            w[S.right + line + 1], w[S.right + line + 2] = t1 - cut * y1, t2 - cut * y2
        for r in range(3):
            square += w[S.right + line + r] ** 2
    return square


@kernel("void(S, F, I, i8, i8, f8)")
def _add_row(S: Scalars, w: Floats, k: Integers, a: int, r: int, slope: float) -> None:
    """Add a row of G, that is of contact ``a``, over a slope to the same row of ``matrix``."""
    row = S.block_start + S.first_grouped + a
    line = band_row(S.matrix, 3 * a + r, 3 * S.n_active, S.half_band)
    for block in range(k[row], k[row + 1]):
        for s in range(3):
            w[line + 3 * k[S.block_column + block] + s] += w[S.delassus + 9 * block + 3 * r + s] / slope


@kernel("void(S, F, I, i8, f8, f8, f8)")
def _add_cut(S: Scalars, w: Floats, k: Integers, a: int, cut: float, c1: float, c2: float) -> None:
    """Add the derivative of the friction that is cut to the disc, along (c1, c2), to its two rows of ``matrix``."""
    own, slope = w[own_block(S, k, a)], slope_of_slip(S, w, k, a)
    n = 3 * S.n_active
    first, second = band_row(S.matrix, 3 * a + 1, n, S.half_band), band_row(S.matrix, 3 * a + 2, n, S.half_band)
    row = S.block_start + S.first_grouped + a
    for block in range(k[row], k[row + 1]):
        for s in range(3):
            g, j = S.delassus + 9 * block + s, 3 * k[S.block_column + block] + s
            z1, z2 = -w[g + 3] / slope, -w[g + 6] / slope
            z1 += 1.0 if j == 3 * a + 1 else 0.0
            z2 += 1.0 if j == 3 * a + 2 else 0.0
            across = c2 * z1 - c1 * z2
            grown = w[S.mu + a] * ((1.0 if j == 3 * a else 0.0) - w[g] / own)
            w[first + j] -= cut * c2 * across + c1 * grown
            w[second + j] += cut * c1 * across - c2 * grown


@kernel("i8(S, F, I)")
def _lay_jacobian(S: Scalars, w: Floats, k: Integers) -> int:
    """Write the derivative of the natural map at ``f`` and its accelerations to ``matrix``; return 0 if no room."""
    n = 3 * S.n_active
    for a in range(S.n_active + 1):
        k[S.first_unknown + a] = 3 * a
    if open_band(S, w, k, n, S.matrix) == 0:
        return 0
    for a in range(S.n_active):
        line = 3 * a
        own = w[own_block(S, k, a)]
        y = w[S.f + line] - w[S.acceleration + line] / own
        row = band_row(S.matrix, line, n, S.half_band)
        if y > 0.0:
            _add_row(S, w, k, a, 0, own)
            w[row + line] += _FLOOR
        else:
            w[row + line] = 1.0
        for r in range(1, 3):
            row = band_row(S.matrix, line + r, n, S.half_band)
            w[row + line + r] = 1.0
            if k[S.at_rest + a] == 0:
                w[row + line] = w[S.mu + a] * w[S.d + 2 * a + r - 1]
        if k[S.at_rest + a] == 0:
            continue
        slope = slope_of_slip(S, w, k, a)
        y1 = w[S.f + line + 1] - w[S.acceleration + line + 1] / slope
        y2 = w[S.f + line + 2] - w[S.acceleration + line + 2] / slope
        length, radius = math.sqrt(y1 * y1 + y2 * y2), w[S.mu + a] * max(0.0, y)
        if length <= radius:
            for r in range(1, 3):
                row = band_row(S.matrix, line + r, n, S.half_band)
                w[row + line + r] = 0.0
                _add_row(S, w, k, a, r, slope)
                w[row + line + r] += _FLOOR
        elif radius > 0.0:
            _add_cut(S, w, k, a, radius / length, y1 / length, y2 / length)
    return 1


@room("i8(S, F, I, i8)")
def search_by_newton(S: Scalars, w: Floats, k: Integers, stage: int) -> int:
    """Improve the forces by sweeps, ten times more of them in every stage, and Newton steps; return 1 if settled."""
    sweeps = _SWEEPS
    for _stage in range(stage):
        sweeps *= 10
    width = 3 * S.n_active
    sweep(S, w, k, sweeps)
    square = _residual(S, w, k)
    for _step in range(_STEPS):
        if interrupted(S, width + width * S.half_band * S.half_band // DEAR) == 1:
            return 0
        size = 0.0
        for i in range(width):
            size += w[S.f + i] ** 2
        if square <= _SETTLED * _SETTLED * size:
            return 1
        if _lay_jacobian(S, w, k) == 0:
            return 0
        for i in range(width):
            w[S.x + i] = -w[S.right + i]
        if eliminate(w, S.matrix, width, S.half_band, S.x, SINGULAR) == 0:
            return 0
        for i in range(width):
            w[S.f_kept + i] = w[S.f + i]
        share, better = 1.0, 0
        for _halving in range(_HALVINGS):
            for i in range(width):
                w[S.f + i] = w[S.f_kept + i] + share * w[S.x + i]
            new = _residual(S, w, k)
            if new < (1.0 - 1e-4 * share) * square:
                square, better = new, 1
                break
            share *= 0.5
        if better == 0:
            for i in range(width):
                w[S.f + i] = w[S.f_kept + i]
            return 0
    return 0
