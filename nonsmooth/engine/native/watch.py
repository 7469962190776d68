"""Whoever waits for the engine is let in now and then, in the middle of an impact or a search, too."""

from __future__ import annotations

from nonsmooth.engine.native.kernel import Workspace, call_watch, kernel


@kernel("i8(ws, i8)")
def interrupted(ws: Workspace, work: int) -> int:
    """Count work, about one for every evaluation of a contact or pair in a matrix; return 1 if the run is to stop.

    When the work that the watch allows is done, the watch is called: it says how much may follow, nothing for a stop.
    Long loops then end as if they had failed, so that nothing unfinished is taken over.
    """
    ws.request.n_work += work
    if ws.request.n_work >= ws.request.work_budget and ws.request.interrupt_check != 0:
        ws.request.n_work = 0
        ws.request.work_budget = int(call_watch(ws.request.interrupt_check, ws.island.time))
        if ws.request.work_budget == 0:
            ws.request.is_interrupted = True
    return int(ws.request.is_interrupted)
