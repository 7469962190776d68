"""RunSoFar: a run up to now, as a condition that ends it sees it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias, final

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.interfaces import Engine
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.solution.events import Events
from nonsmooth.solution.state import Floats

if TYPE_CHECKING:
    from nonsmooth.runs.records import Records


@final
@dataclass(frozen=True)
class RunSoFar:
    """State and history of a run that is under way; the run makes it."""

    _model: LaidOut
    _records: Records
    _engine: Engine

    def __repr__(self) -> str:
        """Time, and numbers of events and impacts."""
        return f"RunSoFar(t = {self.time:.9g} s; {self.n_events} events, {self.n_impacts} impacts)"

    @property
    def time(self) -> float:
        """Time reached [s]."""
        return float(self._model.memory[owners.Island.time])

    @property
    def q(self) -> Floats:
        """Coordinates of all bodies, shape [n_q]."""
        return np.array(self._model.memory[owners.Island.y][: self._model.n_q])

    @property
    def u(self) -> Floats:
        """Velocities of all bodies, shape [n_u]."""
        n_q, n_u = self._model.n_q, self._model.n_u
        return np.array(self._model.memory[owners.Island.y][n_q : n_q + n_u])

    @property
    def n_events(self) -> int:
        """Number of events so far. The start is one of them."""
        return self._records.n_events

    @property
    def reached(self) -> tuple[float, int]:
        """Time reached [s] and number of events. Both are unchanged only if the engine did nothing."""
        return self.time, self.n_events

    @property
    def n_impacts(self) -> int:
        """Number of impacts so far in this run."""
        return int(self._model.memory[owners.Totals.n_impacts])

    @property
    def events(self) -> Events:
        """All events so far. The time to read them grows with their number."""
        return self._records.events()


Until: TypeAlias = Callable[[RunSoFar], bool]
"""A condition that ends a run; it is evaluated after each step and each event."""
