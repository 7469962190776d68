"""The event-driven engine by single steps, so that something can happen to the memory after each."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.modes import Status
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.interfaces.engine import Engine

if TYPE_CHECKING:
    from nonsmooth.system.system import System


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

    def settings(self, time_scale: float) -> Mapping[Any, float]:
        """As the inner engine."""
        return self.inner.settings(time_scale)

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, wary: bool) -> int:
        """Continue by single steps; ends as the inner engine, or if it does nothing because it waits for the end."""
        for _ in range(most_steps):
            before = _progress(memory)
            status = self.inner.advance(call, memory, 1, wary)
            is_idle = _progress(memory) == before
            if status != Status.PAUSED:
                return status
            self.after_step(call, memory)
            if is_idle:
                return status
        return Status.PAUSED


def _progress(memory: Memory) -> tuple[int, int, float]:
    """Evaluations of forces, events in the buffers, and time [s]: one of them changes in a step."""
    return memory[owners.Totals.n_evaluations], memory[owners.Output.n_events], memory[owners.Island.time]
