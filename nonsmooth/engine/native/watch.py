"""The interrupt check: long computations call it now and then, so that Ctrl-C and progress do not wait for them."""

from __future__ import annotations

from nonsmooth.engine.native.kernel import Workspace, call_watch, kernel


@kernel("b1(ws, i8)")
def interrupted(ws: Workspace, work: int) -> bool:
    """Add ``work`` to the work done, and call the interrupt check if the budget is used up. True if the run must stop.

    A unit of work is about one evaluation of a contact, or of a pair in a matrix. The check returns the next budget,
    zero to stop the run. Long loops then end as if they had failed, so that no unfinished result is used. Without a
    check nothing stops the run.
    """
    ws.request.n_work += work
    # an address of zero: there is no check
    if ws.request.n_work >= ws.request.work_budget and ws.request.interrupt_check != 0:
        ws.request.n_work = 0
        ws.request.work_budget = int(call_watch(ws.request.interrupt_check, ws.island.time))
        if ws.request.work_budget == 0:
            ws.request.is_interrupted = True
    # once set it stays, so that all callers up to Python end
    return ws.request.is_interrupted
