"""Turns: several runs of one model take one step each in one memory, which must not change a bit of any.

Before its step each run gives the memory its checkpoint, and takes it back afterwards, so that a step finds of all that
an earlier one wrote only what outlives it. What islands need to keep to have clocks of their own is the same.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, final

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.testing.poison import ENDS_WITH_STEP, poison
from nonsmooth.testing.single_steps import SingleSteps

_BUFFERS = (
    owners.Output.n_events,
    owners.Output.floats_used,
    owners.Output.integers_used,
    owners.Output.n_samples,
)
"""How far the buffers of the output are filled."""


@final
@dataclass(frozen=True)
class Turns(SingleSteps):
    """The event-driven engine, between whose steps other runs of the model take one each.

    They begin where this run is after ``lag`` steps, and again so many later. This run must be the same as alone.

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
