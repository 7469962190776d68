"""Guards of the scenario's own: located exactly, once per crossing, downwards only."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, final

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.interfaces import Guard
from nonsmooth.parameters import parameter
from nonsmooth.types import Floats

GRAVITY = 9.81


def _height(t: float, q: Floats, u: Floats, level: float, sign: float) -> float:
    return sign * (q[2] - level)


def _phase(t: float, q: Floats, u: Floats, frequency: float) -> float:
    return math.sin(2.0 * math.pi * frequency * t)


@final
@dataclass(frozen=True)
class Level(Guard):
    """The mass centre passes a height, downwards with sign 1, upwards with -1."""

    level: float = parameter(doc="height", unit="m")
    sign: float = parameter(1.0, doc="1 downwards, -1 upwards")
    last: bool = False

    @property
    def value(self) -> Callable[..., float]:
        """Height above the level."""
        return _height

    @property
    def ends_run(self) -> bool:
        """As asked for."""
        return self.last

    def parameters(self) -> dict[str, float]:
        """Return the numbers only."""
        return {"level": self.level, "sign": self.sign}


@final
@dataclass(frozen=True)
class Clock(Guard):
    """Once per period, in its middle."""

    frequency: float = parameter(doc="frequency", unit="Hz", above=0.0)

    @property
    def value(self) -> Callable[..., float]:
        """A sine."""
        return _phase

    @property
    def ends_run(self) -> bool:
        """Never."""
        return False


def _thrown() -> ns.System:
    ball = Ball(radius=0.01)
    system = ns.System([ball], gravity=GRAVITY)
    system.place(ball, position=(0.0, 0.0, 1.0), velocity=(0.0, 0.0, 2.0))
    return system


def _passages(level: float) -> list[float]:
    root = math.sqrt(4.0 - 2.0 * GRAVITY * (level - 1.0))
    return [(2.0 - root) / GRAVITY, (2.0 + root) / GRAVITY]


@pytest.mark.parametrize("level", [0.7, 1.1, 1.2])
def test_both_directions_are_told_apart(level: float) -> None:
    """A thrown ball passes a level above its start twice, below it once; every passage fires one of two guards."""
    system = _thrown()
    system.guard(Level(level))
    system.guard(Level(level, -1.0))
    events = ns.simulate(system, 1.0).events
    times = {number: events.time[(events.cause == Cause.GUARD) & (events.contact == number)] for number in (0, 1)}
    up, down = _passages(level)
    np.testing.assert_allclose(times[0], [down], atol=1e-12)
    np.testing.assert_allclose(times[1], [up] if level > 1.0 else [], atol=1e-12)


def test_a_guard_above_the_path_never_fires_and_one_at_the_start_waits() -> None:
    """The path tops out at 1.2038 m; from zero at the start the value first rises, then falls."""
    system = _thrown()
    top = 1.0 + 4.0 / (2.0 * GRAVITY)
    system.guard(Level(top + 1e-9, -1.0))
    system.guard(Level(1.0))
    events = ns.simulate(system, 1.0).events
    fired = events.cause == Cause.GUARD
    np.testing.assert_array_equal(events.contact[fired], [1])
    np.testing.assert_allclose(events.time[fired], [4.0 / GRAVITY], atol=1e-12)


def test_a_level_just_below_the_top_is_passed_within_a_step() -> None:
    """The ball is below the level at both ends of the only step, 1 mm of 12 mm below the top in its middle."""
    ball, speed, below = Ball(0.01), 0.05 * GRAVITY, 1e-3
    system = ns.System([ball], gravity=GRAVITY)
    system.place(ball, velocity=(0.0, 0.0, speed))
    system.guard(Level(0.5 * speed**2 / GRAVITY - below, -1.0))
    events = ns.simulate(system, 0.1, sample_interval=0.1).events
    np.testing.assert_allclose(events.time[1:], [0.05 - math.sqrt(2.0 * below / GRAVITY)], rtol=0, atol=1e-11)


def test_a_clock_fires_once_per_period() -> None:
    """Many zeros of one guard, none missed, none twice."""
    system = _thrown()
    system.guard(Clock(20.0))
    events = ns.simulate(system, 1.0, engine=ns.EventDriven(largest_step=1.0 / 80.0)).events
    np.testing.assert_allclose(events.time[events.cause == Cause.GUARD], (np.arange(20) + 0.5) / 20.0, atol=1e-12)


def test_a_guard_ends_the_run(build: Any) -> None:
    """The solution ends where the guard fires, between two bounces, and says why."""
    ball = Ball(radius=0.01)
    system = build.over(ball, restitution=0.5, friction=0.0)
    system.place(ball, position=(0.0, 0.0, 0.11))
    system.guard(Level(0.03, last=True))
    solution = ns.simulate(system, 1.0)
    assert solution.status == "done"
    assert solution.message == "a guard of the scenario ended the run"
    np.testing.assert_allclose(solution.t_end, math.sqrt(2.0 * 0.08 / GRAVITY), atol=1e-12)
    assert solution.events.causes()[-1] == "guard of the scenario"
    np.testing.assert_allclose(solution.q_end[2], 0.03, atol=1e-12)


def _logarithm(t: float, q: Floats, u: Floats, level: float) -> float:
    return math.log(q[2] - level) if q[2] > level else math.nan


def _broken(t: float, q: Floats, u: Floats, level: float) -> float:
    raise ArithmeticError("no value at all")


@final
@dataclass(frozen=True)
class Wrong(Guard):
    """A guard that has no value below its level, or none anywhere."""

    level: float = parameter(doc="height", unit="m")
    raises: bool = False

    @property
    def value(self) -> Callable[..., float]:
        """No number everywhere."""
        return _broken if self.raises else _logarithm

    @property
    def ends_run(self) -> bool:
        """Never."""
        return False

    def parameters(self) -> dict[str, float]:
        """Return the number only."""
        return {"level": self.level}


@pytest.mark.parametrize(("guard", "word"), [(Wrong(2.0), "nan"), (Wrong(0.5, raises=True), "no value at all")])
def test_a_guard_without_a_value_at_the_start_is_refused(guard: Wrong, word: str) -> None:
    """Before anything runs, by name and value."""
    system = _thrown()
    system.guard(guard)
    with pytest.raises(ns.InvalidInput, match=r"Wrong\.value must return a finite number at the start") as caught:
        ns.simulate(system, 1.0)
    assert word in str(caught.value)


def test_a_guard_that_loses_its_value_ends_the_run() -> None:
    """The error names it, and what was computed is kept."""
    system = _thrown()
    system.guard(Wrong(0.9))
    with pytest.raises(ns.RunFailed, match="guard 'wrong': _logarithm") as caught:
        ns.simulate(system, 1.0)
    solution = caught.value.solution
    assert isinstance(solution, ns.Solution)
    assert solution.status == "failed"


def test_other_things_are_refused() -> None:
    """A guard is a Guard."""
    with pytest.raises(ns.InvalidInput, match=r"System\.guard needs a Guard"):
        _thrown().guard(lambda t, q, u: 1.0)  # type: ignore[arg-type]
