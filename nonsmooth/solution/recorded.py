"""Records of a run: its samples and events as the engine recorded them, and its stored states."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.engine.memory.layout import BOOKED
from nonsmooth.interfaces import Engine
from nonsmooth.solution.events import Events
from nonsmooth.solution.state import Floats, Integers, State

_NOTHING = np.zeros(0), np.zeros(0, np.int64), (0, 0, 0, 0)


@final
@dataclass(frozen=True, eq=False)
class Recorded:
    """Samples and events of a run; the events are read from the buffers of the engine at the first use.

    Attributes
    ----------
    rows : array
        Samples: time [s], integrated state, and the energies accounted at events so far [J]; shape
        [n, 1 + n_y + 4].
    engine : Engine
        The engine that integrated the run.
    floats, integers : array
        Events in the engine's buffers.
    sizes : tuple of int
        Numbers of contacts, coordinates, velocities, and entries of the integrated state.
    earlier : Events or None
        Events of an earlier part of the run.
    """

    rows: Floats
    engine: Engine
    floats: Floats
    integers: Integers
    sizes: tuple[int, int, int, int]
    earlier: Events | None = None

    def __repr__(self) -> str:
        """Numbers of samples and events."""
        return f"Recorded({len(self.rows)} samples, {len(self.events)} events)"

    @classmethod
    def of(cls, events: Events, rows: Floats, engine: Engine) -> Recorded:
        """Record of given events and samples."""
        return cls(rows, engine, *_NOTHING, events)

    @functools.cached_property
    def events(self) -> Events:
        """All events."""
        if self.earlier is not None and len(self.integers) == 0:
            return self.earlier
        found = Events.from_buffers(self.floats, self.integers, *self.sizes)
        return found if self.earlier is None else Events.joined([self.earlier, found])


@final
@dataclass(frozen=True, eq=False)
class Track:
    """Stored states at the samples and at the end of a run; the states at events are in :class:`Events`.

    Attributes
    ----------
    time : array
        Times [s], shape [n].
    y : array
        Integrated states: coordinates, velocities, energies, inner states of laws; shape [n, n_y].
    booked : array
        Energies accounted at events so far [J]: work of driven bodies, losses by restitution, friction and closing
        steps; shape [n, 4].
    engine : Engine
        The engine that integrated the run.
    """

    time: Floats
    y: Floats
    booked: Floats
    engine: Engine

    def __repr__(self) -> str:
        """Number of states, times, and length of a state."""
        return f"Track({len(self.time)} states, {self.time[0]:.9g} to {self.time[-1]:.9g} s; {self.y.shape[1]} numbers)"

    @classmethod
    def of(cls, rows: Floats, state: State, engine: Engine) -> Track:
        """Track of the samples and the final state of a run."""
        time, y, booked = np.split(np.vstack([rows, row_of(state)]), [1, rows.shape[1] - BOOKED], axis=1)
        return cls(time[:, 0], y, booked, engine)


def row_of(state: State) -> Floats:
    """Row of a state in the form of a sample, shape [1 + n_y + 4].

    A sample has the work of driven bodies, the friction loss and the closing loss as two numbers: the integrated part,
    and the part accounted at events.  A state has only the sum of both.  In the row, the integrated part is zero, and
    the part at events is the sum.
    """
    account = state.energy
    integrated = 0.0, 0.0, account.exchanged_in_flow, account.load_work, 0.0
    booked = account.driven_work, account.restitution_loss, account.friction_loss, account.closing_loss
    return np.concatenate([[state.time], state.q, state.u, integrated, state.law_states, booked])
