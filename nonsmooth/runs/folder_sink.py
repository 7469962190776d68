"""OutputSink and FolderSink: take the results of a run at its checkpoints, and write them to disk.

A run is written about twice a second, so that a process that dies loses at most the last second.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import final

from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.runs.records import Records
from nonsmooth.solution.solution import Solution
from nonsmooth.solution.state import State

_STEPS_PER_CALL = 2000
"""Steps of the engine per call if nothing is written: enough for the time of the call itself to be negligible."""


class OutputSink:
    """Base class of outputs, which receive the results of a run at its checkpoints.

    This class ignores the results: it serves a run whose results stay in memory. A derived class writes the results to
    a folder, from which another process can continue the run. The order of calls:

    1. ``begin`` with the checkpoint at the start of the run.
    2. ``write`` with each checkpoint, while the memory of the engine still has its content. ``write`` may copy the
       engine's buffers of events and samples and empty them.
    3. ``finish`` with the solution of the whole run.
    4. ``close`` at the end, also if the run or a call failed.
    """

    def steps(self) -> int:
        """Largest number of steps of the engine until the next call of ``write``."""
        return _STEPS_PER_CALL

    def begin(self, checkpoint: Checkpoint) -> None:
        """Write the start of the run.

        Raises
        ------
        FileError
            If the folder cannot be written to.
        """

    def write(self, checkpoint: Checkpoint) -> None:
        """Write the results up to a checkpoint, if the time for the next commit has come.

        Raises
        ------
        FileError
            If the folder cannot be written to.
        """

    def finish(self, solution: Solution) -> None:
        """Write the remaining results and the end of the run.

        Raises
        ------
        FileError
            If the folder cannot be written to.
        """

    def close(self) -> None:
        """Release files and threads."""


_COMMIT_INTERVAL = 0.5
"""Time from one commit to the next [s]. A commit then costs little compared with the run."""
_FIRST_COMMIT = 0.25
"""Time from the start to the first commit [s]. A run shorter than this is written once, at its end."""
_CALL_TIME = 0.15
"""Time that a call of the engine should take [s]: a fraction of the commit interval."""
_FEWEST_STEPS = 4
"""Least number of steps per call. Near the end time the engine pauses after fewer anyway."""
_FIRST_STEPS = 64
"""Number of steps of the first call, before the wall time of a step is known."""
_MOST_STEPS = 2000
"""Largest number of steps of the engine per call. A larger number saves no time."""
_LARGEST_SIZE = 1 << 25
"""Largest size of records in memory [bytes]: above it, they are written to the folder and then removed from memory."""


@final
@dataclass
class FolderSink(OutputSink):
    """Appends events and samples to a folder, with the state from which the run can be continued.

    Parameters
    ----------
    folder : SolutionFolder
        The folder.
    records : Records
        Events and samples that the engine has recorded.
    state_at : callable
        Makes the state of a checkpoint.
    wall : float
        Wall time of the run in earlier processes [s].
    """

    folder: SolutionFolder
    records: Records
    state_at: Callable[[Checkpoint], State]
    wall: float
    _steps: int = _FIRST_STEPS
    _start: float = field(default_factory=time.perf_counter)
    _last_call: float = field(default_factory=time.perf_counter)
    _next_commit: float = field(default_factory=lambda: time.perf_counter() + _FIRST_COMMIT)
    # the engine continues during a commit
    _thread: ThreadPoolExecutor = field(default_factory=lambda: ThreadPoolExecutor(1))
    _commit: Future[None] | None = None

    def steps(self) -> int:
        """Largest number of steps of the next call of the engine: about 0.15 s of them, less than a commit interval."""
        return self._steps

    def begin(self, checkpoint: Checkpoint) -> None:
        """Write the start of the run. The wall time of the first call of the engine counts from here."""
        self.folder.begin(*self.records.take_unwritten(), self.state_at(checkpoint), self.wall)
        self._last_call = time.perf_counter()

    def write(self, checkpoint: Checkpoint) -> None:
        """Start a commit of the new results, if it is time and the last commit has ended; adapt the steps per call."""
        now = time.perf_counter()
        records = self.records
        # the time of a call may be below the resolution of the clock; one fast call gives at most 4 times the steps
        wanted = self._steps * _CALL_TIME / max(now - self._last_call, 1e-6)
        self._steps = int(min(_MOST_STEPS, 4 * self._steps, max(_FEWEST_STEPS, wanted)))
        is_time = now >= self._next_commit and (self._commit is None or self._commit.done())
        # if the unwritten records become too large, the run waits for the disk instead of filling the memory
        if is_time or records.size(unwritten=True) > _LARGEST_SIZE:
            # raises the error of the last commit
            self._wait()
            if records.size(unwritten=False) > _LARGEST_SIZE:
                records.release(self.folder.stored())
            self._next_commit = now + _COMMIT_INTERVAL
            # the buffers hold results up to the checkpoint
            records.drain()
            state, wall = self.state_at(checkpoint), self.wall + now - self._start
            self._commit = self._thread.submit(self.folder.append, *records.take_unwritten(), state, wall)
        # the time of the next call is without that of this method
        self._last_call = time.perf_counter()

    def finish(self, solution: Solution) -> None:
        """Write the remaining results and the end of the run, after the last commit."""
        self._wait()
        self.folder.finish(*self.records.take_unwritten(), solution)

    def close(self) -> None:
        """Wait for the last commit, and release the folder."""
        self._thread.shutdown()
        self.folder.close()

    def _wait(self) -> None:
        """Wait for the last commit, which another thread writes, so that its error is raised here.

        Raises
        ------
        FileError
            If the last commit could not be written.
        """
        if self._commit is not None:
            self._commit.result()
