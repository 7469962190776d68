"""Track: the states that a run stored, whole, from which it is known at any time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.engine.memory.layout import BOOKED
from nonsmooth.interfaces import Engine
from nonsmooth.solution.state import Floats, State


@final
@dataclass(frozen=True, eq=False)
class Track:
    """The states at the samples and at the end of a run; those at events are with the events.

    Attributes
    ----------
    time : array
        [s], shape [n].
    y : array
        All that is integrated: coordinates, velocities, energies, inner states of laws; shape [n, n_y].
    booked : array
        Energies booked in events until then [J]: work of driven bodies, losses by restitution, friction and closing,
        shape [n, 4].
    engine : Engine
        What integrated the run, with its tolerances.
    """

    time: Floats
    y: Floats
    booked: Floats
    engine: Engine

    def __repr__(self) -> str:
        """Return of which times it is, and how much there is of it."""
        return f"Track({len(self.time)} states, {self.time[0]:.9g} to {self.time[-1]:.9g} s; {self.y.shape[1]} numbers)"

    @classmethod
    def of(cls, rows: Floats, state: State, engine: Engine) -> Track:
        """Return the track of a run: its samples, each time, y and what is booked, and the state in which it ended."""
        time, y, booked = np.split(np.vstack([rows, row_of(state)]), [1, rows.shape[1] - BOOKED], axis=1)
        return cls(time[:, 0], y, booked, engine)


def row_of(state: State) -> Floats:
    """Return a state as a sample; all of its energies are booked, but for those that are integrated only."""
    account = state.energy
    integrated = 0.0, 0.0, account.exchanged_in_flow, account.load_work
    booked = account.driven_work, account.restitution_loss, account.friction_loss, account.closing_loss
    return np.concatenate([[state.time], state.q, state.u, integrated, state.law_states, booked])
