"""What the engine records, taken out of its buffers part by part."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import final

import numpy as np

from nonsmooth.engine.events.record import (
    CLOSED_WITH,
    EVENT_HEAD,
    FACING,
    FEATURES,
    LISTED,
    SLIP_DIRECTION,
)
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.layout import BOOKED
from nonsmooth.engine.memory.modes import AFTER, BEFORE, DURING, OPEN, SLIDE, START
from nonsmooth.engine.memory.tables import places
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Engine
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.solution.events import Events
from nonsmooth.solution.recorded import Recorded
from nonsmooth.solution.state import Floats, Integers, State
from nonsmooth.solution.track import row_of

_BEFORE_THE_FIRST, _BEHIND_THE_LAST = -1, -2
_ROUND_OFF = 1e-9
"""Part of the time between two samples below which a time is that of a sample."""
_BOOKED = places("totals.driven_work", "totals.restitution_loss", "totals.friction_loss", "totals.closing_loss")
_CODES = 1 << BEFORE | 1 << DURING | 1 << AFTER
_FILLED = places(
    "output.n_events", "output.n_samples", "output.floats_used", "output.integers_used", "output.last_floats"
).tolist()
_EVENTS, _SAMPLES, _FLOATS, _INTEGERS, _ = _FILLED
_CALLS, _TOLD, _INDEX = places("run.n_calls", "request.n_known_events", "output.sample_index").tolist()
_T, _START, _INTERVAL, _NEXT, _RESOLUTION = places(
    "island.time", "request.sample_start", "request.sample_interval", "output.next_sample", "tolerance.time"
).tolist()


@final
@dataclass
class Records:
    """Floats and integers of events, and samples, by the number of the engine's call.

    Parameters
    ----------
    model : LaidOut
        What runs.
    earlier : tuple
        Events and samples of the same run in another process, if it was cut off there.
    written : int
        Parts that need not be written any more.
    """

    model: LaidOut
    earlier: tuple[Events, Floats] | None = None
    written: int = 0
    _parts: dict[int, tuple[Floats, Integers, Floats]] = field(default_factory=dict)
    _events: int = 0

    @property
    def _width(self) -> int:
        return 1 + self.model.n_y + BOOKED

    @property
    def n_passed(self) -> int:
        """Events that the engine has recorded, less those that it has still to pass as told."""
        _, integers = self.model.memory.cells
        earlier = 0 if self.earlier is None else len(self.earlier[0])
        return earlier + self._events + int(integers.item(_EVENTS) - integers.item(_TOLD))

    @property
    def waiting(self) -> bool:
        """Whether the engine's buffers hold anything."""
        _, integers = self.model.memory.cells
        return bool(integers.item(_SAMPLES) > 0 or integers.item(_EVENTS) > 0)

    def drain(self) -> None:
        """Empty the engine's buffers.

        An interrupt may fall anywhere in here, and the next call then neither repeats nor loses anything.
        """
        memory, width = self.model.memory, self._width
        _, integers = memory.cells
        key, n_events, n_samples = integers.item(_CALLS), integers.item(_EVENTS), integers.item(_SAMPLES)
        if key not in self._parts:
            part = (
                memory[owners.Output.event_numbers][: integers.item(_FLOATS)].copy(),
                memory[owners.Output.event_codes][: integers.item(_INTEGERS)].copy(),
                memory[owners.Output.samples][: n_samples * width].reshape(n_samples, width).copy(),
            )
            self._events += n_events
            self._parts[key] = part
        for place in _FILLED:
            integers[place] = 0

    def begin_with(self, state: State) -> None:
        """Record the start of a run that goes on: its modes are those of the state."""
        closed = np.flatnonzero(state.modes != OPEN)
        codes = _CODES * np.where(state.modes[closed] == SLIDE, 5, 1)
        head = np.zeros(EVENT_HEAD)
        head[0] = state.time
        kept = np.zeros((len(closed), LISTED))
        kept[:, SLIP_DIRECTION:CLOSED_WITH] = state.slip_directions[closed]
        kept[:, CLOSED_WITH], kept[:, FACING] = state.closing_rates[closed], 1.0
        kept[:, FEATURES:] = state.features[closed]
        rest = row_of(state)[1 + len(state.q) + len(state.u) :]
        floats = np.concatenate([head, state.q, state.u, state.u, rest, kept.ravel()])
        listed = np.column_stack([closed, codes]).ravel()
        integers = np.concatenate([[START, -1, 0, 0, len(closed)], listed]).astype(np.int64)
        self._parts[_BEFORE_THE_FIRST] = floats, integers, np.zeros((0, self._width))

    def check_end(self, engine: Engine) -> None:
        """Look whether an engine that is at the end time has appended all samples and events that were due.

        Raises
        ------
        InvalidInput
            If a sample is missing, modes are not known from the start on, or an event would tell of modes that the
            engine does not record.
        """
        self._check_events(engine)
        floats, _ = self.model.memory.cells
        due = floats.item(_NEXT)
        # a run that is shorter than the accuracy of its times has no step
        if due < floats.item(_T) - max(_ROUND_OFF * floats.item(_INTERVAL), floats.item(_RESOLUTION)):
            raise InvalidInput(
                f"{type(engine).__name__}.advance",
                "must append all samples up to the time reached",
                f"none for t = {due:.9g} s",
                "Call begin_sample while ws.output.next_sample is not past the time reached.",
            )

    def _check_events(self, engine: Engine) -> None:
        if not self.model.system.contacts:
            return
        thing, start = f"{type(engine).__name__}.advance", self.model.memory.cells[0].item(_START)
        if self._events > 0 and not engine.records_contacts:
            raise InvalidInput(
                thing,
                "must record no event of a system with contacts unless the engine records contacts",
                f"{self._events} events",
                "Let records_contacts return True, and keep the mode and event_impulse of each contact.",
            )
        first = next((floats.item(0) for floats, _, _ in self._parts.values() if len(floats)), math.inf)
        if self.earlier is None and engine.records_contacts and first > start:
            raise InvalidInput(
                thing,
                "must record an event at the start, which holds the modes there",
                f"none before t = {first:.9g} s",
                f"Call record_event at t = {start:.9g} s.",
            )

    def end(self) -> None:
        """Add a sample of where the run ends, unless there is one."""
        memory, (floats, integers) = self.model.memory, self.model.memory.cells
        t, interval = floats.item(_T), floats.item(_INTERVAL)
        if integers.item(_INDEX) > 0 and t - (floats.item(_NEXT) - interval) <= _ROUND_OFF * interval:
            return
        row = np.concatenate([[t], memory[owners.Island.y][: self.model.n_y], floats[_BOOKED]])
        self._parts[_BEHIND_THE_LAST] = np.zeros(0), np.zeros(0, np.int64), row[None]

    @property
    def n_parts(self) -> int:
        """How many parts there are."""
        return len(self._parts)

    def joined(self, engine: Engine) -> Recorded:
        """Return what has been recorded of the whole run, which an engine integrated."""
        floats, integers, samples = self._joined(0)
        if self.earlier is None:
            return Recorded(samples, engine, floats, integers, self.model.sizes)
        events, rows = self.earlier
        return Recorded(np.concatenate([rows, samples]), engine, floats, integers, self.model.sizes, events)

    def unwritten(self) -> tuple[Events, Floats]:
        """Return events and samples of the parts that are not yet written."""
        floats, integers, samples = self._joined(self.written)
        return Events.from_buffers(floats, integers, *self.model.sizes), samples

    def _joined(self, first: int) -> tuple[Floats, Integers, Floats]:
        parts = list(self._parts.values())[first:]
        if len(parts) == 1:
            return parts[0]
        if not parts:
            return np.zeros(0), np.zeros(0, np.int64), np.zeros((0, self._width))
        floats, integers, samples = (np.concatenate(same) for same in zip(*parts, strict=True))
        return floats, integers, samples
