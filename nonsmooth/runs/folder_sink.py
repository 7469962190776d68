"""FolderSink: the keeper that writes a run to disk about twice a second."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import final

from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.runs.output_sink import OutputSink
from nonsmooth.runs.records import Records
from nonsmooth.solution.solution import Solution
from nonsmooth.solution.state import State

_EVERY, _FIRST_AFTER = 0.5, 0.25
"""Time from one commit to the next [s], and to the first one."""
_CALL = 0.15
"""Time that the engine shall take before the next look [s]."""
_FEWEST, _FIRST, _MOST = 4, 64, 2000
"""Steps before the next look."""


@final
@dataclass
class FolderSink(OutputSink):
    """Appends events and samples to a folder as they come, with the state from which the run goes on.

    Parameters
    ----------
    folder : SolutionFolder
        Where to.
    records : Records
        What the engine has recorded.
    state_at : callable
        From a checkpoint to the state from which the run goes on.
    wall : float
        Time that the run has taken before [s].
    """

    folder: SolutionFolder
    records: Records
    state_at: Callable[[Checkpoint], State]
    wall: float
    _steps: int = _FIRST
    _began: float = field(default_factory=time.perf_counter)
    _looked: float = field(default_factory=time.perf_counter)
    _next: float = field(default_factory=lambda: time.perf_counter() + _FIRST_AFTER)
    # the engine goes on while the disk is written to
    _pool: ThreadPoolExecutor = field(default_factory=lambda: ThreadPoolExecutor(1))
    _commit: Future[None] | None = None

    @property
    def steps(self) -> int:
        """As many as take a small part of a second."""
        return self._steps

    def begin(self, checkpoint: Checkpoint) -> None:
        """Write where the run begins."""
        self.folder.begin(*self.records.unwritten(), self.state_at(checkpoint), self.wall)
        self.records.written = self.records.n_parts
        self._looked = time.perf_counter()

    def keep(self, checkpoint: Checkpoint) -> None:
        """Have written what is new, if it is time to and the disk has come so far."""
        now = time.perf_counter()
        wanted = self._steps * _CALL / max(now - self._looked, 1e-6)
        self._steps = int(min(_MOST, 4 * self._steps, max(_FEWEST, wanted)))
        if now >= self._next and (self._commit is None or self._commit.done()):
            self._settle()
            self._next = now + _EVERY
            self.records.drain()
            n, (events, rows) = self.records.n_parts, self.records.unwritten()
            wall = self.wall + now - self._began
            self._commit = self._pool.submit(self.folder.append, events, rows, self.state_at(checkpoint), wall)
            self.records.written = n
        self._looked = time.perf_counter()

    def finish(self, solution: Solution) -> None:
        """Write the rest, and how the run ended."""
        self._settle()
        events, rows = self.records.unwritten()
        self.folder.finish(events, rows, solution)

    def close(self) -> None:
        """Wait until nothing is written any more, and let others write there."""
        self._pool.shutdown()
        self.folder.close()

    def _settle(self) -> None:
        """Wait for the last commit; raise what went wrong there."""
        if self._commit is not None:
            self._commit.result()
