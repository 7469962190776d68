"""The loop that calls the engine, empties its buffers, and evaluates the user's functions.

The last step of a run ends at the end time, so its length depends on the end time. A run that is continued must not
contain such a step, or it would differ from a run that was not stopped. The engine therefore pauses before this step.
A checkpoint is taken there, and then the engine is called again to take the last steps. A continued run starts from
the checkpoint, and repeats the last steps.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, final

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.modes import Status
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Engine
from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.runs.engine_driver import UNLIMITED, EngineDriver
from nonsmooth.runs.folder_sink import OutputSink
from nonsmooth.runs.records import Records
from nonsmooth.runs.so_far import RunSoFar, Until
from nonsmooth.runs.stall_monitor import StallMonitor
from nonsmooth.storage.files import FileError

_CHECKPOINT_CALL = 16
"""Cost of the Python calls of a checkpoint, as a number of steps of 1 us, the shortest time of a step.

Near the end time a run takes so many steps without a new checkpoint. A continued run repeats them, which takes about as
long as a checkpoint.
"""
_COPIED = 1 << 13
"""Bytes of a checkpoint that are copied in 1 us, the shortest time of a step.

The size of a checkpoint divided by this number is the cost of its copy, as a number of steps.
"""
Progress = Callable[[float, float], None]


class Callbacks(NamedTuple):
    """Functions of the user that a run calls, each None if not given, and the largest number of steps.

    Attributes
    ----------
    progress : callable
        ``progress(time, t_end)`` [s], called repeatedly.
    until : callable
        ``until(run)``, the condition that ends the run.
    most_steps : int
        Number of steps after which the run is stopped.
    """

    progress: Progress | None
    until: Until | None
    most_steps: int = UNLIMITED


class LoopEnd(NamedTuple):
    """How the calls of an engine ended.

    Attributes
    ----------
    status : int
        Last status of the engine.
    is_interrupted : bool
        True if the user interrupted the run.
    checkpoint : Checkpoint
        Memory from which a continued run starts. It was copied before any step that is shortened to reach the end time.
    n_known_events : int
        Number of events after the checkpoint, which are recorded already.
    hint : str
        Sentence with the reason why a failed run stalled; "" if it is unknown.
    output_error : str
        Reason why results were lost; "" if no result was lost.
    """

    status: int
    is_interrupted: bool
    checkpoint: Checkpoint
    n_known_events: int
    hint: str
    output_error: str = ""


@final
@dataclass
class EngineLoop:
    """Calls an engine until a run ends.

    Parameters
    ----------
    engine : Engine
        The engine.
    model : LaidOut
        The model that runs.
    records : Records
        Takes events and samples.
    start : Checkpoint
        The checkpoint of the start, which the memory holds.
    sink : OutputSink
        Takes the results at checkpoints.
    callbacks : Callbacks
        Functions of the user.
    """

    engine: Engine
    model: LaidOut
    records: Records
    start: Checkpoint
    sink: OutputSink
    callbacks: Callbacks
    _n_calls: int = 0

    def __post_init__(self) -> None:
        """Begin with the start as the last checkpoint; a condition gets a view of the run so far."""
        self._checkpoint, self._n_events_before = self.start, self.records.n_events
        self._run_so_far = None if self.callbacks.until is None else RunSoFar(self.model, self.records, self.engine)

    def run(self) -> LoopEnd:
        """Run to the end time, to a failure, until a condition is met or the user interrupts.

        Raises
        ------
        InvalidInput
            If the engine breaks its contract, or ``until`` returns neither true nor false.
        BaseException
            An exception of ``progress`` or ``until``.
        """
        records = self.records
        # an engine may have codes of its own. A run that is cut off by an exception keeps this status
        status: int = Status.PAUSED
        is_interrupted, output_error = False, ""
        try:
            status = self._call_engine()
        except KeyboardInterrupt:
            records.drain()
            is_interrupted = True
            # the program continues after this as if the run had ended, so the user must see it
            text = f"interrupted at t = {self.model.memory[owners.Island.time]:.9g} s: the run returns what it has"
            print(f"{text}, with the status 'interrupted'", file=sys.stderr, flush=True)
        except FileError as error:
            records.drain()
            output_error = str(error)
        except MemoryError as error:
            # to drain takes memory; the records that were drained before are still there
            output_error = f"the memory ran out: {error}."
        if status == Status.DONE:
            records.check_complete(self.engine)
        records.add_last_sample()
        # these ends do not depend on the end time, so a continued run may start there
        if status in (Status.STOPPED, Status.CONDITION_MET, *(c.code for c in self.engine.causes if not c.is_failure)):
            self._take_checkpoint()
        n_known_events = records.n_events - self._n_events_before
        hint = "" if status == Status.DONE else self._monitor.hint(status)
        return LoopEnd(status, is_interrupted, self._checkpoint, n_known_events, hint, output_error)

    @functools.cached_property
    def _monitor(self) -> StallMonitor:
        """Monitor of the calls so far, made at its first use, because most short runs end in one call."""
        return StallMonitor(self.model, self.start)

    def _call_engine(self) -> int:
        """Call the engine until the run ends; the result is the status.

        Between two calls ``until`` is evaluated and ``progress`` is called. Within a long call the engine repeatedly
        calls the interrupt check of a watch. The watch reports the time to ``progress``, and turns Ctrl-C into a
        KeyboardInterrupt.
        """
        memory, progress = self.model.memory, self.callbacks.progress
        t_end = float(memory[owners.Request.t_end])
        report = None if progress is None else lambda t: progress(t, t_end)
        status: int = Status.PAUSED
        with self.model.watch.reporting(report) as watch:
            driver = EngineDriver(self.engine, self.model, watch.call, self.callbacks.most_steps)
            while status == Status.PAUSED:
                status = self._advance(driver)
                if status == Status.PAUSED and self._is_condition_met():
                    status = Status.CONDITION_MET
                if report is not None:
                    report(float(memory[owners.Island.time]))
        return status

    def _advance(self, driver: EngineDriver) -> int:
        """Call the engine once, or again if it paused, and drain its buffers; the result is the status.

        The first call pauses before a step that depends on the end time, so that a checkpoint can be taken. From there
        the second call takes at least one step.
        """
        run, records, sink = self._run_so_far, self.records, self.sink
        self._n_calls += 1
        before = None if run is None else run.reached
        # the sink wants a checkpoint after at most so many steps. A condition is evaluated at the start, before any
        # step, and after each step: no step at first, then one
        most_steps = sink.steps() if run is None else min(self._n_calls - 1, 1)
        status = driver.advance(most_steps, pauses_before_end=True)
        # a pause near the end looks like one after most_steps or with full buffers; but with a condition the engine,
        # which was to take one step, has then done nothing
        may_be_near_end = status == Status.PAUSED and (run is None or before == run.reached)
        # with a condition each call is one step, and not each gets a checkpoint
        if may_be_near_end or (status == Status.PAUSED and self._n_calls % sink.steps() == 0):
            self._take_checkpoint()
            sink.write(self._checkpoint)
        if may_be_near_end:
            if records.has_buffered:
                # an engine with full buffers takes no step
                self._monitor.observe(status)
                records.drain()
            # most_steps steps take about as long as a checkpoint; a run that continues from the checkpoint repeats them
            most_steps = max(_CHECKPOINT_CALL, self._checkpoint.size // _COPIED)
            status = driver.advance_past(self._checkpoint, most_steps if run is None else 1)
        # the monitor reads the buffers, so they are drained after it
        if status != Status.DONE:
            self._monitor.observe(status)
        records.drain()
        return status

    def _take_checkpoint(self) -> None:
        """Copy the memory, from which a continued run starts, and store the number of events until then."""
        self._checkpoint, self._n_events_before = Checkpoint.of(self.model.memory), self.records.n_events

    def _is_condition_met(self) -> bool:
        """True if there is a condition and it is met.

        Raises
        ------
        InvalidInput
            If it returns neither true nor false, such as an array.
        """
        until = self.callbacks.until
        if until is None or self._run_so_far is None:
            return False
        answer = until(self._run_so_far)
        try:
            return bool(answer)
        except ValueError as error:
            rule = f"must return True or False, at t = {self._run_so_far.time:.9g} s"
            raise InvalidInput("run: until", rule, answer, "Reduce an array by numpy.any or numpy.all.") from error
