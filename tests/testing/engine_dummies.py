"""Engines with one fault each, round the event-driven one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.event_rows import CODE_HEAD
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.interfaces import Engine, Scales
from nonsmooth.steps import FloatRow, Life, Singleton, array, per
from nonsmooth.system.system import System

Fault = Callable[[Memory, int], None]


def _none(memory: Memory, call: int) -> None:
    """Do nothing."""


def _push(memory: Memory, call: int) -> None:
    if memory[owners.Island.time] == 0.0 and memory[owners.ModelNumbers.n_bodies] == 1:
        memory[owners.Island.y][7] += 0.1  # the velocity, behind position and quaternion


def _late(memory: Memory, call: int) -> None:
    if memory[owners.Island.time] == 0.0:
        memory[owners.OutputNumbers.next_sample] += 0.01


def _skip(memory: Memory, call: int) -> None:
    if memory[owners.OutputNumbers.sample_index] > 1000:
        memory[owners.OutputNumbers.sample_index] += 1
        memory[owners.OutputNumbers.next_sample] += memory[owners.Request.sample_interval]


def _gain(memory: Memory, call: int) -> None:
    if memory[owners.ModelNumbers.n_bodies] == 1:
        memory[owners.Totals.driven_work] += 0.01


def _age(memory: Memory, call: int) -> None:
    memory[owners.Island.y][0] += 1e-12 * call


def _forget(memory: Memory, call: int) -> None:
    if memory[owners.Request.is_resumed] == 1:
        memory[owners.Island.y][0] += 1e-12


def _turn(memory: Memory, call: int) -> None:
    """Turn the box that tumbles a little, at constant length of its quaternion."""
    if memory[owners.ModelNumbers.n_q] == 14:
        four = memory[owners.Island.y][10:14]
        four[:2] = 0.8 * four[0] - 0.6 * four[1], 0.6 * four[0] + 0.8 * four[1]


def _throw(memory: Memory, call: int) -> None:
    """Throw the ball over the driven plate up."""
    if (
        memory[owners.ModelNumbers.n_bodies] == 2
        and memory[owners.ModelNumbers.n_q] == 7
        and memory[owners.Island.time] == 0.0
    ):
        memory[owners.Island.y][9] += 0.5


def _sink(memory: Memory, call: int) -> None:
    """Overlook the contacts of the heap."""
    if memory[owners.ModelNumbers.n_bodies] == 11:
        _overlook(memory, call)


def _open(memory: Memory, call: int) -> None:
    """Record the contact of the first event as open."""
    if memory[owners.OutputNumbers.integers_used] > CODE_HEAD:
        memory[owners.OutputNumbers.event_codes][CODE_HEAD + 1] = 0


def _overlook(memory: Memory, call: int) -> None:
    memory[owners.Island.n_contacts] = memory[owners.ModelNumbers.n_spheres] = 0


class _Attic(Singleton, key="attic"):
    """An array for each of something that no system counts."""

    room: FloatRow = array(Life.STEP, per(1, "n_attics"), float, "", "Room.")


@dataclass(frozen=True)
class Dummy(Engine):
    """The event-driven engine, with something done before each advance, and something after it."""

    fault: Fault = _none
    later: Fault = _none
    room: type[Singleton] | None = None
    calls: list[int] = field(default_factory=list, compare=False)

    def parameters(self) -> Mapping[str, Any]:
        return {}

    @property
    def own(self) -> type[Singleton] | None:
        return self.room

    @property
    def uses_flow(self) -> bool:
        return True

    @property
    def records_contacts(self) -> bool:
        return True

    def check(self, system: System) -> None:
        EventDriven().check(system)

    def counts(self, n_slots: int) -> Mapping[str, int]:
        return EventDriven().counts(n_slots)

    def settings(self, scales: Scales) -> Mapping[Any, float]:
        return EventDriven().settings(scales)

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, pauses_before_end: bool) -> int:
        self.calls.append(1)
        self.fault(memory, len(self.calls))
        status = EventDriven().advance(call, memory, most_steps, pauses_before_end)
        self.later(memory, len(self.calls))
        return status


DUMMIES: list[tuple[str, Engine]] = [
    ("names", Dummy(room=_Attic)),
    ("free fall", Dummy(_push)),
    ("samples", Dummy(_late)),
    ("many samples", Dummy(_skip)),
    ("energy", Dummy(_gain)),
    ("repeatable", Dummy(_age)),
    ("contact", Dummy(_overlook)),
    ("modes", Dummy(later=_open)),
    ("quaternion", Dummy(_turn)),
    ("driven plate", Dummy(_throw)),
    ("heap", Dummy(_sink)),
    ("continues", Dummy(_forget)),
]
