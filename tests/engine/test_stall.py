"""A run in which time stops passing ends with the contacts that hold it up, or another engine takes it over."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, final

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Plate, Rest
from laws import EnergeticImpact, Frictionless, Unilateral
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.modes import Status
from nonsmooth.interfaces import Engine, Scales

RADIUS, SPEED, CONTACT_TIME = 0.01, 1.0, 1e-3
CROWDED = 1e-2 * CONTACT_TIME / 100
"""Time between two events of a contact below which it stalls [s]."""


def _rattling(every: float, beside: int = 0) -> ns.System:
    """Return a ball without loss that strikes each of two plates every so many seconds, and others that are still."""
    gap = 0.5 * every * SPEED
    lid = Plate(Rest(position=(0.0, 0.0, 2.0 * RADIUS + gap), orientation=(0.0, 1.0, 0.0, 0.0)))
    plate, balls = Plate(), [Ball(RADIUS) for _ in range(1 + beside)]
    system = ns.System([plate, lid, *balls])
    law = EnergeticImpact(1.0, duration=CONTACT_TIME)
    for number, ball in enumerate(balls):
        for wall in (plate, lid):
            system.contact(wall, ball, normal=Unilateral(), friction=Frictionless(), impact=law)
        height = RADIUS + 0.25 * gap
        system.place(ball, position=(0.1 * number, 0.0, height), velocity=(0.0, 0.0, 0.0 if number else SPEED))
    return system


@pytest.mark.parametrize("beside", [0, 3])
def test_a_run_in_which_time_stops_passing_says_so(beside: int) -> None:
    """What stands beside is not counted in."""
    with pytest.raises(
        ns.RunFailed, match=r"the run stalls.*impact of 'plate 1 - ball.*Try a lower restitution"
    ) as failed:
        ns.simulate(_rattling(0.9 * CROWDED, beside), 1.0)
    solution = failed.value.solution
    assert isinstance(solution, ns.Solution)
    assert 80 * CROWDED < solution.t_end < 100 * CROWDED
    assert len(solution.events) > 200


def test_what_is_hardly_slower_goes_on() -> None:
    t_end = 1000 * CROWDED
    solution = ns.simulate(_rattling(1.1 * CROWDED), t_end)
    assert solution.status == "done"
    assert solution.counters.impacts == pytest.approx(2.0 * t_end / (1.1 * CROWDED), abs=2.0)
    assert abs(solution.u_end[2]) == pytest.approx(SPEED, rel=1e-4)


@final
@dataclass(frozen=True)
class Relay(Engine):
    """An engine put together of two: the event-driven one, and one that stops the bodies where that one stalls."""

    first: ns.EventDriven = field(default_factory=ns.EventDriven)

    @property
    def uses_flow(self) -> bool:
        return self.first.uses_flow

    @property
    def records_contacts(self) -> bool:
        return True

    def check(self, system: ns.System) -> None:
        self.first.check(system)

    def counts(self, n_slots: int) -> Mapping[str, int]:
        return self.first.counts(n_slots)

    def settings(self, scales: Scales) -> Mapping[Any, float]:
        return self.first.settings(scales)

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, pauses_before_end: bool) -> int:
        status = self.first.advance(call, memory, most_steps, pauses_before_end)
        if status != Status.STALLED:
            return status
        n_q, n_u, n = (
            memory[one] for one in (owners.ModelNumbers.n_q, owners.ModelNumbers.n_u, owners.Island.n_contacts)
        )
        assert np.max(memory[owners.ContactRecord.burst_events][:n]) > 100
        memory[owners.ContactRecord.burst_events][:n] = 0
        memory[owners.Island.y][n_q : n_q + n_u] = 0.0
        memory[owners.Run.has_started] = 0
        return Status.PAUSED


def test_another_engine_may_go_on_where_the_first_one_stalls() -> None:
    solution = ns.simulate(_rattling(0.9 * CROWDED), 1.0, engine=Relay())
    assert solution.t_end == 1.0
    assert solution.u_end[2] == pytest.approx(0.0, abs=1e-9)
