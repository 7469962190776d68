"""How an impact ends: the books of its phases, and ends other than that of the last expansion."""

from __future__ import annotations

import math

from nonsmooth.engine.contact.forces import resolve
from nonsmooth.engine.delassus.delassus import own_block
from nonsmooth.engine.impact.rates import (
    COMPRESSION,
    DEFORMATION,
    ENERGY,
    EXPANSION,
    IDLE,
    IMPULSE,
    LOST,
    RUBBED,
    STRIDE,
    WORK,
    evaluate_impact_rates,
)
from nonsmooth.engine.impact.scales import REST
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, kernel
from nonsmooth.engine.numerics.linear import SINGULAR


@kernel("void(S, F, I, i8)")
def account(S: Scalars, w: Floats, k: Integers, a: int) -> None:
    """Book the work of the phase that ends at the active contact ``a``, or of the part of it so far."""
    work = w[S.impact_y + STRIDE * a + WORK]
    done = work - w[S.impact_mark + a]
    if k[S.phase + a] == COMPRESSION:
        w[S.stored + a] -= done
    else:
        w[S.returned + a] += done
    w[S.impact_mark + a] = work


@kernel("void(S, F, i8)")
def empty(S: Scalars, w: Floats, a: int) -> None:
    """Take the energy that is left of the active contact ``a``."""
    state = S.impact_y + STRIDE * a
    w[state + DEFORMATION] = w[state + ENERGY] = w[state + LOST] = 0.0


@kernel("i8(S, F, I)")
def finished(S: Scalars, w: Floats, k: Integers) -> int:
    """Return 1 if no contact is loaded."""
    for a in range(S.n_active):
        if k[S.phase + a] == COMPRESSION or k[S.phase + a] == EXPANSION:
            return 0
    return 1


@kernel("i8(S, F, I)")
def _trapped(S: Scalars, w: Floats, k: Integers) -> int:
    """Return 1 if contacts are loaded, but none of them moves, and their forces move nothing.

    A point that joints let move across one line only is wedged where that line lies within the cone of friction: slip
    and approach stop together, and the force of the contact goes into the joints.  G f = 0 means f.G f = 0, the forces
    then accelerate no part of the bodies, and so it stays: the deformation is never given back.  Rates that have next
    to no energy count as none; they would not change either.
    """
    brought = 0.0
    for a in range(S.n_active):
        brought = max(brought, w[S.impact_energy_scale + a])
    for a in range(S.n_active):
        loaded = k[S.phase + a] == COMPRESSION or k[S.phase + a] == EXPANSION
        if loaded and abs(w[S.impact_z + 3 * a]) > REST * math.sqrt(brought * w[own_block(S, k, a)]):
            return 0
    size = left = 0.0
    for a in range(S.n_active):
        row = S.block_start + S.first_grouped + a
        for r in range(3):
            total = total_size = 0.0
            for block in range(k[row], k[row + 1]):
                for s in range(3):
                    part = w[S.delassus + 9 * block + 3 * r + s] * w[S.f + 3 * k[S.block_column + block] + s]
                    total += part
                    total_size += abs(part)
            size, left = max(size, total_size), max(left, abs(total))
    return 1 if left <= SINGULAR * size else 0


@kernel("void(S, F, I)")
def end_trapped(S: Scalars, w: Floats, k: Integers) -> None:
    """End the phases of contacts that are trapped, if they are; what they have stored is lost to restitution."""
    if _trapped(S, w, k) == 0:
        return
    for a in range(S.n_active):
        if k[S.phase + a] == COMPRESSION or k[S.phase + a] == EXPANSION:
            account(S, w, k, a)
            k[S.phase + a] = IDLE
            empty(S, w, a)
            S.phases += 1


@kernel("i8(S, F, I)")
def faded(S: Scalars, w: Floats, k: Integers) -> int:
    """Return 1 if what is left of the impact, stored or about to be, is below the tolerance."""
    small = max(S.impact_rtol, 1e-11)
    for a in range(S.n_active):
        stored = w[S.impact_y + STRIDE * a + ENERGY]
        if k[S.phase + a] == IDLE:
            stored = 0.0
        if w[S.impact_z + 3 * a] < -small * S.speed_scale or stored > small * small * w[S.impact_energy_scale + a]:
            return 0
        if w[S.impact_z + 3 * a] > small * S.speed_scale and stored > 0.0 and k[S.phase + a] == EXPANSION:
            return 0
    return 1


@kernel()
def cut_short(S: Scalars, w: Floats, k: Integers) -> None:
    """End a cascade of ever smaller compressions: stop the approach that is left, by the impulses that do so."""
    for a in range(S.n_active):
        k[S.normal_held + a] = 1 if w[S.impact_z + 3 * a] < 0.0 else 0
        k[S.tangent_held + a] = 0
        w[S.f + 3 * a] = w[S.mu + a] = 0.0
        for r in range(3):
            w[S.b + 3 * a + r] = w[S.impact_z + 3 * a + r]
        k[S.phase + a] = IDLE
    resolve(S, w, k)
    for a in range(S.n_active):
        w[S.impact_y + STRIDE * a + IMPULSE] += w[S.f + 3 * a]
    S.truncated = 1


@kernel("void(S, F, I)")
def finish(S: Scalars, w: Floats, k: Integers) -> None:
    """Hand over the impulses and the energies."""
    for a in range(S.n_active):
        for r in range(3):
            w[S.impulse + 3 * a + r] = w[S.impact_y + STRIDE * a + IMPULSE + r]
        account(S, w, k, a)
        w[S.rubbed + a] = w[S.impact_y + STRIDE * a + RUBBED]
    evaluate_impact_rates(S, w, k, S.impact_y)
