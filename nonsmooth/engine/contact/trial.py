"""A trial of the contact problem: modes guessed from forces, and the one test that every answer must pass."""

from __future__ import annotations

import math

from nonsmooth.engine.contact.distribution import distribute
from nonsmooth.engine.contact.forces import friction_of_slip, reduced_coefficient, resolve
from nonsmooth.engine.delassus.delassus import add_product, own_block
from nonsmooth.engine.memory.modes import OPEN, SLIDE, STICK
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, kernel, room

_TOLERANCE = 1e-9
_SOLVED = 1e-5
"""Part of what counts as zero in an island that round-off of its largest forces leaves in all of them."""
_ARRIVED = 0.1
_DISAGREEMENT = 1e3
"""More contacts than can hold independently may disagree on the motion by so many times what counts as zero."""


@kernel("void(S, F, I)")
def hold_tried(S: Scalars, w: Floats, k: Integers) -> None:
    """Translate the modes under trial into what is held, and find the forces that hold it."""
    for a in range(S.n_active):
        mode = k[S.mode_tried + a]
        k[S.normal_held + a] = 0 if mode == OPEN else 1
        # nothing holds what has no friction: it is at rest by chance
        k[S.tangent_held + a] = 1 if mode == STICK and w[S.mu_static + a] > 0.0 else 0
        if mode == OPEN:
            w[S.f + 3 * a] = 0.0
    resolve(S, w, k)
    S.effort += float(S.n_unknown) ** 3


@kernel("void(S, F, I)")
def set_scales(S: Scalars, w: Floats, k: Integers) -> None:
    """Write the accelerations and what counts as zero among them and among the forces."""
    # the accelerations that may cancel one another in b set the scale, not b itself
    scale = S.acceleration_scale
    force_scale = 0.0
    for i in range(3 * S.n_active):
        force_scale = max(force_scale, abs(w[S.f + i]))
    for a in range(S.n_active):
        own = w[own_block(S, k, a)]
        if own > 0.0:
            force_scale = max(force_scale, scale / own)
    for a in range(S.n_active):
        row = S.block_start + S.first_grouped + a
        for r in range(3):
            total = w[S.b + 3 * a + r]
            for block in range(k[row], k[row + 1]):
                for s in range(3):
                    part = w[S.delassus + 9 * block + 3 * r + s] * w[S.f + 3 * k[S.block_column + block] + s]
                    total += part
                    scale = max(scale, abs(part))
            w[S.acceleration + 3 * a + r] = total
    S.small_acceleration, S.small_force = _TOLERANCE * scale, _TOLERANCE * force_scale


@kernel("f8(S, F, I, i8)")
def small_force(S: Scalars, w: Floats, k: Integers, a: int) -> float:
    """Return what counts as zero among the forces of one contact: beside a heavy body a light one has its own scale."""
    own, size = w[own_block(S, k, a)], 0.0
    for r in range(3):
        size = max(size, abs(w[S.f + 3 * a + r]))
    if own > 0.0:
        size = max(size, S.acceleration_scale / own)
    return float(_TOLERANCE * size + _SOLVED * S.small_force)


@room("i8(S, F, I, i8)")
def verify(S: Scalars, w: Floats, k: Integers, lenient: int) -> int:
    """Find the forces of the modes under trial; return 1 if modes and forces fulfil the laws themselves.

    Where the forces are not unique those of least norm are found; where they break Coulomb's bound, others that
    give the same motion and keep it are looked for, and the modes pass iff there are such; a lenient look (1) does so
    where they pull, too.
    """
    hold_tried(S, w, k)
    return judge(S, w, k, lenient)


@kernel("i8(S, F, I, i8)")
def _compare(S: Scalars, w: Floats, k: Integers, lenient: int) -> int:
    """Return 1 if the forces fulfil the laws, 2 if others that are as good may, 0 if not."""
    set_scales(S, w, k)
    small = S.small_acceleration
    held = small if S.deficient == 0 else _DISAGREEMENT * small
    result = 1
    for a in range(S.n_active):
        mode, faint = k[S.mode_tried + a], small_force(S, w, k, a)
        normal = w[S.acceleration + 3 * a]
        if mode == OPEN:
            if not normal >= -small:
                return 0
            continue
        if not abs(normal) <= held:
            return 0
        # sliding on which more force gives more approach is balanced on an edge, and falls off either side
        if mode == SLIDE and k[S.at_rest + a] == 0 and reduced_coefficient(S, w, k, a) <= 0.0:
            return 0
        if not w[S.f + 3 * a] >= -faint:
            if lenient == 0 or S.deficient == 0:
                return 0
            result = 2
        a1, a2 = w[S.acceleration + 3 * a + 1], w[S.acceleration + 3 * a + 2]
        if mode == STICK:
            if not abs(a1) + abs(a2) <= held:
                return 0
            t1, t2 = w[S.f + 3 * a + 1], w[S.f + 3 * a + 2]
            if not math.sqrt(t1 * t1 + t2 * t2) <= w[S.mu_static + a] * w[S.f + 3 * a] + faint:
                if k[S.redundant + a] == 0:
                    return 0
                result = 2
        elif k[S.at_rest + a] == 1:
            forward = a1 * w[S.d + 2 * a] + a2 * w[S.d + 2 * a + 1]
            across = a1 * w[S.d + 2 * a + 1] - a2 * w[S.d + 2 * a]
            if not (forward >= -small and abs(across) <= small):
                return 0
    return result


@kernel("i8(S, F, I, i8)")
def judge(S: Scalars, w: Floats, k: Integers, lenient: int) -> int:
    """Return 1 if the forces ``f`` fulfil the laws in the modes under trial, distributed where not unique."""
    result = _compare(S, w, k, lenient)
    if result == 2 and distribute(S, w, k, 0.0, _ARRIVED * S.small_force) == 1:
        # the share of sliding contacts may have moved with their normal forces: all is looked at again
        for a in range(S.n_active):
            if k[S.mode_tried + a] == SLIDE:
                friction_of_slip(S, w, a)
        result = _compare(S, w, k, lenient)
    return 1 if result == 1 else 0


@kernel("void(S, F, I)")
def identify(S: Scalars, w: Floats, k: Integers) -> None:
    """Guess modes and directions from the forces ``f``, by the side of the natural map on which they stand."""
    for a in range(S.n_active):
        line = 3 * a
        push = 0.0
        for r in range(3):
            total = add_product(S, w, k, w[S.b + line + r], a, r, S.f)
            if r == 0:
                push = w[S.f + line] * w[own_block(S, k, a)] - total
            w[S.acceleration + line + r] = total
        k[S.mode_tried + a] = SLIDE
        if k[S.at_rest + a] == 1:
            g = slope_of_slip(S, w, k, a)
            y1 = g * w[S.f + line + 1] - w[S.acceleration + line + 1]
            y2 = g * w[S.f + line + 2] - w[S.acceleration + line + 2]
            norm = math.sqrt(y1 * y1 + y2 * y2)
            if norm > 0.0:
                w[S.d + 2 * a], w[S.d + 2 * a + 1] = -y1 / norm, -y2 / norm
            if k[S.freed + a] == 0 and norm <= g * w[S.mu + a] * w[S.f + line]:
                k[S.mode_tried + a] = STICK
        if push <= 0.0:
            k[S.mode_tried + a] = OPEN


@kernel("f8(S, F, I, i8)")
def slope_of_slip(S: Scalars, w: Floats, k: Integers, a: int) -> float:
    """Return how fast contact ``a`` slips under a unit of its own friction, or a number like it where it cannot."""
    g = own_block(S, k, a)
    largest = max(w[g + 4], w[g + 8])
    return largest if largest > 0.0 else w[g]
