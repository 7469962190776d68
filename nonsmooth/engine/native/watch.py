"""Whoever waits for the engine is let in now and then, in the middle of an impact or a search, too."""

from __future__ import annotations

from nonsmooth.engine.native.kernel import Scalars, call_watch, kernel


@kernel("i8(S, i8)")
def interrupted(S: Scalars, work: int) -> int:
    """Count work, about one for every evaluation of a contact or pair in a matrix; return 1 if the run is to stop.

    When the work that the watch allows is done, the watch is called: it says how much may follow, nothing for a stop.
    Long loops then end as if they had failed, so that nothing unfinished is taken over.
    """
    S.work += work
    if S.work >= S.patience and S.watch != 0:
        S.work = 0
        S.patience = int(call_watch(S.watch, S.t))
        if S.patience == 0:
            S.stopped = 1
    return int(S.stopped)
