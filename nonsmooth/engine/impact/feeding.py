"""Cascades of an impact that slip feeds: contacts that bounce on, though each bounce loses energy.

Where bodies that slip are drawn into each other, friction presses them together for as long as they slip, and what
bounces is small beside that and does not fade.  It is no bounce that anyone could see: the contacts stay pressed.
"""

from __future__ import annotations

import math

from nonsmooth.engine.delassus.delassus import diagonal_block
from nonsmooth.engine.impact.rates import IDLE
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, active_at, impact_state, kernel


@kernel("void(S)")
def watch_feeding(S: Scalars) -> None:
    """Begin to watch an impact."""
    S.phases_watched = 0
    S.rubbed_watched = S.lost_watched = 0.0
    S.bouncing_watched = math.inf


@kernel("i8(S, F, I, i8)")
def is_fed(S: Scalars, w: Floats, k: Integers, phases: int) -> int:
    """Return 1 if in the last ``phases`` slip has lost more than bounces have, and these have not faded.

    Between two looks, so many phases apart, nothing is.
    """
    if S.phases - S.phases_watched < phases:
        return 0
    rubbed = lost = bouncing = 0.0
    for a in range(S.n_active):
        active, state = active_at(S, w, k, a), impact_state(w, S.impact_y, a)
        stored = state.energy if active.phase != IDLE else 0.0
        rubbed += state.rubbed
        lost -= state.work + stored
        bouncing += stored + 0.5 * min(0.0, active.gap_rate) ** 2 / diagonal_block(S, w, k, a).nn
    fed = bouncing >= S.bouncing_watched and rubbed - S.rubbed_watched > lost - S.lost_watched
    S.phases_watched = S.phases
    S.rubbed_watched, S.lost_watched, S.bouncing_watched = rubbed, lost, bouncing
    return 1 if fed else 0
