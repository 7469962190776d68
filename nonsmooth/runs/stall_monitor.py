"""StallMonitor: finds a run whose time hardly passes, and what limits its steps.

Time hardly passes if each step is shorter than 1e-10 of the run. After ten thousand such steps in a row there is a
warning, because the run would take days. Steps and events are counted since time passed last: the counts of limits of
the steps, and the last events, name the option or the contact that makes the steps so short.
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import final

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.event_rows import CODE_HEAD
from nonsmooth.engine.memory.layout import N_ACCOUNTS
from nonsmooth.engine.memory.modes import CAUSES, LIMITS, Cause, Limit, Status
from nonsmooth.errors import NonsmoothWarning
from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.notices import warn

_SHORT_STEP = 1e-10
"""Length of a step relative to the run, below which time hardly passes. Such a run would take more than a day."""
_MANY_STEPS = 10_000
"""Number of short steps in a row that cause the warning. A few may follow an event."""
_N_LAST_EVENTS = 200
"""Number of last events that are counted. They show which contacts recur."""
_N_NAMED = 3
"""Largest number of contacts, events or limits that a message names."""
_REMEDY = "Try a lower restitution, a compliant law or more room between these bodies."
_STATUSES_AT_AN_INSTANT = (Status.IMPACT_ENDLESS, Status.NO_CONTACT_SOLUTION, Status.UPDATE_ENDLESS)
"""Statuses of runs that failed in the contact problems of one instant."""

_Event = tuple[int, int]
"""Cause, and contact or guard."""


class TimeHardlyPasses(NonsmoothWarning):
    """The steps of a run have become so short that it would take days. The message names what limits them."""


@final
@dataclass
class StallMonitor:
    """Compares the progress of a run in time with its number of steps, after each call of the engine.

    Parameters
    ----------
    model : LaidOut
        The model that runs.
    start : Checkpoint
        The checkpoint of the start.
    """

    model: LaidOut
    start: Checkpoint
    _last_events: deque[_Event] = field(default_factory=lambda: deque(maxlen=_N_LAST_EVENTS))
    # number and sum [s] of the steps shorter than the limit since the last longer one
    _n_short: int = 0
    _short_time: float = 0.0
    _has_warned: bool = False

    def __post_init__(self) -> None:
        """Begin to count at the start: time [s], and number of steps that each cause has limited so far.

        The counts "before" are those at which time passed last.
        """
        self._t = self._t_start = float(self.start[owners.Island.time])
        self._n_limited = self._n_limited_before = self.start[owners.Totals.n_steps_limited]

    def observe(self, status: int) -> None:
        """Count steps and events of the last call of the engine, which ended with a status.

        Its buffers must not be drained yet. Steps since time passed last: ``_n_short`` is their number, ``_short_time``
        their time [s]; ``_n_limited_before`` are the counts of limits when they began.

        Warns
        -----
        TimeHardlyPasses
            If time hardly passes, once in a run.
        """
        memory, t_before = self.model.memory, self._t
        t, n_limited = float(memory[owners.Island.time]), memory[owners.Totals.n_steps_limited].copy()
        # each step is counted under one cause
        n_steps = int(np.sum(n_limited - self._n_limited))
        self._t, self._n_limited = t, n_limited
        # time passes if the mean length of the new steps is not short
        passes = t - t_before > _SHORT_STEP * n_steps * (float(memory[owners.Request.t_end]) - self._t_start)
        if passes:
            self._n_short, self._short_time, self._n_limited_before = 0, 0.0, n_limited
            self._last_events.clear()
        # the events of a call that ended in a failure are counted in any case, for the hint
        if not passes or status not in (Status.PAUSED, Status.DONE, Status.STOPPED, Status.CONDITION_MET):
            self._last_events.extend(self._new_events())
            self._n_short, self._short_time = self._n_short + n_steps, self._short_time + t - t_before
        if self._n_short >= _MANY_STEPS and not self._has_warned:
            self._has_warned = True
            text = f"At t = {t:.9g} s time hardly passes: {self._remaining(t)} {self._limited_by()}"
            # the warning names the line that called Model.run
            warn(text, TimeHardlyPasses)

    def hint(self, status: int) -> str:
        """Sentences for the message of a failed run: its last events, errors or contacts, by the status of its end.

        "" for a status about which the monitor knows nothing.
        """
        if status == Status.STALLED:
            return f"{self._counted_events()} {_REMEDY}"
        if status == Status.STEP_TOO_SMALL:
            return f"{_largest_error(self.model)} {self._counted_events()}".strip()
        return _last_contacts(self.model) if status in _STATUSES_AT_AN_INSTANT else ""

    def _new_events(self) -> Iterable[_Event]:
        """Cause, and contact or guard, of the events that the buffers of the engine hold.

        The integers of an event are a head, which ends with a number of contacts, and two for each of these contacts.
        """
        memory = self.model.memory
        codes = memory[owners.OutputNumbers.event_codes][: int(memory[owners.OutputNumbers.integers_used])].tolist()
        # the head begins with the cause of the event, and its contact or guard
        at = 0
        while at < len(codes):
            yield codes[at], codes[at + 1]
            at += CODE_HEAD + 2 * codes[at + CODE_HEAD - 1]

    def _remaining(self, t: float) -> str:
        """Sentence with the mean length of the steps since time passed last, and the number remaining from ``t`` [s].

        It is meant for steps below 1e-10 of the run: at some ten microseconds each, 1e10 steps take days.
        """
        t_end, step = float(self.model.memory[owners.Request.t_end]), self._short_time / self._n_short
        # a step of length 0 is an event at the time reached
        far = f"would take {(t_end - t) / step:.1g} of them, that is days" if step > 0.0 else "is out of reach"
        return f"the steps are {step:.2g} s long (mean of the last {self._n_short}); t_end = {t_end:.9g} s {far}."

    def _limited_by(self) -> str:
        """Sentences with the limits of the steps since time passed last, most frequent first, and the last events.

        If the most frequent limit is the error, a sentence names the coordinate whose error is largest.
        """
        counts = self._n_limited - self._n_limited_before
        ranked = [i for i in np.argsort(-counts, kind="stable").tolist() if counts[i] > 0][:_N_NAMED]
        limits = ", ".join(f"{LIMITS[i]} ({counts[i]})" for i in ranked)
        error = _largest_error(self.model) if ranked[:1] == [Limit.ERROR] else ""
        # without the second space if there is no sentence on the error
        return " ".join(f"The steps were limited by: {limits}. {error} {self._counted_events()}".split())

    def _counted_events(self) -> str:
        """Sentence with the most frequent of the last events and their numbers, or "" if there are none."""
        # an event is its cause, and its contact or guard
        counted = Counter(event for event in self._last_events if event[0] != Cause.START)
        if not counted:
            return ""
        named = [f"{self._words(*event)} ({n})" for event, n in counted.most_common(_N_NAMED)]
        return f"The last {counted.total()} events are: {_enumeration(named, len(counted))}."

    def _words(self, cause: int, which: int) -> str:
        """An event in words. ``which`` is the number of its contact or guard; -1 for an event of neither."""
        names = self.model.system.names
        of_kind = names.guards if cause == Cause.GUARD else names.contacts
        return f"{CAUSES[cause]} of {of_kind[which]!r}" if which >= 0 else CAUSES[cause]


def _largest_error(model: LaidOut) -> str:
    """Sentence that names the coordinate, velocity or inner state with the largest relative error of the last step.

    The integrator writes the error of a step over the state of a stage. That of a rejected step is still there.
    """
    memory, n = model.memory, model.n_y
    # a tolerance is relative to the size of a number plus a scale, which counts if the number is small
    error, scale, y = (memory[one] for one in (owners.Step.y_stage, owners.Step.y_scale, owners.Island.y))
    size = scale + np.abs(y)
    relative = np.divide(np.abs(error), size, out=np.zeros(n), where=size > 0.0)
    # the energy accounts do not limit steps
    relative[model.n_q + model.n_u :][:N_ACCOUNTS] = 0.0
    worst = int(np.argmax(np.nan_to_num(relative, nan=np.inf)))
    # q of all bodies comes first, then u of all, then the inner states; worst counts on from each body
    for letter, count in (("q", "n_q"), ("u", "n_u")):
        for name, body in zip(model.system.names.bodies, model.system.bodies, strict=True):
            if worst < getattr(body, count):
                return f"The error is largest in {letter}[{worst}] of the body {name!r}."
            worst -= getattr(body, count)
    return "The error is largest in an inner state of a friction law."


def _last_contacts(model: LaidOut) -> str:
    """Sentence that names the contacts whose forces or impulses were to be solved for last, or "" without any."""
    memory = model.memory
    in_problem = memory[owners.Problem.active][: int(memory[owners.Problem.n_active])]
    numbers = model.active[in_problem].tolist()
    if not numbers:
        return ""
    names = model.system.names.contacts
    return f"In contact are {_enumeration([repr(names[i]) for i in numbers[:_N_NAMED]], len(numbers))}."


def _enumeration(words: list[str], total: int) -> str:
    """The words as a list for a sentence: "a, b, 3 others" if there are more words, ``total`` in all."""
    more = [f"{total - len(words)} others"] if total > len(words) else []
    return ", ".join([*words, *more])
