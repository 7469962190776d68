"""Forces of the active contacts when it is known what each of them does.

One linear problem serves sustained contact and impact.  For every active contact the normal force is
either unknown (``normal_held``: its normal row of G f + b must vanish) or given in ``f``; the
tangential force is either unknown (``tangent_held``: sticking) or follows the slip, -mu f_N d.
"""

from __future__ import annotations

import math

from nonsmooth.engine.kernel import Floats, Integers, Scalars, kernel, room
from nonsmooth.engine.linear import eliminate, minimum_norm

_COUPLED = 1e-7
"""Null-space entries above this tie a contact to the group whose forces are not unique."""


@room()
def resolve(S: Scalars, w: Floats, k: Integers) -> None:
    """Complete ``f``; where the forces are not unique, take those of least norm and mark the contacts."""
    n = _collect(S, w, k)
    width = 3 * S.n_active
    for i in range(n):
        line = k[S.column + i]
        total = w[S.b + line]
        for j in range(width):
            total += w[S.delassus + line * width + j] * w[S.f + j]
        w[S.right + i] = -total
        for j in range(n):
            w[S.reduced + i * n + j] = _entry(S, w, k, line, k[S.column + j])
    solve_unknowns(S, w, k, n)
    for i in range(n):
        w[S.f + k[S.column + i]] = w[S.x + i]
    for a in range(S.n_active):
        if k[S.normal_held + a] == 1 and k[S.tangent_held + a] == 0:
            friction_of_slip(S, w, a)


@kernel("void(S, F, I, i8)")
def solve_unknowns(S: Scalars, w: Floats, k: Integers, n: int) -> None:
    """Solve the reduced system ``reduced . x = right`` of the unknowns in ``column``, for least norm if singular."""
    S.n_unknown = n
    S.deficient = 0
    if n == 1 and w[S.reduced] != 0.0:
        w[S.x] = w[S.right] / w[S.reduced]
        return
    for i in range(n):
        w[S.x + i] = w[S.right + i]
    for i in range(n * n):
        w[S.matrix + i] = w[S.reduced + i]
    if n > 0 and eliminate(w, S.matrix, n, S.x) == 0:
        _least_norm(S, w, k, n)


@kernel("i8(S, F, I)")
def _collect(S: Scalars, w: Floats, k: Integers) -> int:
    """List the unknown components and write the given ones; return how many are unknown."""
    n = 0
    for a in range(S.n_active):
        k[S.redundant + a] = 0
        if k[S.normal_held + a] == 1:
            k[S.column + n] = 3 * a
            n += 1
            w[S.f + 3 * a] = 0.0
        w[S.f + 3 * a + 1] = 0.0
        w[S.f + 3 * a + 2] = 0.0
        if k[S.tangent_held + a] == 1:
            k[S.column + n] = 3 * a + 1
            k[S.column + n + 1] = 3 * a + 2
            n += 2
        else:
            friction_of_slip(S, w, a)
    return n


@kernel("void(S, F, i8)")
def friction_of_slip(S: Scalars, w: Floats, a: int) -> None:
    """Write the friction of the sliding active contact ``a``, -mu f_N d."""
    w[S.f + 3 * a + 1] = -w[S.mu + a] * w[S.f + 3 * a] * w[S.d + 2 * a]
    w[S.f + 3 * a + 2] = -w[S.mu + a] * w[S.f + 3 * a] * w[S.d + 2 * a + 1]


@kernel("f8(S, F, i8)")
def reduced_coefficient(S: Scalars, w: Floats, a: int) -> float:
    """Return the gap acceleration per normal force of the sliding active contact ``a``, its friction included."""
    g = S.delassus + 3 * a * 3 * S.n_active + 3 * a
    return float(w[g] - w[S.mu + a] * (w[S.d + 2 * a] * w[g + 1] + w[S.d + 2 * a + 1] * w[g + 2]))


@kernel("f8(S, F, I, i8, i8)")
def _entry(S: Scalars, w: Floats, k: Integers, line: int, column: int) -> float:
    """Return the effect on row ``line`` of a unit unknown, friction of a sliding contact included."""
    g = S.delassus + line * 3 * S.n_active + column
    a = column // 3
    if column != 3 * a or k[S.tangent_held + a] == 1:
        return w[g]
    return w[g] - w[S.mu + a] * (w[S.d + 2 * a] * w[g + 1] + w[S.d + 2 * a + 1] * w[g + 2])


@kernel("void(S, F, I, i8)")
def _least_norm(S: Scalars, w: Floats, k: Integers, n: int) -> None:
    """Solve the singular system for least norm; keep the projector on its null space."""
    for i in range(n * n):
        w[S.matrix + i] = w[S.reduced + i]
    rank = minimum_norm(w, S.matrix, n, S.right, S.x, S.basis, S.sigma)
    S.deficient = 1
    for i in range(n):
        for j in range(n):
            total = 1.0 if i == j else 0.0
            for c in range(rank):
                total -= w[S.basis + c * n + i] * w[S.basis + c * n + j]
            w[S.null + i * n + j] = total
    for i in range(n):
        a = k[S.column + i] // 3
        if w[S.null + i * n + i] > _COUPLED:
            k[S.redundant + a] = 1


@kernel()
def evaluate_margins(S: Scalars, w: Floats, k: Integers) -> None:
    """Write, for every sticking active contact, how far its friction is from the static bound [N].

    A contact whose tangential force is not unique obeys two bounds: the sum rule of its group, Eq. (38),
    and the plain bound for the part of its force that is unique.
    """
    for a in range(S.n_active):
        if k[S.tangent_held + a] == 0:
            w[S.margin + a] = 0.0
            continue
        t1, t2 = w[S.f + 3 * a + 1], w[S.f + 3 * a + 2]
        if k[S.redundant + a] == 1:
            _group_margin(S, w, k, a)
        else:
            w[S.margin + a] = w[S.mu_static + a] * w[S.f + 3 * a] - math.sqrt(t1 * t1 + t2 * t2)


@kernel("void(S, F, I, i8)")
def _group_margin(S: Scalars, w: Floats, k: Integers, a: int) -> None:
    n = S.n_unknown
    own = 0
    for i in range(n):
        if k[S.column + i] == 3 * a + 1:
            own = i
    bound = sum1 = sum2 = 0.0
    for i in range(n - 1):
        other = k[S.column + i] // 3
        if k[S.column + i] != 3 * other + 1 or k[S.redundant + other] == 0:
            continue
        coupling = (
            abs(w[S.null + own * n + i])
            + abs(w[S.null + own * n + i + 1])
            + abs(w[S.null + (own + 1) * n + i])
            + abs(w[S.null + (own + 1) * n + i + 1])
        )
        if coupling > _COUPLED or other == a:
            bound += w[S.mu_static + other] * w[S.f + 3 * other]
            sum1 += w[S.f + 3 * other + 1]
            sum2 += w[S.f + 3 * other + 2]
    group = bound - math.sqrt(sum1 * sum1 + sum2 * sum2)
    # the part of the force orthogonal to this contact's share of the null space
    p11, p12 = w[S.null + own * n + own], w[S.null + own * n + own + 1]
    p22 = w[S.null + (own + 1) * n + own + 1]
    t1, t2 = w[S.f + 3 * a + 1], w[S.f + 3 * a + 2]
    unique = 0.0
    if p11 * p22 - p12 * p12 < _COUPLED * (p11 + p22) * (p11 + p22):
        if p11 >= p22:
            e1, e2 = p11, p12
        else:
            e1, e2 = p12, p22
        unique = abs(e1 * t2 - e2 * t1) / math.sqrt(e1 * e1 + e2 * e2)
    w[S.margin + a] = min(group, w[S.mu_static + a] * w[S.f + 3 * a] - unique)
