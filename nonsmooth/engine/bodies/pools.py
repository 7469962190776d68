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
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, at, call_pair, kernel

_WIDTH = len(CATALOGUE)
_MODE, _CANDIDATE = CATALOGUE.index("mode"), CATALOGUE.index("candidate")


@kernel("i8(S, F, I, i8)")
def is_empty(S: Scalars, w: Floats, k: Integers, declared: int) -> int:
    """Return 1 if a declared contact is one of a pool and holds no features."""
    candidate = k[S.catalogue + _WIDTH * declared + _CANDIDATE]
    return 1 if candidate > 0 and w[candidate] == 0.0 else 0


@kernel("i8(S, F, I, i8)")
def _are_near(S: Scalars, w: Floats, k: Integers, pool: int) -> int:
    one, two, square = k[S.pool_unit_a + pool], k[S.pool_unit_b + pool], 0.0
    for i in range(3):
        square += (w[S.unit_place + 3 * one + i] - w[S.unit_place + 3 * two + i]) ** 2
    near = w[S.unit_radius + one] + w[S.unit_radius + two] + S.margin_of_list
    return 1 if square <= near * near else 0


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
        floats = S.catalogue_floats + CATALOGUE_FLOATS * declared
        w[floats + DIRECTION], w[floats + DIRECTION + 1], w[floats + CLOSING_RATE] = 1.0, 0.0, 0.0


@kernel("i8(S, F, I)")
def fill_pools(S: Scalars, w: Floats, k: Integers) -> int:
    """Put the features nearer than the margin into the contacts of their pools; return the status."""
    for pool in range(S.n_pools):
        out = k[S.pool_out + pool]
        found, n = out + 1, 0
        first, contacts = k[S.pool_first + pool], k[S.pool_contacts + pool]
        if _are_near(S, w, k, pool) == 1:
            w[out] = S.margin_of_list
            call_pair(
                k[S.pool_function + pool],
                at(w, k[S.unit_frame + k[S.pool_unit_a + pool]]),
                at(w, k[S.unit_frame + k[S.pool_unit_b + pool]]),
                at(w, k[S.pool_parameters + pool]),
                at(w, out),
            )
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
