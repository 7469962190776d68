"""Replay of a run: its model, set to the state at any time of the run.

A run stores its states at samples and events. For a state between two of them, the engine integrates from the stored
state before to the requested time. Forces and gaps are then read from the memory of the model.
"""

from __future__ import annotations

import functools
import threading
import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, final

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.event_rows import AVERAGED, CLOSED_WITH, FACING, FEATURES, SLIP_DIRECTION
from nonsmooth.engine.memory.modes import AFTER, CODE, REASONS, Mode, Status
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.errors import InvalidInput, RunFailed
from nonsmooth.histories.arrays import Floats, Integers
from nonsmooth.model.assembly import lay
from nonsmooth.model.declared import DeclaredContacts, remember, searched
from nonsmooth.model.laid_out import LaidOut

if TYPE_CHECKING:
    from nonsmooth.interfaces import Engine
    from nonsmooth.solution.recorded import Track
    from nonsmooth.solution.solution import Solution
    from nonsmooth.system.system import System

_ACCOUNTED = (
    owners.Totals.driven_work,
    owners.Totals.restitution_loss,
    owners.Totals.friction_loss,
    owners.Totals.closing_loss,
)
_MODES = np.array([Mode.OPEN, Mode.STICK, Mode.OPEN, Mode.OPEN, Mode.OPEN, Mode.SLIDE, Mode.OPEN, Mode.OPEN])
"""Mode of a contact; the index is the sum of its bits closed 1, approaching 2, slipping 4 (Eq. (29) of the paper)."""
_DIRECTION, _RATE, _FACING, _AVERAGED, _FEATURES = (
    place - SLIP_DIRECTION for place in (SLIP_DIRECTION, CLOSED_WITH, FACING, AVERAGED, FEATURES)
)
"""First columns in ``Events.listed_memory`` of five quantities.

In this order: slip direction, rate of the last closing [m/s], slip direction that an oriented law faces, mode after the
time-stepping fallback, features.
"""
_SAMPLE, _EVENT, _END = range(3)
_REPLAYS: weakref.WeakKeyDictionary[Track, StateReplay] = weakref.WeakKeyDictionary()


def replay_of(solution: Solution) -> StateReplay:
    """Replay of a run; each run has one, made at the first call."""
    if solution.track not in _REPLAYS:
        _REPLAYS[solution.track] = StateReplay(solution)
    return _REPLAYS[solution.track]


def check_recorded(where: str, what: str, system: System, engine: Engine) -> None:
    """Check that an engine records modes and impulses of contacts.

    Without records, zeros would wrongly mean open contacts.

    Raises
    ------
    InvalidInput
        The system has contacts, but the engine does not record their modes and impulses.
    """
    if system.contacts and not engine.records_contacts:
        raise InvalidInput(
            f"{where}: {what} of contacts",
            "are known only of engines that record contacts",
            engine,
            "Run with nonsmooth.EventDriven(), or let records_contacts of the engine return True and record events.",
        )


@final
class StateReplay:
    """Stored states of a run in the order of time, and a model that integrates from them to other times.

    If several states are stored for one time, the state after the last event at this time is used.
    """

    def __init__(self, solution: Solution) -> None:
        track, events = solution.track, solution.events
        self._system, self._engine, self._events = solution.system, track.engine, events
        at_events = np.hstack([events.q, events.u_after, events.integrated])
        kind = np.full(len(track.time), _SAMPLE)
        kind[-1] = _END
        kinds = np.concatenate([kind, np.full(len(events), _EVENT)])
        time = np.concatenate([track.time, events.time])
        order = np.lexsort((kinds, time))
        self._time, self._y = time[order], np.concatenate([track.y, at_events])[order]
        self._booked = np.concatenate([track.booked, events.booked])[order]
        self._event = np.cumsum(kinds[order] == _EVENT) - 1
        self._event_row = np.flatnonzero(kinds[order] == _EVENT)
        # number of the event after which the contacts had the modes that the model has now; -1 for the modes before
        # event 0, -2 for modes that belong to no event
        self._put_event = -2
        self._alone = threading.Lock()

    @functools.cached_property
    def laid(self) -> LaidOut:
        """Model of the system, made at the first use.

        Raises
        ------
        InvalidInput
            The system has changed since the run.
        """
        laid = lay(self._system, self._engine)
        found, ran = (laid.n_y, len(self._system.contacts)), (self._y.shape[1], self._events.n_contacts)
        if found != ran:
            rule = f"must be as it ran, with {ran[0]} numbers of a state and {ran[1]} contacts"
            raise InvalidInput("solution.system", rule, found, "Make a system of its own for what is to differ.")
        return laid

    @property
    def is_flow(self) -> bool:
        """True if forces, and states between the stored ones, can be computed."""
        recorded = self._engine.records_contacts or not self._system.contacts
        return recorded and self._engine.uses_flow

    def codes(self, times: Floats) -> Integers:
        """Codes of all contacts after the last event of each time, shape [n, n_contacts].

        A code is a sum of bits, Eq. (29) of the paper: closed 1, approaching 2, slipping 4.
        """
        return self._events.codes_after(self._event[self._row(times)])

    def modes(self, times: Floats) -> Integers:
        """Modes of all contacts, 0 open, 1 stick, 2 slide, after the last event at or before each time.

        The shape is [n, n_contacts].
        """
        return np.asarray(_MODES[self.codes(times)])

    def closed(self, times: Floats) -> Integers:
        """Indices of the times at which at least one contact of the system is closed."""
        events = self._events
        modes = _MODES[events.codes >> AFTER & CODE]
        closing = np.repeat(np.arange(len(events)), np.diff(events.first))[modes != Mode.OPEN]
        return np.flatnonzero(np.isin(self._event[self._row(times)], closing))

    def states(self, times: Floats) -> Floats:
        """Integrated states at times: q, u, energy accounts and inner states of laws, shape [n, n_y]."""
        rows = self._row(times)
        found = self._y[rows]
        between = np.flatnonzero(self._time[rows] < times)
        if len(between) > 0:

            def keep(i: int) -> None:
                found[between[i]] = self.laid.memory[owners.Island.y][: self.laid.n_y]

            self.visit(times[between], keep, forces=False)
        return found

    def visit(self, times: Floats, look: Callable[[int], None], *, forces: bool = True) -> None:
        """Call ``look(i)`` while the model has the state at ``times[i]``, in the order of time.

        With ``forces``, bodies, closed contacts and joints are evaluated before each call.

        Raises
        ------
        InvalidInput
            Forces, or states between the stored ones, are needed, but :attr:`is_flow` is False.
        RunFailed
            The integration from a stored state fails.
        """
        rows, here = self._row(times), -1
        if forces and self._system.contacts:
            # check this even if no closed contact is recorded: an engine without forces may record no contacts at all
            self._check_flow("with its forces")
        if len(times) == 0:
            return
        between = bool(np.any(self._time[rows] < times))
        if not (between or forces):
            self._visit_stored(rows, look)
            return
        self._check_flow("between its samples" if between else "with its forces")
        memory = self.laid.memory
        # clear the flags that an interrupted earlier call of this method has left
        memory[owners.Request.is_interrupted], memory[owners.Run.failure] = 0, Status.RUNNING
        with self._alone, self.laid.watch as watch:
            for i in np.argsort(times, kind="stable").tolist():
                if rows[i] != here:
                    here = int(rows[i])
                    self._put(here)
                status = int(watch.call("follow", float(times[i])))
                if status != Status.RUNNING:
                    raise RunFailed(f"What led to t = {times[i]:.9g} s is not found again: {REASONS[Status(status)]}.")
                if forces:
                    watch.call("evaluate_forces", 0)
                look(i)

    def visit_near(self, times: Floats, states: Floats, look: Callable[[int], None]) -> None:
        """For each time, set the model to the state, list and evaluate the contacts of near bodies, and call ``look``.

        ``look(i)`` reads the model at ``times[i]``.  ``states`` is the result of :meth:`states` at the times.
        """
        memory = self.laid.memory
        with self._alone:
            # `_put_event` is the event whose modes the model has. Neighbour list and modes are set anew for each time
            # here. With -2 (no event), the next `_put` sets the modes again
            self._put_event = -2
            for i, row in enumerate(self._row(times).tolist()):
                memory[owners.Island.time], memory[owners.Island.y] = times[i], states[i]
                self._put_modes(int(self._event[row]))
                self.laid.evaluate()
                look(i)

    def _visit_stored(self, rows: Integers, look: Callable[[int], None]) -> None:
        with self._alone:
            # `_put_event` is the event whose modes the model has. Only states are set here, no modes: those of an
            # earlier event remain and do not fit. With -2 (no event), the next `_put` sets the modes again
            self._put_event = -2
            for i, row in enumerate(rows.tolist()):
                self._put_state(row)
                look(i)

    def _check_flow(self, what: str) -> None:
        if not self.is_flow:
            raise InvalidInput(
                "Solution",
                f"is known {what} only where the engine records contacts and uses the flow of nonsmooth.engine",
                self._engine,
                "States, poses and energies are known at the times of samples and events; for more, run with "
                "nonsmooth.EventDriven().",
            )

    def _row(self, times: Floats) -> Integers:
        """Index of the last stored state at or before each time."""
        return np.searchsorted(self._time, times, side="right") - 1

    def _put(self, row: int) -> None:
        """Set the model to a stored state, with the modes after the last event before it."""
        event = int(self._event[row])
        if event != self._put_event:
            self._put_event = -2
            self._put_state(int(self._event_row[event]) if event >= 0 else row)
            self._put_modes(event)
            call_entry("evaluate_forces", self.laid.memory, 1)
            self._put_event = event
        self._put_state(row)

    def _put_state(self, row: int) -> None:
        memory = self.laid.memory
        memory[owners.Island.time] = self._time[row]
        for total, value in zip(_ACCOUNTED, self._booked[row].tolist(), strict=True):
            memory[total] = value
        memory[owners.Island.y][:] = self._y[row]

    def _put_modes(self, event: int) -> None:
        """Make the neighbour list, and give each contact the mode and the slip direction that it had after an event."""
        memory, events, n = self.laid.memory, self._events, self._events.n_contacts
        contact = owners.ContactRecord
        listed = slice(*events.first[event : event + 2].tolist()) if event >= 0 else slice(0)
        numbers, kept = events.listed[listed], events.listed_memory[listed]
        states = {
            contact.mode: _MODES[events.codes[listed] >> AFTER & CODE],
            contact.mode_after_averaging: kept[:, _AVERAGED],
            contact.direction: kept[:, _DIRECTION:_RATE],
            contact.closing_rate: kept[:, _RATE],
        }
        # zeros make a contact search for its features again; closed contacts get back their features at the event
        memory.floats[searched(memory)[1]] = 0.0
        places = DeclaredContacts.of(memory, numbers)[contact.features]
        for place, features in zip(places.tolist(), kept[:, _FEATURES:], strict=True):
            if place > 0:
                memory.floats[place : place + len(features)] = features
        self.laid.reserve(len(numbers))
        remember(memory, numbers, states)
        self.laid.list_contacts()
        slots = int(memory[owners.Island.n_contacts])
        facing = np.ones(n)
        facing[numbers] = kept[:, _FACING]
        memory[owners.ContactRecord.facing][:slots] = facing[memory[owners.ContactRecord.declared][:slots]]
