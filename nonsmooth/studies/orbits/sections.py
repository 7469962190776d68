"""Sections, which end a period of a motion: at a time of the drive, or as a coordinate passes a level."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import final

import numpy as np

from nonsmooth.checks import is_finite
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Guard
from nonsmooth.parameters import parameter
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.coordinates import coordinate_number, is_in_quaternion, values_of, whole_name
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.derivatives.flow import FlowSegment, Signature, flow
from nonsmooth.studies.inputs import check_positive
from nonsmooth.system.system import System
from nonsmooth.types import Array, Floats

_CANDIDATES = 200
"""Number of equally spaced times in a period from which the time of a stroboscopic section is chosen: the time that is
farthest from all events."""
_CLOSED, _SLIDES = 1, 4
"""Bits of the mode code of a contact: closed, and sliding."""


class Section(ABC):
    """Set of states at which a period of a motion ends."""

    @abstractmethod
    def flow(self, model: Model, start: State) -> FlowSegment:
        """Run a model from a state of the section to its next return.

        Raises
        ------
        RunFailed
            If the run cannot continue.
        InvalidInput
            If the motion does not return to the section.
        """

    @abstractmethod
    def with_period(self, period: float) -> Section:
        """Return the section for another period of the drive [s]; a section without a period is returned unchanged."""

    def fixed(self, model: Model) -> tuple[str, ...]:
        """Return the names of coordinates that are constant on the section; none by default."""
        return ()

    def ignored(self, model: Model, state: State) -> Array:
        """Return the directions of symmetry at a state, shape [n_q + n_u, k]; by default there are none.

        States that differ only along these directions belong to the same orbit.
        """
        return np.zeros((len(state.q) + len(state.u), 0))

    def check(self, model: Model, start: State) -> None:
        """Raise InvalidInput if the motion over one period from ``start`` violates an assumption of the section.

        By default nothing is checked.
        """
        return

    def turns(self, model: Model, start: State) -> dict[str, float]:
        """Return the angle by which a state has turned after one period [rad], by symmetry; empty by default."""
        return {}


@final
@dataclass(frozen=True)
class StroboscopicSection(Section):
    """One state per period of a drive, such as a vibrating plate.

    Attributes
    ----------
    period : float
        The period [s].
    """

    period: float

    def flow(self, model: Model, start: State) -> FlowSegment:
        """Run a model from a state for one period of the drive."""
        return flow(model, start, start.time + self.period)

    def with_period(self, period: float) -> StroboscopicSection:
        """Return the section of another period [s]."""
        return StroboscopicSection(period)


@final
@dataclass(frozen=True)
class PoincareSection(Section):
    """A coordinate or velocity passes a level: the section of a system without a drive.

    Attributes
    ----------
    coordinate : str
        Name of the coordinate or velocity: "z", or "ball.z" if bodies share a name; no component of a quaternion.
    level : float
        The level, in the unit of the coordinate.
    rising : bool
        True if it passes upwards.  A velocity that jumps over the level does not pass it.
    times : int
        Number of passages in a period.
    longest : float
        Longest time between passages; a motion that takes longer has no orbit [s].

    Raises
    ------
    InvalidInput
        If the level is not finite, or ``times`` or ``longest`` is not positive.
    """

    coordinate: str
    level: float = 0.0
    rising: bool = True
    times: int = 1
    longest: float = 100.0

    def __post_init__(self) -> None:
        if not is_finite(self.level):
            raise InvalidInput("PoincareSection.level", "must be a finite number", self.level, "Give it in its unit.")
        for name in ("times", "longest"):
            check_positive(f"PoincareSection.{name}", getattr(self, name), "Give a larger one.")

    def guarded(self, family: Family) -> Family:
        """Return a family whose runs end at the section.

        Raises
        ------
        UnknownName
            If the system has no coordinate or velocity of this name.
        InvalidInput
            If the coordinate is a component of a quaternion.
        """

        def make(**values: float) -> System:
            system = family.make(**values)
            system.guard(self._guard(system))
            return system

        return Family(make, family.values, family.engine, family.units)

    def first(self, model: Model, start: State) -> State:
        """Return the state at the first passage of a motion from ``start``.

        ``model`` has the guard that :meth:`guarded` adds; ``start`` is a state of the system without this guard.
        """
        return self._next(model, replace(start, guards_spent=np.append(start.guards_spent, 0))).state

    def flow(self, model: Model, start: State) -> FlowSegment:
        """Run until the coordinate has passed the level ``times`` times."""
        state, signature, times = start, list[tuple[int, int]](), list[float]()
        for _ in range(int(self.times)):
            segment = self._next(model, state)
            state = segment.state
            signature += segment.signature
            times += segment.times
        return FlowSegment(state, tuple(signature), tuple(times))

    def with_period(self, period: float) -> PoincareSection:
        """Return this section unchanged: its period is the time between passages, which no drive prescribes."""
        return self

    def fixed(self, model: Model) -> tuple[str, ...]:
        """Return the name of the coordinate that passes the level."""
        return (whole_name(model.system, coordinate_number(model.system, self.coordinate)),)

    def _next(self, model: Model, start: State) -> FlowSegment:
        segment = flow(model, start, start.time + self.longest)
        end: Signature = ((Cause.GUARD, len(model.system.guards) - 1),)
        if segment.signature[-1:] != end:
            word = "upwards" if self.rising else "downwards"
            rule = f"must pass {self.level:.9g} {word} within {self.longest:.9g} s"
            number = coordinate_number(model.system, self.coordinate)
            remedy = (
                "Choose a level that it passes in each period, or begin nearer to the orbit. Of a coordinate that "
                "drifts take the velocity."
            )
            ends = (f"{values_of(one)[number]:.9g} at t = {one.time:.9g} s" for one in (start, segment.state))
            raise InvalidInput(f"section: {self.coordinate}", rule, ", ".join(ends), remedy)
        return FlowSegment(segment.state, segment.signature[:-1], segment.times[:-1])

    def _guard(self, system: System) -> Guard:
        number = coordinate_number(system, self.coordinate)
        if is_in_quaternion(system, number):
            remedy = "Take an angular velocity, or another body."
            raise InvalidInput("section", "must not be a number of a quaternion", self.coordinate, remedy)
        sign, n_q = -1.0 if self.rising else 1.0, sum(body.n_q for body in system.bodies)
        is_velocity = number >= n_q
        return _Level(float(number - n_q * is_velocity), self.level, sign, float(is_velocity))


def _distance(t: float, q: Floats, u: Floats, place: float, level: float, sign: float, is_velocity: float) -> float:
    if is_velocity > 0.5:
        return sign * (u[int(place)] - level)
    return sign * (q[int(place)] - level)


@final
@dataclass(frozen=True)
class _Level(Guard):
    """Ends a run as a coordinate or velocity passes a level."""

    place: float = parameter(doc="number of the coordinate or velocity")
    level: float = parameter(doc="level in its unit")
    sign: float = parameter(doc="1 downwards, -1 upwards")
    is_velocity: float = parameter(doc="1 of a velocity, 0 of a coordinate")

    @property
    def value(self) -> Callable[..., float]:
        """Function that returns the signed distance from the level."""
        return _distance

    @property
    def ends_run(self) -> bool:
        """True: the run ends at the level."""
        return True


def clearest_state(model: Model, begin: State, period: float) -> State:
    """Return the state in the period after ``begin`` that is farthest from all events.

    If all contacts are open at some time, it is the state whose least gap is largest.  Otherwise it is a state with the
    fewest constraints of closed contacts, and among these the one with the longest time to the nearest event.
    """
    times = begin.time + period * (np.arange(_CANDIDATES) + 0.5) / _CANDIDATES
    run = model.run(begin.time + period, start=begin, sample_interval=period)
    which = np.searchsorted(run.events.time, times, side="right") - 1
    codes = run.events.after[which]
    closed = codes & _CLOSED
    constraints = np.sum(closed * np.where(codes & _SLIDES, 1, 2), axis=1)
    if np.any(constraints == 0):
        gaps = run.history("gap", times=times)["gap"].reshape(_CANDIDATES, -1)
        distance = np.where(constraints > 0, -np.inf, np.min(gaps, axis=1, initial=np.inf))
    else:
        apart = np.abs(times[:, None] - run.events.time[1:])
        from_events = np.min(np.minimum(apart, np.abs(period - apart)), axis=1, initial=np.inf)
        distance = np.where(constraints > np.min(constraints), -np.inf, from_events)
    return state_at(model, begin, float(times[np.argmax(distance)]))


def state_at(model: Model, begin: State, time: float) -> State:
    """Return the state of a motion at a time [s]."""
    return flow(model, begin, time).state if time > begin.time else begin


def state_at_phase(model: Model, begin: State, period: float, at: float) -> State:
    """Return the state of a motion at the next time after ``begin`` that is equal to ``at`` modulo ``period`` [s]."""
    return state_at(model, begin, begin.time + (at - begin.time) % period)
