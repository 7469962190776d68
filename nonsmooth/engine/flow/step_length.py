"""How long the next step of the flow is to be, and what limits it."""

from __future__ import annotations

import math

from nonsmooth.engine.memory.limits import BY_END, BY_ERROR, BY_FIRST, BY_LARGEST, BY_LIST, BY_SAMPLES
from nonsmooth.engine.memory.modes import OPEN
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, kernel

_BEGINS = 10.0
"""A compliant contact begins so many gap tolerances from its reach at most."""
_FIRST_WAY = 1e-3
"""Way that surfaces go in the first step of one, in units of the smaller body."""


@kernel("f8(S, F, I, i8)")
def first_of_compliant(S: Scalars, w: Floats, k: Integers, c: int) -> float:
    """Return how long the first step of a closed contact may be: a compliant one that begins has no force as yet.

    Were it over before the second stage of the step, none would meet a force, and the bodies would pass each other.
    """
    if k[S.normal_function + c] == 0 or w[S.guard_end + 2 * c] > _BEGINS * S.gap_tolerance:
        return 1e300
    rate = S.rate_end + 3 * c
    speed = math.sqrt(w[rate] * w[rate] + w[rate + 1] * w[rate + 1] + w[rate + 2] * w[rate + 2])
    return float(_FIRST_WAY * w[S.size + c] / max(speed, S.velocity_tolerance))


@kernel("f8(S, I)")
def wanted_step(S: Scalars, k: Integers) -> float:
    """Return how long the next step is if nothing cuts it short; it is never longer."""
    for c in range(S.n_contacts):
        if k[S.mode + c] != OPEN:
            return float(min(S.h_closed, S.h_max))
    return float(min(S.h_free, S.h_max))


@kernel("i8(S, f8)")
def limit_of(S: Scalars, wanted: float) -> int:
    """Return what limits a step that has not been tried yet; ``wanted`` is how long it is if nothing cuts it short."""
    h = min(wanted, S.h_listed, S.h_sampled, S.h_valid)
    if S.fresh == 0 and S.h_first < h:
        return BY_FIRST
    if h == wanted:
        return BY_LARGEST if wanted == S.h_max else BY_ERROR
    if h == S.h_listed:
        return BY_LIST
    return BY_SAMPLES if h == S.h_sampled else BY_END
