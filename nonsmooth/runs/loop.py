"""The loop that feeds the engine, empties its buffers and reports progress."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import NamedTuple

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.modes import CONDITION_MET, DONE, PAUSED, STOPPED
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Engine
from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.runs.engine_driver import EngineDriver
from nonsmooth.runs.output_sink import OutputSink
from nonsmooth.runs.stall_monitor import StallMonitor
from nonsmooth.runs.records import Records
from nonsmooth.runs.so_far import RunSoFar, Until
from nonsmooth.solution.files import FileError

_STEPS_NEAR_END = 16
"""So many steps at most a run that goes on repeats, or more where a checkpoint is large:"""
_BYTES_PER_STEP = 1 << 13
"""to copy so much of one takes a small part of the time of a step [bytes]."""
Progress = Callable[[float, float], None]


class Ending(NamedTuple):
    """How the engine ended.

    Attributes
    ----------
    status : int
        Its status.
    interrupted : bool
        Whether that was asked for.
    checkpoint : Checkpoint
        What its memory held at last where nothing yet said when the run would end.
    told : int
        Events from there on.
    hint : str
        What a run that failed was held up by, as far as counters and events tell.
    trouble : str
        Why its results could not be kept, "" where they could.
    """

    status: int
    interrupted: bool
    checkpoint: Checkpoint
    told: int
    hint: str
    trouble: str = ""


def run_engine(
    engine: Engine,
    model: LaidOut,
    records: Records,
    begun: Checkpoint,
    progress: Progress | None,
    keeper: OutputSink,
    until: Until | None = None,
) -> Ending:
    """Run to the end time, to a failure, until a condition is met or somebody interrupts.

    ``begun`` is the checkpoint of where it starts.

    Raises
    ------
    InvalidInput
        If the engine breaks its contract, or ``until`` returns what is neither true nor false.
    BaseException
        Whatever ``progress`` or ``until`` raises.
    """
    memory = model.memory
    t_end = float(memory[owners.Request.t_end])
    report = None if progress is None else lambda t: progress(t, t_end)
    status, interrupted, trouble = PAUSED, False, ""
    checkpoint, before = begun, records.n_passed
    pace: StallMonitor | None = None
    so_far, looks = None if until is None else RunSoFar(model, records, engine), 0
    try:
        with model.watch.reporting(report) as watch:
            engine_at = EngineDriver(engine, model, watch.call)
            while status == PAUSED:
                looks, reached = looks + 1, None if so_far is None else so_far.reached
                # a condition sees the start before any step
                status = engine_at.advance(keeper.steps if until is None else min(looks - 1, 1), True)
                # a wary engine that does nothing is next to the end
                near = status == PAUSED and (so_far is None or reached == so_far.reached)
                if near or (status == PAUSED and looks % keeper.steps == 0):
                    checkpoint, before = Checkpoint.of(memory), records.n_passed
                    keeper.keep(checkpoint)
                if near:
                    if records.waiting:
                        # with full buffers an engine would do nothing
                        pace = pace or StallMonitor(model, begun)
                        pace.look(status)
                        records.drain()
                    most = max(_STEPS_NEAR_END, checkpoint.size // _BYTES_PER_STEP)
                    status = engine_at.get_on(most if until is None else 1, checkpoint)
                if status != DONE:
                    pace = pace or StallMonitor(model, begun)
                    pace.look(status)
                records.drain()
                if status == PAUSED and so_far is not None and until is not None and _is_met(until, so_far):
                    status = CONDITION_MET
                if progress is not None:
                    progress(float(memory[owners.Island.time]), t_end)
    except KeyboardInterrupt:
        records.drain()
        status, interrupted = PAUSED, True
        # a program goes on behind it as if it had come to its end
        told = f"interrupted at t = {memory[owners.Island.time]:.9g} s: the run returns what it has"
        print(f"{told}, with the status 'interrupted'", file=sys.stderr, flush=True)
    except FileError as error:
        records.drain()
        status, trouble = PAUSED, str(error)
    except MemoryError as error:
        # what was drained before is kept, where there is room to put it together
        status, trouble = PAUSED, f"the memory ran out: {error}."
    if status == DONE:
        records.check_end(engine)
    records.end()
    if status in (STOPPED, CONDITION_MET, *(cause.code for cause in engine.causes if not cause.is_failure)):
        checkpoint, before = Checkpoint.of(memory), records.n_passed
    hint = "" if pace is None else pace.hint(status)
    return Ending(status, interrupted, checkpoint, records.n_passed - before, hint, trouble)


def _is_met(until: Until, run: RunSoFar) -> bool:
    """Return whether a condition is met.

    Raises
    ------
    InvalidInput
        If what it returns is neither true nor false, such as an array.
    """
    answer = until(run)
    try:
        return bool(answer)
    except ValueError as error:
        rule = f"must return True or False, at t = {run.time:.9g} s"
        raise InvalidInput("run: until", rule, answer, "Reduce an array by numpy.any or numpy.all.") from error
