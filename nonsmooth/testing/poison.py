"""Poison: numbers become unusable as soon as their life has ended, which must not change a bit of a run.

The field table says of every number how long it has a meaning (:class:`nonsmooth.engine.memory.declare.Life`). The
engine :class:`Poisoned` overwrites what is dead: at the end of each step, each event and each impact. A kernel that
reads a number that nobody has written since then gets a number that changes the run. Events and impacts are entry
points, which the engine calls by address: their addresses lead to callbacks that call them and poison what they
leave.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, final

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.declare import Declaration, Life, Part, declarations
from nonsmooth.engine.memory.entry_points import ENTRY_POINTS
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.modes import Status
from nonsmooth.engine.memory.tables import OWNERS
from nonsmooth.engine.native.kernel import PLAIN, entry_addresses, prototype_of
from nonsmooth.testing.single_steps import SingleSteps

POISON = 1_234_567_891
"""Integer that is no number of anything: as a place it leads out of every list of the size of a test."""
ENDS_WITH_IMPACT = (Life.IMPACT, Life.SOLUTION)
ENDS_WITH_EVENT = (*ENDS_WITH_IMPACT, Life.EVENT)
ENDS_WITH_STEP = (*ENDS_WITH_EVENT, Life.STEP)
"""Lives that are over with an impact, with an event, and with a step."""


def poison(memory: Memory, *lives: Life, booleans: bool = True) -> None:
    """Overwrite all numbers of some lives: floats by NaN, integers by :data:`POISON`, booleans by ``booleans``."""
    for one in _dead(lives):
        value = np.nan if one.is_float else booleans if one.kind is bool else POISON
        if one.size is None and issubclass(one.owner, Part):
            memory[one] = value
        else:
            memory[one][...] = value


def _dead(lives: tuple[Life, ...]) -> list[Declaration]:
    if lives not in _known:
        every = (one for owner in OWNERS for one in declarations(owner).values())
        _known[lives] = [one for one in every if one.life in lives and not one.inside[0]]
    return _known[lives]


_known: dict[tuple[Life, ...], list[Declaration]] = {}


@final
@dataclass(frozen=True)
class Poisoned(SingleSteps):
    """The event-driven engine with poison, as slow as that is.

    Attributes
    ----------
    booleans : bool
        What dead booleans become. A run must be the same with either: one of them is other than what was left.
    callbacks : list
        What keeps the functions alive to which the addresses of entry points lead.
    """

    booleans: bool = True
    callbacks: list[Any] = field(default_factory=list, repr=False)

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, wary: bool) -> int:
        """Continue by single steps, with poison after each, and after each event and impact in them."""
        if not PLAIN:
            self._divert(memory, "update_at_event", ENDS_WITH_EVENT)
            self._divert(memory, "collide", ENDS_WITH_IMPACT)
        return super().advance(call, memory, most_steps, wary)

    def after_step(self, call: Callable[..., Any], memory: Memory) -> None:
        """Poison what ends with a step."""
        poison(memory, *ENDS_WITH_STEP, booleans=self.booleans)

    def _divert(self, memory: Memory, name: str, lives: tuple[Life, ...]) -> None:
        """Let the address of an entry point lead to a callback that calls it and poisons what it leaves."""
        places, number = memory[owners.Model.entry_points], ENTRY_POINTS.index(name)
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
