"""Engines that report what only they know: contacts, numbers by which they judge a run, causes for which it ends."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.modes import DONE, PAUSED, START, STEP, STICK
from nonsmooth.interfaces import Cause, Measure
from nonsmooth.parameters import parameter
from nonsmooth.steps import Arrays, real
from tests.runs.faulty_engines import Blind
from tests.runs.own_engine import Midpoint

IMPULSE = 0.25
"""Normal impulse that :class:`Resting` records at each sample [N s]."""
TOO_FAST, SLOW = 100, 101


@dataclass(frozen=True)
class Resting(Blind):
    """Nothing moves: contacts stick, and bear an impulse at each sample.

    Attributes
    ----------
    tells : bool
        Whether it says that it records contacts.
    first : float
        Part of the first sample interval after which its first event is.
    """

    tells: bool = True
    first: float = 0.0

    @property
    def records_contacts(self) -> bool:
        return self.tells

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, wary: bool) -> int:
        record = memory.record
        n, y = int(record["island.n_contacts"]), memory[owners.Island.y][: int(record["model.n_y"])]
        while record["output.next_sample"] <= record["request.t_end"]:
            if 2 * record["output.n_samples"] > record["model.sample_capacity"]:
                return PAUSED
            index, record["island.time"] = int(record["output.sample_index"]), record["output.next_sample"]
            if index == 0:
                record["island.time"] += self.first * record["request.sample_interval"]
            call("remember")
            memory[owners.Contact.mode][:n][:] = STICK
            __FLAT(memory[owners.Contact.event_impulse], 3 * n)[::3] = IMPULSE
            call("record_event", STEP if index else START, -1, 0)
            place = call("begin_sample")
            memory.floats[place : place + len(y)] = y
        record["island.time"] = record["request.t_end"]
        return DONE


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
    def own(self) -> Arrays:
        return Arrays(scalars=real("fastest_fall"))

    @property
    def verdict(self) -> tuple[Measure, ...]:
        return (Measure("fastest_fall", "m/s", "largest speed downwards at the end of a step"),)

    @property
    def causes(self) -> tuple[Cause, ...]:
        return (
            Cause(TOO_FAST, "too_fast", "the body falls too fast", "Take a parachute."),
            Cause(SLOW, "fast_enough", "the body falls fast enough", is_failure=False),
        )

    @property
    def promised_residual(self) -> float | None:
        return self.promise or None

    def settings(self, time_scale: float) -> Mapping[str, float]:
        return {"rtol": 1e-9, "impact_rtol": 1e-8}

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, wary: bool) -> int:
        record = memory.record
        n_q, n_u = int(record["model.n_q"]), int(record["model.n_u"])
        for _ in range(most_steps):
            before = float(record["island.time"])
            status = Midpoint(self.step).advance(call, memory, 1, wary)
            fall = -float(memory[owners.Island.y][: n_q + n_u][-4])
            record["fastest_fall"] = max(float(record["fastest_fall"]), fall)
            if record["island.time"] > max(before, 0.0505):
                record["totals.driven_work"] += self.gain
            for speed, code in ((self.most, TOO_FAST), (self.enough, SLOW)):
                if fall >= speed:
                    return code
            if status == DONE or record["island.time"] == before:
                return status
        return PAUSED
