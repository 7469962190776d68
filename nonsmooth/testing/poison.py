"""Poison: numbers become unusable as soon as their life has ended, which must not change a bit of a run.

The field table says of every number how long it has a meaning (:class:`nonsmooth.engine.memory.declare.Life`). The
engine :class:`Poisoned` overwrites what is dead: at the end of each step, each event and each impact. A kernel that
reads a number that nobody has written since then gets a number that changes the run. Events and impacts are entry
points, which the engine calls by address: their addresses lead to callbacks that call them and poison what they
leave.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, final

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.declare import Declaration, Life, Part, declarations
from nonsmooth.engine.memory.entry_points import ENTRY_POINTS
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.modes import Status
from nonsmooth.engine.memory.tables import OWNERS
from nonsmooth.engine.native.kernel import PLAIN, entry_addresses, prototype_of
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.interfaces.engine import Engine

if TYPE_CHECKING:
    from nonsmooth.system.system import System

POISON = 1_234_567_891
"""Integer that is no number of anything: as a place it leads out of every list of the size of a test."""
ENDS_WITH_IMPACT = (Life.IMPACT, Life.SOLUTION)
ENDS_WITH_EVENT = (*ENDS_WITH_IMPACT, Life.EVENT)
ENDS_WITH_STEP = (*ENDS_WITH_EVENT, Life.STEP)
"""Lives that are over with an impact, with an event, and with a step."""


def poison(memory: Memory, *lives: Life) -> None:
    """Overwrite all numbers of some lives: floats by NaN, integers by :data:`POISON`, booleans by their opposite."""
    for one in _dead(lives):
        if one.size is None and issubclass(one.owner, Part):
            memory[one] = _poison_of(one, memory[one])
        else:
            numbers = memory[one]
            numbers[...] = _poison_of(one, numbers)


def _dead(lives: tuple[Life, ...]) -> list[Declaration]:
    if lives not in _known:
        every = (one for owner in OWNERS for one in declarations(owner).values())
        _known[lives] = [one for one in every if one.life in lives and not one.inside[0]]
    return _known[lives]


_known: dict[tuple[Life, ...], list[Declaration]] = {}


def _poison_of(one: Declaration, numbers: Any) -> Any:
    if one.is_float:
        return np.nan
    return np.where(numbers == 0, 1, 0) if one.kind is bool else POISON


@final
@dataclass(frozen=True)
class Poisoned(Engine):
    """The event-driven engine with poison, as slow as that is.

    Attributes
    ----------
    inner : EventDriven
        What runs.
    callbacks : list
        What keeps the functions alive to which the addresses of entry points lead.
    """

    inner: EventDriven = field(default_factory=EventDriven)
    callbacks: list[Any] = field(default_factory=list, repr=False)

    @property
    def uses_flow(self) -> bool:
        """As the inner engine."""
        return self.inner.uses_flow

    @property
    def records_contacts(self) -> bool:
        """As the inner engine."""
        return self.inner.records_contacts

    def check(self, system: System) -> None:
        """As the inner engine."""
        self.inner.check(system)

    def counts(self, n_slots: int) -> Mapping[str, int]:
        """As the inner engine."""
        return self.inner.counts(n_slots)

    def settings(self, time_scale: float) -> Mapping[Any, float]:
        """As the inner engine."""
        return self.inner.settings(time_scale)

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, wary: bool) -> int:
        """Go on by single steps, with poison after each, and after each event and impact in them."""
        if not PLAIN:
            self._divert(memory, "update_at_event", ENDS_WITH_EVENT)
            self._divert(memory, "collide", ENDS_WITH_IMPACT)
        for _ in range(most_steps):
            before = memory[owners.Totals.n_evaluations], memory[owners.Output.n_events], memory[owners.Island.time]
            status = self.inner.advance(call, memory, 1, wary)
            poison(memory, *ENDS_WITH_STEP)
            after = memory[owners.Totals.n_evaluations], memory[owners.Output.n_events], memory[owners.Island.time]
            if status != Status.PAUSED or after == before:
                return status
        return Status.PAUSED

    def _divert(self, memory: Memory, name: str, lives: tuple[Life, ...]) -> None:
        """Let the address of an entry point lead to a callback that calls it and poisons what it leaves."""
        places, number = memory[owners.Model.entry_points], ENTRY_POINTS.index(name)
        address = entry_addresses()[number]
        if places[number] != address:
            return
        prototype = prototype_of(name)
        inner = prototype(address)

        def outer(*arguments: Any) -> Any:
            found = inner(*arguments)
            poison(memory, *lives)
            return found

        self.callbacks.append(prototype(outer))
        places[number] = ctypes.cast(self.callbacks[-1], ctypes.c_void_p).value
