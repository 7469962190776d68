"""Engines that report what only they know: contacts, numbers by which they judge a run, causes for which it ends."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from nonsmooth.engine.memory import modes
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.modes import Mode, Status
from nonsmooth.engine.memory.owners import (
    ContactRecord,
    Island,
    ModelNumbers,
    OutputNumbers,
    Request,
    Tolerance,
    Totals,
)
from nonsmooth.interfaces import EndCause, Measure, Scales
from nonsmooth.parameters import parameter
from nonsmooth.steps import Life, Singleton, real
from tests.runs.faulty_engines import Blind
from tests.runs.own_engine import Midpoint

IMPULSE = 0.25
"""Normal impulse that :class:`Resting` records at each sample [N s]."""
TOO_FAST, SLOW = 100, 101


class Falling(Singleton, key="falling"):
    """What :class:`Judged` measures."""

    fastest_fall: float = real(Life.STATE, "m/s", "Largest speed downwards at the end of a step.")


@dataclass(frozen=True)
class Resting(Blind):
    """Nothing moves: contacts stick, and bear an impulse at each sample.

    Attributes
    ----------
    tells : bool
        Whether it says that it records contacts.
    first : float
        Singleton of the first sample interval after which its first event is.
    """

    tells: bool = True
    first: float = 0.0

    @property
    def records_contacts(self) -> bool:
        return self.tells

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, pauses_before_end: bool) -> int:
        n, y, t_end = memory[Island.n_contacts], memory[Island.y], memory[Request.t_end]
        while memory[OutputNumbers.next_sample] <= t_end:
            if 2 * memory[OutputNumbers.n_samples] > memory[ModelNumbers.sample_capacity]:
                return Status.PAUSED
            index, memory[Island.time] = memory[OutputNumbers.sample_index], memory[OutputNumbers.next_sample]
            if index == 0:
                memory[Island.time] += self.first * memory[Request.sample_interval]
            call("begin_event")
            memory[ContactRecord.mode][:n] = Mode.STICK
            memory[ContactRecord.event_impulse][:n, 0] = IMPULSE
            call("record_event", modes.Cause.STEP if index else modes.Cause.START, -1, 0)
            place = call("begin_sample")
            memory.floats[place : place + len(y)] = y
        memory[Island.time] = t_end
        return Status.DONE


@dataclass(frozen=True)
class Judged(Blind):
    """The midpoint rule, which measures the fastest fall of the last body and ends a run in which it is too fast.

    Attributes
    ----------
    most : float
        Speed at which a run fails [m/s].
    enough : float
        Speed at which a run is done [m/s].
    promise : float
        Promised residual, 0 for none.
    gain : float
        Work that it books although nobody does it, at each step that ends behind 0.0505 s [J].
    """

    most: float = parameter(1e9, doc="speed at which a run fails", unit="m/s", above=0.0)
    enough: float = parameter(1e9, doc="speed at which a run is done", unit="m/s", above=0.0)
    promise: float = parameter(0.0, doc="promised residual", minimum=0.0)
    gain: float = parameter(0.0, doc="work that is none", unit="J")

    @property
    def own(self) -> type[Singleton]:
        return Falling

    @property
    def verdict(self) -> tuple[Measure, ...]:
        return (Measure("fastest_fall", "m/s", "largest speed downwards at the end of a step"),)

    @property
    def causes(self) -> tuple[EndCause, ...]:
        return (
            EndCause(TOO_FAST, "too_fast", "the body falls too fast", "Take a parachute."),
            EndCause(SLOW, "fast_enough", "the body falls fast enough", is_failure=False),
        )

    @property
    def promised_residual(self) -> float | None:
        return self.promise or None

    def settings(self, scales: Scales) -> Mapping[Any, float]:
        return {Tolerance.relative: 1e-9, Tolerance.impact: 1e-8}

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, pauses_before_end: bool) -> int:
        n_q, n_u = memory[ModelNumbers.n_q], memory[ModelNumbers.n_u]
        for _ in range(most_steps):
            before = memory[Island.time]
            status = Midpoint(self.step).advance(call, memory, 1, pauses_before_end)
            fall = -float(memory[Island.y][n_q + n_u - 4])
            memory[Falling.fastest_fall] = max(memory[Falling.fastest_fall], fall)
            if memory[Island.time] > max(before, 0.0505):
                memory[Totals.driven_work] += self.gain
            for speed, code in ((self.most, TOO_FAST), (self.enough, SLOW)):
                if fall >= speed:
                    return code
            if status == Status.DONE or memory[Island.time] == before:
                return status
        return Status.PAUSED
