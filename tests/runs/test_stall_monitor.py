"""What holds a run up is counted, and told where time hardly passes or the run ends by it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

import nonsmooth as ns
from bodies import Ball, FunctionLoad, Plate
from laws import Coulomb, EnergeticImpact, Frictionless, NewtonImpact, Unilateral
from nonsmooth.runs.stall_monitor import TimeHardlyPasses
from nonsmooth.types import Floats

ELASTIC = NewtonImpact(1.0, duration=1e-12)


class _EnoughError(Exception):
    pass


def _for(reports: int) -> Callable[[float, float], None]:
    """Return a progress that ends the run after so many reports."""
    left = list(range(reports))

    def report(t: float, t_end: float) -> None:
        if not left:
            raise _EnoughError
        left.pop()

    return report


def _bouncing(g: float, speed: float) -> ns.System:
    plate, ball = Plate(), Ball(0.1)
    system = ns.System([plate, ball], gravity=g)
    system.name(ball, "hammer")
    system.contact(plate, ball, normal=Unilateral(), friction=Frictionless(), impact=ELASTIC)
    system.place(ball, position=(0.0, 0.0, 0.1), velocity=(0.0, 0.0, speed))
    return system


def _brake(t: float, a: Floats, b: Floats, out: Floats, force: float) -> None:
    for i in range(9):
        out[i] = 0.0
    out[2] = -force if b[14] > 0.0 else force


def test_every_step_has_a_limit() -> None:
    """Counted once each, besides passes without a step; a run that goes on counts anew."""
    plate, ball = Plate(), Ball(0.1)
    system = ns.System([plate, ball])
    system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(0.2), impact=EnergeticImpact(0.5))
    system.place(ball, position=(0.0, 0.0, 0.3), velocity=(0.5, 0.0, 0.0))
    model = ns.assemble(system, ns.EventDriven(largest_step=0.02))
    whole, part = model.run(2.0), model.run(1.0)
    rest = model.run(2.0, start=part.state)
    for found in (whole, part, rest):
        counted = found.counters.limits
        assert sum(counted.values()) - counted.get("no step", 0) == found.counters.steps
        assert counted["end of the run"] == 1
    assert whole.counters.limits["largest step"] > 50
    assert whole.counters.limits["event"] == pytest.approx(len(whole.events) - 1, abs=1)
    assert rest.counters.limits["largest step"] < whole.counters.limits["largest step"]


def test_times_between_events_are_counted_by_decades() -> None:
    """A ball bounces without loss every 0.2 s; the first flight is half as long."""
    events = ns.simulate(_bouncing(10.0, 1.0), 2.1).events
    assert events.intervals() == {"1e-01": len(events) - 1}


@pytest.mark.parametrize(
    ("build", "options", "said"),
    [
        (
            lambda: _bouncing(1e4, 1e-5),
            {},
            r"limited by: event \(\d{5}\)\. .* are: impact of 'plate - hammer' \(200\)",
        ),
    ],
    ids=["events"],
)
def test_where_time_hardly_passes_the_limit_and_the_contact_are_told(
    build: Callable[[], ns.System], options: Any, said: str
) -> None:
    """Once, in a run that would take days."""
    with pytest.warns(TimeHardlyPasses, match=said) as told, pytest.raises(_EnoughError):
        ns.simulate(build(), 100.0, engine=ns.EventDriven(**options), progress=_for(12))
    assert len(told) == 1


def test_steps_that_become_too_small_are_told_with_the_body() -> None:
    """A force that jumps with the sign of a velocity has no motion to follow."""
    plate, ball, hammer = Plate(), Ball(0.1), Ball(0.1)
    system = ns.System([plate, ball, hammer])
    system.name(hammer, "hammer")
    system.exclude(plate, ball)
    system.exclude(ball, hammer)
    system.load(FunctionLoad(_brake, {"force": 1e6}), plate, hammer)
    system.place(hammer, position=(0.0, 0.0, 1.0), velocity=(0.0, 0.0, 1.0))
    with pytest.raises(ns.RunFailed, match=r"time tolerance\. The error is largest in u\[2\] of the body 'hammer'"):
        ns.simulate(system, 1.0)
