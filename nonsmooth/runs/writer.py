"""Writer: the keeper that writes a run to disk about twice a second."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import final

from nonsmooth.model.image import Image
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.runs.keeper import Keeper
from nonsmooth.runs.records import Records
from nonsmooth.solution.solution import Solution
from nonsmooth.solution.state import State

_EVERY, _AT_MOST = 0.5, 0.8
"""Time between two commits [s]; what the disk makes of it."""
_SHARE = 0.05
"""Share of the time that commits may take before they come less often."""
_CALL = 0.15
"""Time that the engine shall take before the next look [s]."""
_FEWEST, _FIRST, _MOST = 4, 64, 2000
"""Steps before the next look."""


@final
@dataclass
class Writer(Keeper):
    """Appends events and samples to a folder as they come, with the state from which the run goes on.

    Parameters
    ----------
    folder : SolutionFolder
        Where to.
    records : Records
        What the engine has recorded.
    state_at : callable
        From an image to the state from which the run goes on.
    wall : float
        Time that the run has taken before [s].
    """

    folder: SolutionFolder
    records: Records
    state_at: Callable[[Image], State]
    wall: float
    _steps: int = _FIRST
    _began: float = field(default_factory=time.perf_counter)
    _looked: float = field(default_factory=time.perf_counter)
    _next: float = field(default_factory=lambda: time.perf_counter() + _EVERY)

    @property
    def steps(self) -> int:
        """As many as take a small part of a second."""
        return self._steps

    def begin(self, image: Image) -> None:
        """Write where the run begins."""
        self.folder.begin(*self.records.unwritten(), self.state_at(image))
        self.records.written = self.records.n_parts

    def keep(self, image: Image) -> None:
        """Write what is new, if it is time to."""
        now = time.perf_counter()
        wanted = self._steps * _CALL / max(now - self._looked, 1e-6)
        self._steps = int(min(_MOST, 4 * self._steps, max(_FEWEST, wanted)))
        if now >= self._next:
            self.records.drain()
            self._commit(image)
            after = time.perf_counter()
            self._next = after + min(max(_EVERY, (after - now) / _SHARE), _AT_MOST)
        self._looked = time.perf_counter()

    def finish(self, solution: Solution) -> None:
        """Write the rest, and how the run ended."""
        events, rows = self.records.unwritten()
        self.folder.finish(events, rows, solution)

    def _commit(self, image: Image) -> None:
        n, (events, rows) = self.records.n_parts, self.records.unwritten()
        self.folder.append(events, rows, self.state_at(image), self.wall + time.perf_counter() - self._began)
        self.records.written = n
