"""Who sticks, who slides, who lifts off: block Gauss-Seidel on Coulomb's cone, Eqs. (16) and (17).

Every active contact carries: ``normal_held`` 1 if its normal force is unknown and unilateral, 0 if it
is given; ``at_rest`` 1 if it has no slip velocity, so that it may stick or start to slide either way.
"""

from __future__ import annotations

from nonsmooth.engine.contact.forces import friction_of_slip
from nonsmooth.engine.delassus.delassus import add_product, diagonal_block
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, active_at, entry_point, kernel
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.linear import SINGULAR
from nonsmooth.engine.numerics.vectors import length

SWEEPS = 4000
_SETTLED = 1e-15
_FLAT = 1e-14
"""What is added to a tangential block at least, relative to its trace, where friction is cut to its disc."""


@kernel("f8(S, F, I, i8, i8)")
def _row(S: Scalars, w: Floats, k: Integers, a: int, r: int) -> float:
    return add_product(S, w, k, active_at(S, w, k, a).free[r], a, r, S.active_forces)


@kernel("void(S, F, I, i8)")
def _update_normal(S: Scalars, w: Floats, k: Integers, a: int) -> None:
    """Set the normal force that stops the approach, or zero."""
    active, block = active_at(S, w, k, a), diagonal_block(S, w, k, a)
    own = block.nn
    rest = _row(S, w, k, a, 0) - own * active.normal_force
    if active.at_rest == 0:
        # the friction of a sliding contact moves with its normal force
        for i in range(1, 3):
            rest -= block.entries[i] * active.force[i]
            own -= active.mu * active.direction[i - 1] * block.entries[i]
        if own <= 0.0:
            return
    active.normal_force = max(0.0, -rest / own)


@kernel("void(S, F, I, i8)")
def _update_tangent(S: Scalars, w: Floats, k: Integers, a: int) -> None:
    """Set the friction: along the slip, or the sticking force cut to the disc of Coulomb."""
    active = active_at(S, w, k, a)
    if active.at_rest == 0:
        friction_of_slip(S, w, k, a)
        return
    own = diagonal_block(S, w, k, a)
    g11, g12, g22 = own.t11, own.t12, own.t22
    t1, t2 = active.friction
    c1 = _row(S, w, k, a, 1) - g11 * t1 - g12 * t2
    c2 = _row(S, w, k, a, 2) - g12 * t1 - g22 * t2
    active.tangent_held = 1
    determinant = g11 * g22 - g12 * g12
    trace = g11 + g22
    if determinant > SINGULAR * trace * trace:
        t1, t2 = (g12 * c2 - g22 * c1) / determinant, (g12 * c1 - g11 * c2) / determinant
    elif trace > 0.0:
        # motion along one line only: the least force, G^+ c = G c / trace^2 for a matrix of rank one
        t1, t2 = -(g11 * c1 + g12 * c2) / (trace * trace), -(g12 * c1 + g22 * c2) / (trace * trace)
    else:
        t1 = t2 = 0.0
    if length((t1, t2)) <= active.mu_static * active.normal_force:
        active.friction = t1, t2
        return
    active.tangent_held = 0
    active.friction = _cut_to_disc(g11, g12, g22, c1, c2, active.mu * active.normal_force)


@kernel("v2(f8, f8, f8, f8, f8, f8)")
def _cut_to_disc(g11: float, g12: float, g22: float, c1: float, c2: float, radius: float) -> tuple[float, float]:
    """Minimise T.G T / 2 + c.T over |T| <= radius, its solution being on the edge: (G + alpha) T = -c."""
    if radius <= 0.0:
        return 0.0, 0.0
    x = y = 0.0
    alpha, size = _FLAT * (g11 + g22), length((c1, c2))
    if size > 0.0:
        # exact where c is an eigenvector of G, as in a plane
        d1, d2 = c1 / size, c2 / size
        alpha = max(alpha, size / radius - (g11 * d1 * d1 + 2.0 * g12 * d1 * d2 + g22 * d2 * d2))
    for _iteration in range(60):
        a11, a22 = g11 + alpha, g22 + alpha
        determinant = a11 * a22 - g12 * g12
        x, y = (g12 * c2 - a22 * c1) / determinant, (g12 * c1 - a11 * c2) / determinant
        norm = length((x, y))
        # Newton on 1 / |T(alpha)|, which is nearly linear in alpha
        slope = (a22 * x * x - 2.0 * g12 * x * y + a11 * y * y) / (determinant * norm)
        step = (norm - radius) * norm / (radius * slope)
        alpha = max(_FLAT * (g11 + g22), alpha + step)
        if abs(step) <= _SETTLED * (alpha + g11 + g22):
            break
    norm = length((x, y))
    return x * (radius / norm), y * (radius / norm)


@entry_point("i8(S, F, I, i8)")
def gauss_seidel(S: Scalars, w: Floats, k: Integers, sweeps: int) -> int:
    """Sweep until the ``active_forces`` settle; leave ``tangent_held`` and, of incipient slip, ``active_directions``.

    Return 1 if they settled within so many sweeps.
    """
    settled = 0
    for _sweep in range(sweeps):
        if interrupted(S, S.n_active) == 1:
            break
        change = size = 0.0
        for a in range(S.n_active):
            active = active_at(S, w, k, a)
            f = active.force
            old0, old1, old2 = f[0], f[1], f[2]
            if active.normal_held == 1:
                _update_normal(S, w, k, a)
            _update_tangent(S, w, k, a)
            change = max(change, abs(f[0] - old0), abs(f[1] - old1), abs(f[2] - old2))
            size = max(size, abs(f[0]), abs(f[1]), abs(f[2]))
        if change <= _SETTLED * size:
            settled = 1
            break
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        t1, t2 = active.friction
        norm = length(active.friction)
        if active.at_rest == 1 and active.tangent_held == 0 and norm > 0.0:
            active.direction = -t1 / norm, -t2 / norm
        elif active.at_rest == 1 and active.tangent_held == 0:
            # no normal force, no friction: the slip starts along its acceleration
            v1, v2 = _row(S, w, k, a, 1), _row(S, w, k, a, 2)
            norm = length((v1, v2))
            active.direction = v1 / norm if norm > 0.0 else 1.0, v2 / norm if norm > 0.0 else 0.0
    return settled
