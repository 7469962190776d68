"""Turns: several runs of one model take one step each in one memory, which must not change a bit of any.

Before its step each run gives the memory its checkpoint, and takes it back afterwards, so that a step finds of all that
an earlier one wrote only what outlives it. What islands need to keep to have clocks of their own is the same.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, final

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.modes import Status
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.interfaces.engine import Engine
from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.testing.poison import ENDS_WITH_STEP, poison

_BUFFERS = (
    owners.Output.n_events,
    owners.Output.floats_used,
    owners.Output.integers_used,
    owners.Output.n_samples,
)
"""How far the buffers of the output are filled."""

if TYPE_CHECKING:
    from nonsmooth.system.system import System


@final
@dataclass(frozen=True)
class Turns(Engine):
    """The event-driven engine, between whose steps another run of the model takes one.

    The other run begins at the same start, and is as many steps behind as it was when this one was called first.

    Attributes
    ----------
    inner : EventDriven
        What runs.
    others : list of Checkpoint
        Where the other runs stand.
    lag : int
        By how many steps each of the other runs is behind the one before it.
    n_others : int
        How many other runs there are.
    """

    inner: EventDriven = field(default_factory=EventDriven)
    others: list[Checkpoint] = field(default_factory=list, repr=False)
    lag: int = 3
    n_others: int = 2

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
        """Go on by single steps, and let another run take one after each."""
        for _ in range(most_steps):
            before = memory[owners.Totals.n_evaluations], memory[owners.Output.n_events], memory[owners.Island.time]
            status = self.inner.advance(call, memory, 1, wary)
            after = memory[owners.Totals.n_evaluations], memory[owners.Output.n_events], memory[owners.Island.time]
            if status != Status.PAUSED or after == before:
                return status
            self._let_others(call, memory)
        return Status.PAUSED

    def _let_others(self, call: Callable[..., Any], memory: Memory) -> None:
        """Let the other runs take one step each, from where they stand."""
        own = Checkpoint.of(memory)
        if memory[owners.Totals.n_steps] % self.lag == 0 and len(self.others) < self.n_others:
            self.others.append(own)
        for number, other in enumerate(self.others):
            _enter(memory, other)
            # what the own run has recorded and nobody has read stays in the buffers
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
