"""Forces that hold the closed contacts in their modes during smooth motion.

Every closed contact contributes rows, what it holds, and columns, along what it pushes: a sticking one holds and
pushes along n, t1, t2; a sliding one holds n and pushes along n - mu d, friction included.  Rows times K
times columns is the reduced matrix whose unknowns are the forces; no more of G than that is needed.
"""

from __future__ import annotations

from nonsmooth.engine.band import open_band
from nonsmooth.engine.forces import friction_of_slip, solve_doubtful, solve_unknowns
from nonsmooth.engine.kernel import Floats, Integers, Scalars, kernel
from nonsmooth.engine.kinematics import evaluate_row, evaluate_row_response, row
from nonsmooth.engine.linear import band_row
from nonsmooth.engine.modes import SLIDE
from nonsmooth.engine.shares import add_share, choose_share


@kernel("void(S, F, I, i8)")
def lay_rows(S: Scalars, w: Floats, k: Integers, a: int) -> None:
    """Write rows and columns of the active contact ``a``: Jacobian rows 0 to 2, or 0 and that of the column, 1."""
    c = k[S.active + a]
    axes = S.axes + 9 * c
    if k[S.tangent_held + a] == 1:
        for r in range(3):
            evaluate_row(S, w, k, c, r, w[axes + 3 * r], w[axes + 3 * r + 1], w[axes + 3 * r + 2])
            evaluate_row_response(S, w, k, c, r, r)
        return
    m1, m2 = w[S.mu + a] * w[S.d + 2 * a], w[S.mu + a] * w[S.d + 2 * a + 1]
    evaluate_row(S, w, k, c, 0, w[axes], w[axes + 1], w[axes + 2])
    evaluate_row(
        S,
        w,
        k,
        c,
        1,
        w[axes] - m1 * w[axes + 3] - m2 * w[axes + 6],
        w[axes + 1] - m1 * w[axes + 4] - m2 * w[axes + 7],
        w[axes + 2] - m1 * w[axes + 5] - m2 * w[axes + 8],
    )
    evaluate_row_response(S, w, k, c, 1, 0)


@kernel("f8(S, F, I, i8, i8, i8, i8)")
def _coupling(S: Scalars, w: Floats, k: Integers, c: int, r: int, d: int, s: int) -> float:
    """Return what a unit force in column ``s`` of contact ``d`` does to row ``r`` of contact ``c``."""
    total = 0.0
    for side in range(2):
        linkage = k[S.linkage_a + c] if side == 0 else k[S.linkage_b + c]
        n_u = k[S.linkage_nu + linkage]
        jacobian = (k[S.jacobian_a + c] if side == 0 else k[S.jacobian_b + c]) + r * n_u
        if n_u > 0 and k[S.linkage_a + d] == linkage:
            for i in range(n_u):
                total += w[jacobian + i] * w[k[S.response_a + d] + s * n_u + i]
        if n_u > 0 and k[S.linkage_b + d] == linkage:
            for i in range(n_u):
                total += w[jacobian + i] * w[k[S.response_b + d] + s * n_u + i]
    return total


@kernel("i8(S, F, I)")
def _list_rows(S: Scalars, w: Floats, k: Integers) -> int:
    """List the rows of the active contacts; return how many there are."""
    n = 0
    for a in range(S.n_active):
        k[S.redundant + a] = 0
        k[S.first_unknown + a] = n
        for r in range(1 + 2 * k[S.tangent_held + a]):
            k[S.column + n] = 3 * a + r
            n += 1
    k[S.first_unknown + S.n_active] = n
    return n


@kernel("void(S, F, I, i8, i8, i8)")
def _reduce(S: Scalars, w: Floats, k: Integers, a: int, i: int, n: int) -> None:
    """Write row ``i`` of the reduced matrix, one of contact ``a``, and what it lacks to vanish without forces."""
    c, r = k[S.active + a], i - k[S.first_unknown + a]
    w[S.right + i] = -w[S.bias + 3 * c + r] - row(S, w, k, c, r, S.du)
    line = band_row(S.reduced, i, n, S.half_band)
    blocks = S.block_start + S.first_grouped + a
    for block in range(k[blocks], k[blocks + 1]):
        other = k[S.block_column + block]
        first = k[S.first_unknown + other]
        for s in range(k[S.first_unknown + other + 1] - first):
            w[line + first + s] = _coupling(S, w, k, c, r, k[S.active + other], s)
    # a sliding contact on which more force gives more approach
    if r == 0 and k[S.mode + c] == SLIDE and w[line + i] <= 0.0:
        S.singular = c


@kernel("void(S, F, I, i8, i8, i8)")
def _lay_held_row(S: Scalars, w: Floats, k: Integers, a: int, i: int, n: int) -> None:
    """Write row ``i`` of what the unknowns would do without friction to ``matrix``, response 1 of slips being that."""
    c, r = k[S.active + a], i - k[S.first_unknown + a]
    line = band_row(S.matrix, i, n, S.half_band)
    blocks = S.block_start + S.first_grouped + a
    for block in range(k[blocks], k[blocks + 1]):
        other = k[S.block_column + block]
        first, sticks = k[S.first_unknown + other], k[S.tangent_held + other]
        for s in range(1 + 2 * sticks):
            w[line + first + s] = _coupling(S, w, k, c, r, k[S.active + other], s + 1 - sticks)


@kernel("void(S, F, I)")
def hold_contacts(S: Scalars, w: Floats, k: Integers) -> None:
    """Write the forces ``f`` of the active contacts, add what they do to ``du``, note the driven bodies' power.

    Rows and columns must be laid, the free accelerations stand in ``du``.
    """
    n = _list_rows(S, w, k)
    if open_band(S, w, k, n, S.reduced) == 0:
        return
    for a in range(S.n_active):
        for i in range(k[S.first_unknown + a], k[S.first_unknown + a + 1]):
            _reduce(S, w, k, a, i, n)
    if solve_unknowns(S, w, k, n) == 0:
        for a in range(S.n_active):
            if k[S.tangent_held + a] == 0:
                evaluate_row_response(S, w, k, k[S.active + a], 0, 1)
        for a in range(S.n_active):
            for i in range(k[S.first_unknown + a], k[S.first_unknown + a + 1]):
                _lay_held_row(S, w, k, a, i, n)
        solve_doubtful(S, w, k, n)
    if S.deficient == 1:
        if S.choosing == 1 and choose_share(S, w, k) == 0:
            S.shares_hold = 0
        add_share(S, w, k)
    first = 0
    for a in range(S.n_active):
        c = k[S.active + a]
        sticks = k[S.tangent_held + a]
        for r in range(1 + 2 * sticks):
            force = w[S.x + first + r]
            w[S.f + 3 * a + r] = force
            _push(S, w, k, c, r, force, S.du)
            # the power of what the coordinates do not move: that of the force less that on them
            S.driven_power += force * row(S, w, k, c, r + 1 - sticks, S.own)
        if sticks == 0:
            friction_of_slip(S, w, a)
        first += 1 + 2 * sticks
        for r in range(3):
            S.driven_power -= w[S.f + 3 * a + r] * w[S.rate + 3 * c + r]


@kernel("void(S, F, I, i8, i8, f8, i8)")
def _push(S: Scalars, w: Floats, k: Integers, c: int, s: int, force: float, du: int) -> None:
    """Add the accelerations that a force in column ``s`` of contact ``c`` gives to ``du``."""
    for side in range(2):
        linkage = k[S.linkage_a + c] if side == 0 else k[S.linkage_b + c]
        response = k[S.response_a + c] if side == 0 else k[S.response_b + c]
        n_u = k[S.linkage_nu + linkage]
        for i in range(n_u):
            w[du + k[S.linkage_u + linkage] + i] += w[response + s * n_u + i] * force
