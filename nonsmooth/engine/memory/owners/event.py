"""Numbers of one event."""

from __future__ import annotations

from typing import final

from nonsmooth.engine.memory.declare import FloatRow, IntegerRow, Life, Part, floats, integers, one_of, real, whole
from nonsmooth.engine.memory.modes import Truncation
from nonsmooth.engine.memory.sizes import fixed, per

_EVENT = Life.EVENT


@final
class Event(Part, key="event"):
    """Numbers of one event."""

    n_recorded: int = whole(_EVENT, "Number of records of the instant so far.")
    n_phases: int = whole(_EVENT, "Number of phases of the impact.")
    truncation: Truncation = one_of(Truncation, _EVENT, "How the impact ended if it was cut short.")
    slow_speed: float = real(_EVENT, "m/s", "Approach below which bounces are shorter than their contact time.")
    head: FloatRow = floats(_EVENT, fixed(5), "", "Time of the event and its energies.")
    u_before: FloatRow = floats(_EVENT, per(1, "n_u"), "", "Velocities before the event.")
    listed: IntegerRow = integers(_EVENT, per(1, "n_slots"), "Contacts that are recorded with the event.")
