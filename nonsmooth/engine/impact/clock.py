"""The clock of an impact: common to all contacts, until one is left in action, which gets its own."""

from __future__ import annotations

from nonsmooth.engine.impact.guards import prepare_guards
from nonsmooth.engine.impact.rates import ENERGY, EXPANSION, HELD, IDLE, LOST, STRIDE
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, kernel


@kernel("i8(S, F, I)")
def change_clock(S: Scalars, w: Floats, k: Integers) -> int:
    """Give the last contact in action its own clock; go back to where it got it if it does not stay alone.

    Returns 1 if the clock has changed.
    """
    acting = 0
    last = -1
    for a in range(S.n_active):
        if k[S.phase + a] != IDLE:
            acting += 1
            last = a
    n = STRIDE * S.n_active
    if S.lone < 0:
        if acting != 1 or k[S.phase + last] == HELD or S.may_be_lone == 0:
            return 0
        state = S.impact_y + STRIDE * last
        if k[S.phase + last] == EXPANSION and not w[state + ENERGY] > w[state + LOST]:
            # its own clock runs until the energy is used up, of which the integration's error has left none: a steep
            # force has given all of it back long before the deformation, which ends the phase on the common clock
            return 0
        for i in range(n):
            w[S.impact_kept + i] = w[S.impact_y + i]
        _keep_phases(S, w, k)
        S.lone = last
        prepare_guards(S, w, k)
        return 1
    if acting == 0 or (acting == 1 and last == S.lone):
        return 0
    for i in range(n):
        w[S.impact_y + i] = w[S.impact_kept + i]
    S.lone = -1
    S.may_be_lone = 0
    _restore_phases(S, w, k)
    return 1


@kernel("void(S, F, I)")
def _keep_phases(S: Scalars, w: Floats, k: Integers) -> None:
    S.phases_kept = S.phases
    for a in range(S.n_active):
        c, books = k[S.active + a], S.books_kept + 5 * a
        k[S.kept + 2 * a], k[S.kept + 2 * a + 1] = k[S.phase + a], k[S.tangent_held + a]
        w[books], w[books + 1], w[books + 2] = w[S.stored + a], w[S.returned + a], w[S.impact_mark + a]
        w[books + 3], w[books + 4] = w[S.direction + 2 * c], w[S.direction + 2 * c + 1]


@kernel("void(S, F, I)")
def _restore_phases(S: Scalars, w: Floats, k: Integers) -> None:
    S.phases = S.phases_kept
    for a in range(S.n_active):
        c, books = k[S.active + a], S.books_kept + 5 * a
        k[S.phase + a], k[S.tangent_held + a] = k[S.kept + 2 * a], k[S.kept + 2 * a + 1]
        w[S.stored + a], w[S.returned + a], w[S.impact_mark + a] = w[books], w[books + 1], w[books + 2]
        w[S.direction + 2 * c], w[S.direction + 2 * c + 1] = w[books + 3], w[books + 4]
    prepare_guards(S, w, k)
