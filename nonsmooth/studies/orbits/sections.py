"""Sections: where a period ends, after a time or as a coordinate passes a level."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.checks import is_finite
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Guard
from nonsmooth.parameters import parameter
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.coordinates import coordinate_number, turns, whole_name
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.derivatives.passage import Passage, Signature, passage
from nonsmooth.system.system import System
from nonsmooth.types import Floats


class Section(ABC):
    """Where a period ends."""

    @abstractmethod
    def passage(self, model: Model, start: State) -> Passage:
        """Run a model from a state of the section to the next one.

        Raises
        ------
        RunFailed
            If it cannot go on.
        InvalidInput
            If it does not come back.
        """

    @abstractmethod
    def without(self, model: Model) -> tuple[str, ...]:
        """Return the coordinate that does not change within the section, if there is one."""

    def ignored(self, model: Model, state: State) -> NDArray[np.float64]:
        """Return directions in which states are taken for the same, shape [n_q + n_u, k]; none by default."""
        return np.zeros((len(state.q) + len(state.u), 0))

    def check(self, model: Model, start: State) -> None:
        """Look, by a period from a state, whether the system is as the section takes it; nothing by default.

        Raises
        ------
        InvalidInput
            If it is not.
        """
        return

    def turns(self, model: Model, start: State) -> dict[str, float]:
        """Return by how much a period turns a state [rad], by the name of the symmetry; nothing by default."""
        return {}

    @abstractmethod
    def lasting(self, period: float) -> Section:
        """Return the same with another period [s], where it is given by one."""


@final
@dataclass(frozen=True)
class Strobe(Section):
    """Once in a time that the system gives, as a plate that vibrates.

    Attributes
    ----------
    period : float
        [s].
    """

    period: float

    def passage(self, model: Model, start: State) -> Passage:
        """Run for a period."""
        return passage(model, start, start.time + self.period)

    def without(self, model: Model) -> tuple[str, ...]:
        """Return none."""
        return ()

    def lasting(self, period: float) -> Strobe:
        """Return that of the period."""
        return Strobe(period)


@final
@dataclass(frozen=True)
class Crossing(Section):
    """Where a coordinate or velocity passes a level, for systems without a period of their own.

    Attributes
    ----------
    coordinate : str
        "z", or "ball.z" where bodies share a name; no number of a quaternion.
    level : float
        In its unit.
    rising : bool
        Whether it passes upwards; else downwards.  A velocity that jumps over the level does not pass it.
    times : int
        How often it passes in a period.
    longest : float
        A motion that passes no more within so long has no orbit [s].
    """

    coordinate: str
    level: float = 0.0
    rising: bool = True
    times: int = 1
    longest: float = 100.0

    def __post_init__(self) -> None:
        """Look at the numbers.

        Raises
        ------
        InvalidInput
            If one is not valid.
        """
        if not is_finite(self.level):
            raise InvalidInput("Crossing.level", "must be a finite number", self.level, "Give it in its unit.")
        for name in ("times", "longest"):
            value = getattr(self, name)
            if not (is_finite(value) and value > 0):
                raise InvalidInput(f"Crossing.{name}", "must be positive and finite", value, "Give a larger one.")

    def watched(self, family: Family) -> Family:
        """Return a family whose runs end at the section.

        Raises
        ------
        UnknownName
            If a coordinate has no such name.
        InvalidInput
            If it belongs to a quaternion.
        """

        def make(**values: float) -> System:
            system = family.make(**values)
            system.guard(self._guard(system))
            return system

        return Family(make, family.values, family.engine, family.units)

    def entered(self, model: Model, start: State) -> State:
        """Return where a motion first passes, from a state of the system without the section."""
        spent = np.append(start.guards_spent, 0)
        return self._next(model, replace(start, guards_spent=spent)).state

    def passage(self, model: Model, start: State) -> Passage:
        """Run until the coordinate has passed as often as asked for."""
        state, told, when = start, list[tuple[int, int]](), list[float]()
        for _ in range(int(self.times)):
            piece = self._next(model, state)
            state, told, when = piece.state, [*told, *piece.signature], [*when, *piece.times]
        return Passage(state, tuple(told), tuple(when))

    def lasting(self, period: float) -> Crossing:
        """Return this one: where it is passed says how long a period is."""
        return self

    def without(self, model: Model) -> tuple[str, ...]:
        """Return the coordinate."""
        return (whole_name(model.system, coordinate_number(model.system, self.coordinate)),)

    def _next(self, model: Model, start: State) -> Passage:
        piece = passage(model, start, start.time + self.longest)
        end: Signature = ((Cause.GUARD, len(model.system.guards) - 1),)
        if piece.signature[-1:] != end:
            word = "upwards" if self.rising else "downwards"
            rule = f"must pass {self.level:.9g} {word} within {self.longest:.9g} s"
            number = coordinate_number(model.system, self.coordinate)
            before, behind = (float(np.concatenate([one.q, one.u])[number]) for one in (start, piece.state))
            remedy = (
                "Choose a level that it passes in each period, or begin nearer to the orbit. Of a coordinate that "
                "drifts take the velocity."
            )
            said = f"{before:.9g} at t = {start.time:.9g} s, {behind:.9g} at t = {piece.state.time:.9g} s"
            raise InvalidInput(f"section: {self.coordinate}", rule, said, remedy)
        return Passage(piece.state, piece.signature[:-1], piece.times[:-1])

    def _guard(self, system: System) -> Guard:
        number = coordinate_number(system, self.coordinate)
        if turns(system, number):
            remedy = "Take an angular velocity, or another body."
            raise InvalidInput("section", "must not be a number of a quaternion", self.coordinate, remedy)
        sign, n_q = -1.0 if self.rising else 1.0, sum(body.n_q for body in system.bodies)
        if number < n_q:
            return _Coordinate(float(number), self.level, sign)
        return _Velocity(float(number - n_q), self.level, sign)


def _coordinate(t: float, q: Floats, u: Floats, place: float, level: float, sign: float) -> float:
    return sign * (q[int(place)] - level)


def _velocity(t: float, q: Floats, u: Floats, place: float, level: float, sign: float) -> float:
    return sign * (u[int(place)] - level)


@final
@dataclass(frozen=True)
class _Coordinate(Guard):
    """A coordinate passes a level."""

    place: float = parameter(doc="number of the coordinate")
    level: float = parameter(doc="level in its unit")
    sign: float = parameter(doc="1 downwards, -1 upwards")

    @property
    def value(self) -> Callable[..., float]:
        """How far it is from the level."""
        return _coordinate

    @property
    def ends_run(self) -> bool:
        """Always."""
        return True


@final
@dataclass(frozen=True)
class _Velocity(Guard):
    """A velocity passes a level."""

    place: float = parameter(doc="number of the velocity")
    level: float = parameter(doc="level in its unit")
    sign: float = parameter(doc="1 downwards, -1 upwards")

    @property
    def value(self) -> Callable[..., float]:
        """How far it is from the level."""
        return _velocity

    @property
    def ends_run(self) -> bool:
        """Always."""
        return True
