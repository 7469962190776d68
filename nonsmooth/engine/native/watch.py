"""Whoever waits for the engine is let in now and then, in the middle of an impact or a search, too."""

from __future__ import annotations

from nonsmooth.engine.native.kernel import Workspace, call_watch, kernel


@kernel("i8(ws, i8)")
def interrupted(ws: Workspace, work: int) -> int:
    """Count work, about one for every evaluation of a contact or pair in a matrix; return 1 if the run is to stop.

    When the work that the watch allows is done, the watch is called: it says how much may follow, nothing for a stop.
    Long loops then end as if they had failed, so that nothing unfinished is taken over.
    """
    ws.work += work
    if ws.work >= ws.patience and ws.watch != 0:
        ws.work = 0
        ws.patience = int(call_watch(ws.watch, ws.t))
        if ws.patience == 0:
            ws.stopped = 1
    return int(ws.stopped)
