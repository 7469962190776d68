"""A budget in steps: the end of runs that would take too long, the same on every machine."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, final

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.modes import REASONS, Status
from nonsmooth.interfaces import EndCause, Engine, Measure
from nonsmooth.solution.solution import Solution

if TYPE_CHECKING:
    from nonsmooth.engine.memory.declare import Part
    from nonsmooth.engine.memory.memory import Memory
    from nonsmooth.system.system import System


@final
@dataclass(frozen=True)
class Budgeted(Engine):
    """Another engine, which stops where its steps of the flow are used up; until then all bits are those of the other.

    Attributes
    ----------
    engine : Engine
        What integrates.
    steps : int
        Steps of the flow at most.
    """

    engine: Engine
    steps: int

    @property
    def uses_flow(self) -> bool:
        """As the engine."""
        return self.engine.uses_flow

    @property
    def own(self) -> type[Part] | None:
        """Those of the engine."""
        return self.engine.own

    @property
    def records_contacts(self) -> bool:
        """As the engine."""
        return self.engine.records_contacts

    @property
    def verdict(self) -> tuple[Measure, ...]:
        """That of the engine."""
        return self.engine.verdict

    @property
    def causes(self) -> tuple[EndCause, ...]:
        """Those of the engine."""
        return self.engine.causes

    @property
    def promised_residual(self) -> float | None:
        """That of the engine."""
        return self.engine.promised_residual

    def check(self, system: System) -> None:
        """Ask the engine."""
        self.engine.check(system)

    def counts(self, n_slots: int) -> Mapping[str, int]:
        """Return those of the engine."""
        return self.engine.counts(n_slots)

    def settings(self, time_scale: float) -> Mapping[Any, float]:
        """Return those of the engine."""
        return self.engine.settings(time_scale)

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, wary: bool) -> int:
        """Go on as far as the budget reaches."""
        left = self.steps - int(memory[owners.Totals.n_steps])
        status = self.engine.advance(call, memory, min(most_steps, left), wary) if left > 0 else Status.PAUSED
        spent = status == Status.PAUSED and int(memory[owners.Totals.n_steps]) >= self.steps
        return Status.STOPPED if spent else status

    def spent(self, solution: Solution) -> bool:
        """Tell whether a run ended because of it."""
        stopped = solution.message == REASONS[Status.STOPPED]
        return stopped and solution.counters.steps >= self.steps
