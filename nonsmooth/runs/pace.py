"""Whether time passes while a model runs, and what holds it up: a limit of the steps, a body, contacts."""

from __future__ import annotations

import warnings
from collections import Counter, deque
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import final

import numpy as np

from nonsmooth.engine.events.record import CODE_HEAD
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.layout import N_ACCOUNTS
from nonsmooth.engine.memory.limits import LIMITS, Limit
from nonsmooth.engine.memory.modes import (
    CAUSES,
    DONE,
    GUARD,
    IMPACT_ENDLESS,
    NO_CONTACT_SOLUTION,
    PAUSED,
    STALLED,
    START,
    STEP_TOO_SMALL,
    STOPPED,
    UPDATE_ENDLESS,
)
from nonsmooth.errors import NonsmoothWarning
from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.model.laid_out import LaidOut

_HARDLY = 1e-10
"""Part of a run that its steps take at least; with shorter ones it would not end within a day."""
_LONG = 10_000
"""So many of those in a row are told."""
_LAST = 200
_NAMED = 3
_REMEDY = (
    "A law that loses more in these contacts (a lower restitution), one that is compliant, or more room between the "
    "bodies may help, or an engine that does not stop at every event."
)
_AT_ONE_INSTANT = (IMPACT_ENDLESS, NO_CONTACT_SOLUTION, UPDATE_ENDLESS)

_Event = tuple[int, int]
"""Cause and contact, or guard."""


class TimeHardlyPasses(NonsmoothWarning):
    """A run whose steps have become so short that it would take days: which limit and which contacts make them so."""


@final
@dataclass
class Pace:
    """Follows a run from one stop of the engine to the next.

    Parameters
    ----------
    model : LaidOut
        What runs.
    begun : Checkpoint
        What its memory held as the run began.
    """

    model: LaidOut
    begun: Checkpoint
    _last: deque[_Event] = field(default_factory=lambda: deque(maxlen=_LAST))
    _passes: int = 0
    _passed: float = 0.0
    _told: bool = False

    def __post_init__(self) -> None:
        self._t = self._begun = float(self.begun[owners.Island.time])
        self._limits = self._since = self.begun[owners.Totals.n_steps_limited][: len(LIMITS)]

    def look(self, status: int) -> None:
        """Look at what the engine has done since the last look, before its buffers are emptied; it came to a status.

        Warns
        -----
        TimeHardlyPasses
            Once in a run, if time hardly passes.
        """
        (t, limits), before = self._now(), self._t
        passes = int(np.sum(limits - self._limits))
        self._t, self._limits = t, limits
        passing = t - before > _HARDLY * passes * (float(self.model.memory[owners.Request.t_end]) - self._begun)
        if passing:
            self._passes, self._passed, self._since = 0, 0.0, limits
            self._last.clear()
        if not passing or status not in (PAUSED, DONE, STOPPED):
            self._last.extend(self._new_events())
            self._passes, self._passed = self._passes + passes, self._passed + t - before
        if self._passes >= _LONG and not self._told:
            self._told = True
            text = f"At t = {t:.9g} s time hardly passes: {self._far_off(t)} {self._held_up()}"
            warnings.warn(text, TimeHardlyPasses, stacklevel=5)

    def hint(self, status: int) -> str:
        """Return a sentence on what a run failed at that ended with a status, "" if there is nothing to tell."""
        if status == STALLED:
            return f"{self._of_events()} {_REMEDY}"
        if status == STEP_TOO_SMALL:
            return f"{_of_error(self.model)} {self._of_events()}".strip()
        return _involved(self.model) if status in _AT_ONE_INSTANT else ""

    def _now(self) -> tuple[float, np.ndarray]:
        memory = self.model.memory
        return float(memory[owners.Island.time]), memory[owners.Totals.n_steps_limited][: len(LIMITS)].copy()

    def _new_events(self) -> Iterable[_Event]:
        memory = self.model.memory
        codes = memory[owners.Output.event_codes][: int(memory[owners.Output.integers_used])].tolist()
        at = 0
        while at < len(codes):
            yield codes[at], codes[at + 1]
            at += CODE_HEAD + 2 * codes[at + CODE_HEAD - 1]

    def _far_off(self, t: float) -> str:
        """Return a sentence on how many steps as long as the last ones are left."""
        t_end, step = float(self.model.memory[owners.Request.t_end]), self._passed / self._passes
        left = f"is {(t_end - t) / step:.1g} steps away, which take days" if step > 0.0 else "is out of reach"
        return f"with steps of {step:.2g} s, as the last {self._passes} are on average, t_end = {t_end:.9g} s {left}."

    def _held_up(self) -> str:
        counts = self._limits - self._since
        ranked = [i for i in np.argsort(-counts, kind="stable").tolist() if counts[i] > 0][:_NAMED]
        limits = ", ".join(f"{LIMITS[i]} ({counts[i]})" for i in ranked)
        error = _of_error(self.model) if ranked[:1] == [Limit.ERROR] else ""
        text = f"They were limited by: {limits}. {error} {self._of_events()}"
        return " ".join(text.split())

    def _of_events(self) -> str:
        names = self.model.system.names
        counted = Counter(event for event in self._last if event[0] != START)
        if not counted:
            return ""
        named = [
            f"{CAUSES[cause]} of {(names.guards if cause == GUARD else names.contacts)[i]!r} ({n})"
            for (cause, i), n in counted.most_common(_NAMED)
        ]
        return f"The last {counted.total()} events are: {_listed(named, len(counted))}."


def _of_error(model: LaidOut) -> str:
    """Return a sentence that names the coordinate, velocity or inner state with the largest error of the last step."""
    memory, n = model.memory, model.n_y
    error, scale, y = (memory[one] for one in (owners.Step.y_stage, owners.Step.y_scale, owners.Island.y))
    size = scale + np.abs(y)
    relative = np.divide(np.abs(error), size, out=np.zeros(n), where=size > 0.0)
    relative[model.n_q + model.n_u :][:N_ACCOUNTS] = 0.0
    worst = int(np.argmax(np.nan_to_num(relative, nan=np.inf)))
    for letter, sizes in (("q", "n_q"), ("u", "n_u")):
        for name, body in zip(model.system.names.bodies, model.system.bodies, strict=True):
            if worst < getattr(body, sizes):
                return f"The error is largest in {letter}[{worst}] of the body {name!r}."
            worst -= getattr(body, sizes)
    return "The error is largest in an inner state of a friction law."


def _involved(model: LaidOut) -> str:
    """Return a sentence that names the contacts that were dealt with last."""
    memory = model.memory
    slots = memory[owners.Problem.active][: int(memory[owners.Problem.n_active])]
    numbers = memory[owners.Contact.declared][: int(memory[owners.Island.n_contacts])][slots].tolist()
    names = model.system.names.contacts
    return f"In contact are {_listed([repr(names[i]) for i in numbers[:_NAMED]], len(numbers))}." if numbers else ""


def _listed(words: list[str], total: int) -> str:
    more = [f"{total - len(words)} others"] if total > len(words) else []
    return ", ".join([*words, *more])
