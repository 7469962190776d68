"""Recorded: events and samples of a run as the engine left them, read when they are asked for."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.interfaces import Engine
from nonsmooth.solution.events import Events
from nonsmooth.solution.state import Floats, Integers

_NOTHING = np.zeros(0), np.zeros(0, np.int64), (0, 0, 0, 0)


@final
@dataclass(frozen=True, eq=False)
class Recorded:
    """What a run recorded.

    Attributes
    ----------
    rows : array
        Samples: time [s], all that is integrated, and the energies booked until then [J], shape [n, 1 + n_y + 4].
    engine : Engine
        What integrated the run.
    floats, integers : array
        Events in the engine's buffers.
    sizes : tuple of int
        Numbers of contacts, coordinates, velocities, and of all that is integrated.
    earlier : Events or None
        Events of the run before those.
    """

    rows: Floats
    engine: Engine
    floats: Floats
    integers: Integers
    sizes: tuple[int, int, int, int]
    earlier: Events | None = None

    def __repr__(self) -> str:
        """Return how much there is of it."""
        return f"Recorded({len(self.rows)} samples, {len(self.events)} events)"

    @classmethod
    def of(cls, events: Events, rows: Floats, engine: Engine) -> Recorded:
        """Return the record that has these events and samples."""
        return cls(rows, engine, *_NOTHING, events)

    @functools.cached_property
    def events(self) -> Events:
        """All events."""
        if self.earlier is not None and len(self.integers) == 0:
            return self.earlier
        found = Events.from_buffers(self.floats, self.integers, *self.sizes)
        return found if self.earlier is None else Events.joined([self.earlier, found])
