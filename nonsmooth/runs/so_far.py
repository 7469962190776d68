"""RunSoFar: what a run has done until now, for conditions that end it."""

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
    """Where a run is, and what happened in it; the run makes it."""

    _model: LaidOut
    _records: Records
    _engine: Engine

    def __repr__(self) -> str:
        """Return how far it is."""
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
        """Events so far, the start among them."""
        return self._records.n_passed

    @property
    def reached(self) -> tuple[float, int]:
        """Time [s] and events: they are as they were only if nothing was done."""
        return self.time, self.n_events

    @property
    def n_impacts(self) -> int:
        """Impacts so far in this run."""
        return int(self._model.memory[owners.Totals.n_impacts])

    @property
    def events(self) -> Events:
        """All events so far; to read them takes longer the more there are."""
        return self._records.joined(self._engine).events


Until: TypeAlias = Callable[[RunSoFar], bool]
"""A condition that ends a run, looked at after each step and each event."""
