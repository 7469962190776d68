"""Engines that prove the lives of the numbers in the memory: a run is the same to the last bit with either.

The field table says of every number how long it has a meaning (:class:`nonsmooth.engine.memory.declare.Life`).
:class:`Poisoned` overwrites what is dead: at the end of each step, each event and each impact. A kernel that reads a
number that nobody has written since then gets a number that changes the run. Events and impacts are entry points, which
the engine calls by address: their addresses lead to callbacks that call them and poison what they leave.
:class:`Turns` lets other runs of the model take steps in the same memory, between which it keeps a checkpoint only.
"""

from __future__ import annotations

import ctypes
import functools
from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, final

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.declare import Declaration, Life, Singleton, declarations
from nonsmooth.engine.memory.entry_points import ENTRY_POINTS
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.modes import Status
from nonsmooth.engine.memory.tables import OWNERS
from nonsmooth.engine.native.kernel import PLAIN, entry_addresses, prototype_of
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.interfaces import Scales
from nonsmooth.interfaces.engine import Engine
from nonsmooth.model.checkpoint import Checkpoint

if TYPE_CHECKING:
    from nonsmooth.system.system import System

POISON = 1_234_567_891
"""Integer that is no number of anything: as a place it leads out of every list of the size of a test."""
ENDS_WITH_IMPACT = (Life.IMPACT, Life.SOLUTION)
ENDS_WITH_EVENT = (*ENDS_WITH_IMPACT, Life.EVENT)
ENDS_WITH_STEP = (*ENDS_WITH_EVENT, Life.STEP)
"""Lives that are over with an impact, with an event, and with a step."""
_BUFFERS = (
    owners.OutputNumbers.n_events,
    owners.OutputNumbers.floats_used,
    owners.OutputNumbers.integers_used,
    owners.OutputNumbers.n_samples,
)
"""How far the buffers of the output are filled."""


def poison(memory: Memory, *lives: Life, booleans: bool = True) -> None:
    """Overwrite all numbers of some lives: floats by NaN, integers by :data:`POISON`, booleans by ``booleans``."""
    for one in _dead(lives):
        value = np.nan if one.is_float else booleans if one.kind is bool else POISON
        if one.size is None and issubclass(one.owner, Singleton):
            memory[one] = value
        else:
            memory[one][...] = value


@functools.cache
def _dead(lives: tuple[Life, ...]) -> list[Declaration]:
    every = (one for owner in OWNERS for one in declarations(owner).values())
    return [one for one in every if one.life in lives and not one.inside[0]]


@dataclass(frozen=True)
class SingleSteps(Engine):
    """Base of engines that run the event-driven engine and change the memory between its steps.

    Attributes
    ----------
    inner : EventDriven
        The engine that takes the steps.
    """

    inner: EventDriven = field(default_factory=EventDriven)

    @abstractmethod
    def after_step(self, call: Callable[..., Any], memory: Memory) -> None:
        """Change the memory after a step of the run, as :meth:`advance` got it."""

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

    def settings(self, scales: Scales) -> Mapping[Any, float]:
        """As the inner engine."""
        return self.inner.settings(scales)

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, pauses_before_end: bool) -> int:
        """Continue by single steps; ends as the inner engine, or if it does nothing because it waits for the end."""
        for _ in range(most_steps):
            before = _progress(memory)
            status = self.inner.advance(call, memory, 1, pauses_before_end)
            is_idle = _progress(memory) == before
            if status != Status.PAUSED:
                return status
            self.after_step(call, memory)
            if is_idle:
                return status
        return Status.PAUSED


def _progress(memory: Memory) -> tuple[int, int, float]:
    """Evaluations of forces, events in the buffers, and time [s]: one of them changes in a step."""
    return memory[owners.Totals.n_evaluations], memory[owners.OutputNumbers.n_events], memory[owners.Island.time]


@final
@dataclass(frozen=True)
class Poisoned(SingleSteps):
    """The event-driven engine with poison, as slow as that is.

    Attributes
    ----------
    booleans : bool
        Value that dead booleans get. A run must be the same with either: one of them is other than the number left.
    callbacks : list
        References that keep the functions alive to which the addresses of entry points lead.
    """

    booleans: bool = True
    callbacks: list[Any] = field(default_factory=list, repr=False)

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, pauses_before_end: bool) -> int:
        """Continue by single steps, with poison after each, and after each event and impact in them."""
        if not PLAIN:
            self._divert(memory, "update_at_event", ENDS_WITH_EVENT)
            self._divert(memory, "collide", ENDS_WITH_IMPACT)
        return super().advance(call, memory, most_steps, pauses_before_end)

    def after_step(self, call: Callable[..., Any], memory: Memory) -> None:
        """Poison what ends with a step."""
        poison(memory, *ENDS_WITH_STEP, booleans=self.booleans)

    def _divert(self, memory: Memory, name: str, lives: tuple[Life, ...]) -> None:
        """Let the address of an entry point lead to a callback that calls it and poisons what it leaves."""
        places, number = memory[owners.ModelNumbers.entry_points], ENTRY_POINTS.index(name)
        address = entry_addresses()[number]
        if places[number] != address:
            return
        prototype = prototype_of(name)
        inner = prototype(address)

        def outer(*arguments: Any) -> Any:
            status = inner(*arguments)
            # a message says in what state an event or impact failed
            if status == Status.RUNNING:
                poison(memory, *lives, booleans=self.booleans)
            return status

        self.callbacks.append(prototype(outer))
        places[number] = ctypes.cast(self.callbacks[-1], ctypes.c_void_p).value


@final
@dataclass(frozen=True)
class Turns(SingleSteps):
    """The event-driven engine, between whose steps other runs of the model take one each.

    Before its step each run gives the memory its checkpoint, and takes it back afterwards, so that a step finds of all
    that an earlier one wrote only what outlives it. The others begin where this run is after ``lag`` steps, and again
    so many later. This run must be the same as alone. Islands need to keep the same to have clocks of their own.

    Attributes
    ----------
    others : list of Checkpoint
        Where the other runs are.
    lag : int
        Steps of this run between the starts of the others.
    n_others : int
        Number of other runs.
    """

    others: list[Checkpoint] = field(default_factory=list, repr=False)
    lag: int = 3
    n_others: int = 2

    def after_step(self, call: Callable[..., Any], memory: Memory) -> None:
        """Let the other runs take one step each, from where they are."""
        own = Checkpoint.of(memory)
        if memory[owners.Totals.n_steps] % self.lag == 0 and len(self.others) < self.n_others:
            self.others.append(own)
        for number, other in enumerate(self.others):
            _enter(memory, other)
            # records of this run that nobody has read stay in the buffers
            for one in _BUFFERS:
                memory[one] = own[one]
            self.inner.advance(call, memory, 1, False)
            self.others[number] = Checkpoint.of(memory)
        if self.others:
            _enter(memory, own)


def _enter(memory: Memory, checkpoint: Checkpoint) -> None:
    """Give the memory a checkpoint, and poison all else."""
    poison(memory, *ENDS_WITH_STEP)
    checkpoint.put(memory)
    memory[owners.Request.is_resumed] = True
