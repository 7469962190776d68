"""The scales of an impact: what counts as large and as small among its speeds, impulses, deformations and energies."""

from __future__ import annotations

import math

from nonsmooth.engine.delassus.delassus import own_block
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, at, call_scalar, kernel

REST = 1e-9
"""Slip velocities below this, relative to the impact speed, count as none; so do those within the tolerance."""
_CIRCLING = 30.0
"""A slip that circles round zero does so within the error of so many steps."""
_MET = 1e-6
"""So close, relative to it, the deformation that takes up an energy need be known: it is a scale."""
_UNUSED = 1e300


@kernel("f8(S, F, I, f8)")
def scale_impact(S: Scalars, w: Floats, k: Integers, seed: float) -> float:
    """Set the scales of speed, energy, impulse, deformation, force and rest; return the shortest time of a compression.

    A contact takes up no more energy than the fastest approach would bring to it, and no more than the approaches of
    all bring: next to one with a small coefficient of its own, others would else count as light.  No speed is slower
    than the ``seed``.
    """
    m = S.n_active
    S.speed_scale = seed
    brought = 0.0
    for a in range(m):
        speed = max(seed, -w[S.impact_z0 + 3 * a])
        S.speed_scale = max(S.speed_scale, speed)
        if speed > 0.0:
            brought = max(brought, speed * speed / w[own_block(S, k, a)])
    S.rest_speed = max(REST, _CIRCLING * S.impact_rtol) * S.speed_scale
    shortest = _UNUSED
    for a in range(m):
        energy = min(brought, S.speed_scale * S.speed_scale / w[own_block(S, k, a)])
        x = 1.0
        w[S.impact_energy_scale + a] = energy
        # the impulse that takes it up
        w[S.impulse_scale + a] = math.sqrt(energy / w[own_block(S, k, a)])
        if a != S.lone:
            c = k[S.active + a]
            for _iteration in range(4):
                force = call_scalar(k[S.force_function + c], x, at(w, k[S.force_parameters + c]))
                double = call_scalar(k[S.force_function + c], 2.0 * x, at(w, k[S.force_parameters + c]))
                if not (force > 0.0 and double > 0.5001 * force):
                    S.culprit = c
                    return -1.0
                if abs(energy - force * x) <= _MET * energy:
                    break
                x *= (energy / (force * x)) ** (math.log(2.0) / math.log(2.0 * double / force))
        w[S.impact_x_scale + a] = x
        w[S.impact_f_scale + a] = energy / x
        shortest = min(shortest, (energy if a == S.lone else x) / S.speed_scale)
    for a in range(m):
        w[S.rest_slip + a] = _slip_at_rest(S, w, k, a)
    return shortest


@kernel("f8(S, F, I, i8)")
def _slip_at_rest(S: Scalars, w: Floats, k: Integers, a: int) -> float:
    """Return the slip of the active contact ``a`` that counts as none: small by its energy, or within the error."""
    g = own_block(S, k, a)
    moved = 0.0
    row = S.block_start + S.first_grouped + a
    for block in range(k[row], k[row + 1]):
        impulse = w[S.impulse_scale + k[S.block_column + block]]
        for i in range(3, 9):
            moved = max(moved, abs(w[S.delassus + 9 * block + i]) * impulse)
    mobility = max(w[g + 4], w[g + 8])
    small = float(S.rest_speed)
    if mobility < w[g]:
        small *= math.sqrt(mobility / w[g])
    return float(max(small, _CIRCLING * S.impact_rtol * moved))
