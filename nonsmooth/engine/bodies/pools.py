"""Which features of two shapes stand in the contacts that are kept for them, where there are too many for one each.

A pool is a row of declared contacts of two units, each of which holds the numbers of a pair of features, or none.  When
contacts are listed, a function of the pair finds the features that are nearer than the margin of the list.  Those that
have a contact keep it, with its mode and slip; the others that are open make room.  Behind its features a contact has
how far they may come from each other while the list stands.
"""

from __future__ import annotations

from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.engine.memory.layout import CATALOGUE, CATALOGUE_FLOATS, CLOSING_RATE, DIRECTION
from nonsmooth.engine.memory.modes import NO_SLOT, NOT_FINITE, OPEN, RUNNING
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, at, call_pair, kernel, pool_at, unit_at
from nonsmooth.engine.numerics.vectors import dot, minus

_WIDTH = len(CATALOGUE)
_MODE, _CANDIDATE = CATALOGUE.index("mode"), CATALOGUE.index("candidate")


@kernel("i8(S, F, I, i8)")
def is_empty(S: Scalars, w: Floats, k: Integers, declared: int) -> int:
    """Return 1 if a declared contact is one of a pool and holds no features."""
    candidate = k[S.catalogue + _WIDTH * declared + _CANDIDATE]
    return 1 if candidate > 0 and w[candidate] == 0.0 else 0


@kernel("i8(S, F, I, i8, i8)")
def are_near(S: Scalars, w: Floats, k: Integers, one: int, two: int) -> int:
    """Return 1 if the balls of two units are nearer than the margin of the list."""
    a, b = unit_at(S, w, k, one), unit_at(S, w, k, two)
    way = minus(a.place, b.place)
    near = a.radius + b.radius + S.margin_of_list
    return 1 if dot(way, way) <= near * near else 0


@kernel("void(S, F, I, i8, i8, i8)")
def _keep(S: Scalars, w: Floats, k: Integers, declared: int, found: int, n: int) -> None:
    """Empty an open contact whose features are not among ``n`` that were found; cross them out where they are."""
    candidate = k[S.catalogue + _WIDTH * declared + _CANDIDATE]
    for i in range(n):
        same = 1
        for r in range(CANDIDATE):
            if w[found + CANDIDATE * i + r] != w[candidate + r]:
                same = 0
        if same == 1:
            w[found + CANDIDATE * i] = 0.0
            return
    if k[S.catalogue + _WIDTH * declared + _MODE] == OPEN:
        w[candidate] = 0.0
        floats = at(w, S.catalogue_floats + CATALOGUE_FLOATS * declared)
        floats[DIRECTION], floats[DIRECTION + 1], floats[CLOSING_RATE] = 1.0, 0.0, 0.0


@kernel("i8(S, F, I)")
def fill_pools(S: Scalars, w: Floats, k: Integers) -> int:
    """Put the features nearer than the margin into the contacts of their pools; return the status."""
    for number in range(S.n_pools):
        pool = pool_at(S, w, k, number)
        out, first, contacts = pool.out, pool.first, pool.contacts
        found, n = out + 1, 0
        if are_near(S, w, k, pool.unit_a, pool.unit_b) == 1:
            w[out] = S.margin_of_list
            frame_a, frame_b = unit_at(S, w, k, pool.unit_a).frame, unit_at(S, w, k, pool.unit_b).frame
            call_pair(pool.function, at(w, frame_a), at(w, frame_b), at(w, pool.parameters), at(w, out))
            if not w[out] >= 0.0:
                return NOT_FINITE
            n = int(w[out])
            if n > contacts:
                return NO_SLOT
        for declared in range(first, first + contacts):
            if is_empty(S, w, k, declared) == 0:
                _keep(S, w, k, declared, found, n)
        declared = first
        for i in range(n):
            if w[found + CANDIDATE * i] == 0.0:
                continue
            while declared < first + contacts and is_empty(S, w, k, declared) == 0:
                declared += 1
            if declared == first + contacts:
                return NO_SLOT
            candidate = k[S.catalogue + _WIDTH * declared + _CANDIDATE]
            for r in range(CANDIDATE):
                w[candidate + r] = w[found + CANDIDATE * i + r]
        for declared in range(first, first + contacts):
            w[k[S.catalogue + _WIDTH * declared + _CANDIDATE] + CANDIDATE] = 2.0 * S.margin_of_list
    return RUNNING
