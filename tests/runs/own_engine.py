"""An engine that no module of nonsmooth knows: the midpoint rule with a fixed step, for bodies without contacts."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.modes import Status
from nonsmooth.engine.memory.owners import (
    BodyRecord,
    Island,
    ModelNumbers,
    OutputNumbers,
    Request,
    Tolerance,
    Totals,
)
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Engine, Scales
from nonsmooth.parameters import parameter
from nonsmooth.system.system import System


@final
@dataclass(frozen=True)
class Midpoint(Engine):
    """Two evaluations of the bodies a step, in Python."""

    step: float = parameter(1e-3, doc="step", unit="s", above=0.0)

    def check(self, system: System) -> None:
        """Refuse what holds or drives bodies."""
        if system.contacts or system.joints or system.loads:
            raise InvalidInput("Midpoint", "must have free bodies only", repr(system), "Take EventDriven.")

    @property
    def promised_residual(self) -> float:
        """So much, with the step as it is by default."""
        return 1e-5

    def counts(self, n_slots: int) -> Mapping[str, int]:
        """Return nothing."""
        return {}

    def settings(self, scales: Scales) -> Mapping[Any, float]:
        """Return the error of a step that explains what the account of energy lacks."""
        return {Tolerance.relative: 1e-5, Tolerance.impact: 1e-5}

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, pauses_before_end: bool) -> int:
        """Step as far as the step fits, and the rest at the end."""
        y, t_end = memory[Island.y], memory[Request.t_end]
        for _ in range(most_steps):
            t = memory[Island.time]
            if t >= t_end:
                return Status.DONE
            if 2 * memory[OutputNumbers.n_samples] > memory[ModelNumbers.sample_capacity]:
                return Status.PAUSED
            h = min(self.step, t_end - t)
            if pauses_before_end and h < self.step:
                return Status.PAUSED
            before = y.copy()
            y += 0.5 * h * _slope(call, memory)
            after = before + h * _slope(call, memory)
            while memory[OutputNumbers.next_sample] <= t + h:
                share = (memory[OutputNumbers.next_sample] - t) / h
                place = call("begin_sample")
                memory.floats[place : place + len(y)] = before + share * (after - before)
            y[:] = after
            memory[Island.time] = t_end if h < self.step else t + h
            memory[Totals.n_steps] += 1
        return Status.PAUSED


def _slope(call: Callable[..., Any], memory: Memory) -> np.ndarray:
    """Return dy/dt of free bodies, whose output blocks hold dq/dt, the force and the inverse mass."""
    call("evaluate_at")
    slope = np.zeros(memory[ModelNumbers.n_y])
    columns = (
        memory[one].tolist() for one in (BodyRecord.q, BodyRecord.u, BodyRecord.n_q, BodyRecord.n_u, BodyRecord.tail)
    )
    for q, u, n_q, n_u, tail in zip(*columns, strict=True):
        block = memory.floats[tail:]
        force, inverse = block[n_q : n_q + n_u], block[n_q + n_u : n_q + n_u + n_u**2].reshape(n_u, n_u)
        slope[q : q + n_q] = block[:n_q]
        first = memory[ModelNumbers.n_q] + u
        slope[first : first + n_u] = inverse @ force
    return slope
