"""Records: events and samples of a run, copied from the buffers of the engine.

The engine writes to buffers of fixed size. After each call they are copied and emptied. A copy is filed under the
number of the call, so that an interrupt within :meth:`Records.drain` neither loses nor repeats one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeAlias, final

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.event_rows import CLOSED_WITH, EVENT_HEAD, FACING, FEATURES, LISTED, SLIP_DIRECTION
from nonsmooth.engine.memory.layout import BOOKED
from nonsmooth.engine.memory.modes import AFTER, BEFORE, DURING, Cause, Mode
from nonsmooth.engine.memory.tables import places
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Engine
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.solution.events import Events
from nonsmooth.solution.recorded import Recorded, row_of
from nonsmooth.solution.state import Floats, Integers, State

StoredRecords: TypeAlias = tuple[Events, Callable[[], Floats]]
"""Records in an output folder: its events, and a function that reads its samples."""
_START_PART, _END_PART = -1, -2
"""Keys of the parts before the first call and after the last one. The others have the number of their call."""
_ROUND_OFF = 1e-9
"""Largest difference of two times that are taken as equal, relative to the sample interval."""
_ACCOUNTED = places("totals.driven_work", "totals.restitution_loss", "totals.friction_loss", "totals.closing_loss")
_ALWAYS = 1 << BEFORE | 1 << DURING | 1 << AFTER
"""Factor that turns the code of a mode into that of a contact with this mode before, during and after an event."""
_STICK_CODE, _SLIDE_CODE = 1, 5
"""Mode codes of a sticking contact (closed: 1) and of a sliding contact (closed and slipping: 1 + 4), Eq. (29)."""
_FILLED = places(
    "output.n_events", "output.n_samples", "output.floats_used", "output.integers_used", "output.last_floats"
).tolist()
_N_EVENTS, _N_SAMPLES, _N_FLOATS, _N_INTEGERS, _ = _FILLED
_N_CALLS, _N_KNOWN, _INDEX = places("run.n_calls", "request.n_known_events", "output.sample_index").tolist()
_T, _START, _INTERVAL, _NEXT, _RESOLUTION = places(
    "island.time", "request.sample_start", "request.sample_interval", "output.next_sample", "tolerance.time"
).tolist()


@final
@dataclass
class Records:
    """Events and samples of a run.

    Parameters
    ----------
    model : LaidOut
        The model that runs.
    stored : tuple, optional
        Events of the same run that are in its output folder and no longer in memory, and a function that reads the
        samples there.
    """

    model: LaidOut
    stored: StoredRecords | None = None
    # floats and integers of events, and samples
    _parts: dict[int, tuple[Floats, Integers, Floats]] = field(default_factory=dict)
    _n_drained: int = 0
    _n_taken: int = 0
    _n_released: int = 0

    @property
    def _width(self) -> int:
        """Number of floats of a sample: time, integrated state, and the energies accounted at instants."""
        return 1 + self.model.n_y + BOOKED

    @property
    def n_events(self) -> int:
        """Number of distinct events so far, those of earlier processes included.

        A continued run first repeats some recorded events. Until then the events still to be repeated are subtracted,
        so the number may be negative. The difference of two numbers is therefore always the number of events between
        two checkpoints.
        """
        _, integers = self.model.memory.cells
        stored = 0 if self.stored is None else len(self.stored[0])
        drained = self._n_drained - self._n_released
        return stored + drained + int(integers.item(_N_EVENTS) - integers.item(_N_KNOWN))

    @property
    def has_buffered(self) -> bool:
        """True if the buffers of the engine hold an event or a sample."""
        _, integers = self.model.memory.cells
        return bool(integers.item(_N_SAMPLES) > 0 or integers.item(_N_EVENTS) > 0)

    def drain(self) -> None:
        """Copy the buffers of the engine and empty them.

        The copy is stored under the number of the engine's last call. If an interrupt came after the copy, it exists
        already, and the buffers are only emptied.
        """
        memory, width = self.model.memory, self._width
        _, integers = memory.cells
        call, n_events, n_samples = integers.item(_N_CALLS), integers.item(_N_EVENTS), integers.item(_N_SAMPLES)
        # floats and integers of events, and samples, under the number of the call
        if call not in self._parts:
            self._parts[call] = (
                memory[owners.OutputNumbers.event_numbers][: integers.item(_N_FLOATS)].copy(),
                memory[owners.OutputNumbers.event_codes][: integers.item(_N_INTEGERS)].copy(),
                memory[owners.OutputNumbers.samples][: n_samples * width].reshape(n_samples, width).copy(),
            )
            self._n_drained += n_events
        # counters of the content of the buffers, and the place of the last event in them
        for place in _FILLED:
            integers[place] = 0

    def add_start(self, state: State) -> None:
        """Add a start event to a continued run, with the modes of its state.

        The engine records no event there, because the run has started before.
        """
        # floats of an event: time, four energies, q, u before and after, the rest of the integrated state, totals of
        # energies, and then numbers of the closed contacts. Impulses are 0. A state lacks two of these numbers. FACING,
        # the side (1 or -1) from which anisotropic friction is opposed, is set to 1. AVERAGED, the mode after the
        # time-stepping fallback, is left at 0, which is "open"
        closed = np.flatnonzero(state.modes != Mode.OPEN)
        codes = _ALWAYS * np.where(state.modes[closed] == Mode.SLIDE, _SLIDE_CODE, _STICK_CODE)
        head = np.zeros(EVENT_HEAD)
        # the energies of the event are zero
        head[0] = state.time
        contacts = np.zeros((len(closed), LISTED))
        contacts[:, SLIP_DIRECTION:CLOSED_WITH] = state.slip_directions[closed]
        contacts[:, CLOSED_WITH], contacts[:, FACING] = state.closing_rates[closed], 1.0
        contacts[:, FEATURES:] = state.features[closed]
        # a row has time, q and u first, then the rest of the integrated state and the totals of energies
        rest = row_of(state)[1 + len(state.q) + len(state.u) :]
        floats = np.concatenate([head, state.q, state.u, state.u, rest, contacts.ravel()])
        # cause, no contact, no phases, not truncated, number of contacts; then number and code of each contact
        numbers = np.column_stack([closed, codes]).ravel()
        integers = np.concatenate([[Cause.START, -1, 0, 0, len(closed)], numbers]).astype(np.int64)
        self._parts[_START_PART] = floats, integers, np.zeros((0, self._width))

    def check_complete(self, engine: Engine) -> None:
        """Check that an engine at the end time has recorded all samples, and the start if it records contacts.

        Raises
        ------
        InvalidInput
            If the engine left out a sample or the start, or recorded an event although it does not record contacts.
        """
        self._check_events(engine)
        floats, _ = self.model.memory.cells
        # time of the next sample [s]: it is after the end of the run if no sample is left out
        expected = floats.item(_NEXT)
        # a sample within round-off before the end may be left out, and so may one within the accuracy of times,
        # because a run that is shorter than that has no step
        if expected < floats.item(_T) - max(_ROUND_OFF * floats.item(_INTERVAL), floats.item(_RESOLUTION)):
            raise InvalidInput(
                f"{type(engine).__name__}.advance",
                "must append all samples up to the time reached",
                f"none for t = {expected:.9g} s",
                "Call begin_sample while ws.output.next_sample is not past the time reached.",
            )

    def _check_events(self, engine: Engine) -> None:
        """Check the events of a system with contacts: none, or one at the start; errors as :meth:`check_complete`."""
        if not self.model.system.contacts:
            return
        thing, start = f"{type(engine).__name__}.advance", self.model.memory.cells[0].item(_START)
        if self._n_drained > 0 and not engine.records_contacts:
            raise InvalidInput(
                thing,
                "must record no event of a system with contacts unless the engine records contacts",
                f"{self._n_drained} events",
                "Let records_contacts return True, and keep the mode and event_impulse of each contact.",
            )
        # the floats of an event begin with its time
        first = next((floats.item(0) for floats, _, _ in self._parts.values() if len(floats)), math.inf)
        # the records of a resumed run have the start event already (`stored`); any other run must record it now
        if self.stored is None and engine.records_contacts and first > start:
            raise InvalidInput(
                thing,
                "must record an event at the start, which holds the modes there",
                f"none before t = {first:.9g} s",
                f"Call record_event at t = {start:.9g} s.",
            )

    def add_last_sample(self) -> None:
        """Add a sample of the present state at the time reached, unless the last sample is there.

        So the end of a run, which need not be a multiple of the sample interval, is a sample, too.
        """
        memory, (floats, integers) = self.model.memory, self.model.memory.cells
        t, interval = floats.item(_T), floats.item(_INTERVAL)
        # the index of the next sample is 0 as long as there is none; the last one was an interval before the next
        if integers.item(_INDEX) > 0 and t - (floats.item(_NEXT) - interval) <= _ROUND_OFF * interval:
            return
        row = np.concatenate([[t], memory[owners.Island.y], floats[_ACCOUNTED]])
        self._parts[_END_PART] = np.zeros(0), np.zeros(0, np.int64), row[None]

    def joined(self, engine: Engine) -> Recorded:
        """Events and samples of the whole run, with those of an earlier process; ``engine`` integrated it."""
        floats, integers, samples = self._joined(0)
        if self.stored is None:
            return Recorded(samples, engine, floats, integers, self.model.sizes)
        events, read_rows = self.stored
        return Recorded(np.concatenate([read_rows(), samples]), engine, floats, integers, self.model.sizes, events)

    def events(self) -> Events:
        """All events so far."""
        floats, integers, _ = self._joined(0)
        found = Events.from_buffers(floats, integers, *self.model.sizes)
        return found if self.stored is None else Events.joined([self.stored[0], found])

    def take_unwritten(self) -> tuple[Events, Floats]:
        """Events and samples of the parts that no earlier call took, for the output folder; the parts are kept."""
        floats, integers, samples = self._joined(self._n_taken)
        self._n_taken = len(self._parts)
        return Events.from_buffers(floats, integers, *self.model.sizes), samples

    def size(self, *, unwritten: bool) -> int:
        """Size of the records in memory [bytes]; with ``unwritten``, only of those not yet taken for writing."""
        parts = list(self._parts.values())[self._n_taken if unwritten else 0 :]
        return sum(array.nbytes for part in parts for array in part)

    def release(self, stored: StoredRecords) -> None:
        """Free the records in memory that were written to disk; ``stored`` gives access to all written records."""
        before = 0 if self.stored is None else len(self.stored[0])
        for call in list(self._parts)[: self._n_taken]:
            del self._parts[call]
        self._n_taken, self._n_released = 0, self._n_released + len(stored[0]) - before
        self.stored = stored

    def _joined(self, first: int) -> tuple[Floats, Integers, Floats]:
        """Floats and integers of events, and samples, of the parts from number ``first`` on, in their order.

        A part has what one call of the engine recorded. A single part is not copied.
        """
        parts = list(self._parts.values())[first:]
        if len(parts) == 1:
            return parts[0]
        if not parts:
            return np.zeros(0), np.zeros(0, np.int64), np.zeros((0, self._width))
        floats, integers, samples = (np.concatenate(same) for same in zip(*parts, strict=True))
        return floats, integers, samples
