"""Who sticks, who slides, who lifts off: block Gauss-Seidel on Coulomb's cone, Eqs. (16) and (17).

Every active contact carries: ``normal_held`` 1 if its normal force is unknown and unilateral, 0 if it
is given; ``at_rest`` 1 if it has no slip velocity, so that it may stick or start to slide either way.
"""

from __future__ import annotations

import math

from nonsmooth.engine.delassus.delassus import add_product, own_block
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, kernel, room
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.linear import SINGULAR

SWEEPS = 4000
_SETTLED = 1e-15
_FLAT = 1e-14
"""What is added to a tangential block at least, relative to its trace, where friction is cut to its disc."""


@kernel("f8(S, F, I, i8, i8)")
def _row(S: Scalars, w: Floats, k: Integers, a: int, r: int) -> float:
    return add_product(S, w, k, w[S.b + 3 * a + r], a, r, S.f)


@kernel("void(S, F, I, i8)")
def _update_normal(S: Scalars, w: Floats, k: Integers, a: int) -> None:
    """Set the normal force that stops the approach, or zero."""
    line = 3 * a
    g = own_block(S, k, a)
    own = w[g]
    rest = _row(S, w, k, a, 0) - own * w[S.f + line]
    if k[S.at_rest + a] == 0:
        # the friction of a sliding contact moves with its normal force
        for i in range(1, 3):
            rest -= w[g + i] * w[S.f + line + i]
            own -= w[S.mu + a] * w[S.d + 2 * a + i - 1] * w[g + i]
        if own <= 0.0:
            return
    w[S.f + line] = max(0.0, -rest / own)


@kernel("void(S, F, I, i8)")
def _update_tangent(S: Scalars, w: Floats, k: Integers, a: int) -> None:
    """Set the friction: along the slip, or the sticking force cut to the disc of Coulomb."""
    f = S.f + 3 * a
    if k[S.at_rest + a] == 0:
        for i in range(2):
            w[f + 1 + i] = -w[S.mu + a] * w[f] * w[S.d + 2 * a + i]
        return
    g = own_block(S, k, a)
    g11, g12, g22 = w[g + 4], w[g + 5], w[g + 8]
    t1, t2 = w[f + 1], w[f + 2]
    c1 = _row(S, w, k, a, 1) - g11 * t1 - g12 * t2
    c2 = _row(S, w, k, a, 2) - g12 * t1 - g22 * t2
    k[S.tangent_held + a] = 1
    determinant = g11 * g22 - g12 * g12
    trace = g11 + g22
    if determinant > SINGULAR * trace * trace:
        t1, t2 = (g12 * c2 - g22 * c1) / determinant, (g12 * c1 - g11 * c2) / determinant
    elif trace > 0.0:
        # motion along one line only: the least force, G^+ c = G c / trace^2 for a matrix of rank one
        t1, t2 = -(g11 * c1 + g12 * c2) / (trace * trace), -(g12 * c1 + g22 * c2) / (trace * trace)
    else:
        t1 = t2 = 0.0
    if math.sqrt(t1 * t1 + t2 * t2) <= w[S.mu_static + a] * w[f]:
        w[f + 1], w[f + 2] = t1, t2
        return
    k[S.tangent_held + a] = 0
    _cut_to_disc(w, f + 1, g11, g12, g22, c1, c2, w[S.mu + a] * w[f])


@kernel("void(F, i8, f8, f8, f8, f8, f8, f8)")
def _cut_to_disc(w: Floats, t: int, g11: float, g12: float, g22: float, c1: float, c2: float, radius: float) -> None:
    """Minimise T.G T / 2 + c.T over |T| <= radius, its solution being on the edge: (G + alpha) T = -c."""
    if radius <= 0.0:
        w[t] = w[t + 1] = 0.0
        return
    alpha = _FLAT * (g11 + g22)
    for _iteration in range(60):
        a11, a22 = g11 + alpha, g22 + alpha
        determinant = a11 * a22 - g12 * g12
        x, y = (g12 * c2 - a22 * c1) / determinant, (g12 * c1 - a11 * c2) / determinant
        w[t], w[t + 1] = x, y
        norm = math.sqrt(x * x + y * y)
        # Newton on 1 / |T(alpha)|, which is nearly linear in alpha
        slope = (a22 * x * x - 2.0 * g12 * x * y + a11 * y * y) / (determinant * norm)
        step = (norm - radius) * norm / (radius * slope)
        alpha = max(_FLAT * (g11 + g22), alpha + step)
        if abs(step) <= 1e-16 * (alpha + g11 + g22):
            break
    norm = math.sqrt(w[t] * w[t] + w[t + 1] * w[t + 1])
    w[t] *= radius / norm
    w[t + 1] *= radius / norm


@room("i8(S, F, I, i8)")
def gauss_seidel(S: Scalars, w: Floats, k: Integers, sweeps: int) -> int:
    """Sweep until the forces settle; leave ``f``, ``tangent_held`` and, for incipient slip, ``d``.

    Return 1 if they settled within so many sweeps.
    """
    settled = 0
    for _sweep in range(sweeps):
        if interrupted(S, S.n_active) == 1:
            break
        change = size = 0.0
        for a in range(S.n_active):
            f = S.f + 3 * a
            old0, old1, old2 = w[f], w[f + 1], w[f + 2]
            if k[S.normal_held + a] == 1:
                _update_normal(S, w, k, a)
            _update_tangent(S, w, k, a)
            change = max(change, abs(w[f] - old0), abs(w[f + 1] - old1), abs(w[f + 2] - old2))
            size = max(size, abs(w[f]), abs(w[f + 1]), abs(w[f + 2]))
        if change <= _SETTLED * size:
            settled = 1
            break
    for a in range(S.n_active):
        t1, t2 = w[S.f + 3 * a + 1], w[S.f + 3 * a + 2]
        norm = math.sqrt(t1 * t1 + t2 * t2)
        if k[S.at_rest + a] == 1 and k[S.tangent_held + a] == 0 and norm > 0.0:
            w[S.d + 2 * a] = -t1 / norm
            w[S.d + 2 * a + 1] = -t2 / norm
        elif k[S.at_rest + a] == 1 and k[S.tangent_held + a] == 0:
            # no normal force, no friction: the slip starts along its acceleration
            v1, v2 = _row(S, w, k, a, 1), _row(S, w, k, a, 2)
            norm = math.sqrt(v1 * v1 + v2 * v2)
            w[S.d + 2 * a] = v1 / norm if norm > 0.0 else 1.0
            w[S.d + 2 * a + 1] = v2 / norm if norm > 0.0 else 0.0
    return settled
