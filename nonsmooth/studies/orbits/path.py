"""The path of orbits along a parameter: points on it, and the way on from them."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.derivatives.passage import Signature
from nonsmooth.studies.derivatives.slope import SECOND, OrderOfEvents, Sampled, slope
from nonsmooth.studies.orbits.linear import STEPS, smooth
from nonsmooth.studies.orbits.periodic import NoOrbit, Orbit
from nonsmooth.studies.orbits.sections import Section

Floats = NDArray[np.float64]
_CLOSE = 1e-11
_CORRECTIONS = 12
_ALONG = 1e-5
"""Change of the parameter over its range: of what it does no more than some digits are needed."""


class OutOfRange(Exception):
    """A step leads out of the range of the parameter."""


@final
@dataclass(frozen=True)
class Point:
    """An orbit with the way on: along its chart, and in the parameter over its range, which is the last number.

    ``along`` is how far it is from where the branch began.
    """

    orbit: Orbit
    tangent: Floats
    along: float


@final
@dataclass(frozen=True)
class Path:
    """What is followed, over which range of which parameter; ``section`` gives that of a value."""

    family: Family
    name: str
    low: float
    high: float
    section: Callable[[float], Section]
    within: tuple[str, ...] | None

    @property
    def range(self) -> float:
        """How far the parameter goes."""
        return self.high - self.low

    def value(self, point: Point) -> float:
        """Return the parameter of a point."""
        return point.orbit.family[self.name]

    def at(
        self, state: State, value: float, way: Floats | None, steps: Sequence[float] = STEPS
    ) -> tuple[Orbit, Floats]:
        """Return the map about a state as an orbit, what the parameter does, and the tangent, on along a way if given.

        The last two are one array, shape [2 m + 1].

        Raises
        ------
        OrderOfEvents
            If the map lacks a derivative.
        """
        family = self.family.at(**{self.name: value})
        section = self.section(value)
        found = smooth(family.model(), state, section, self.within, steps)

        def changed(change: float) -> tuple[Floats, Signature]:
            there = value + change * self.range
            model = self.family.model(**{self.name: there})
            # what is closed moves with what carries it
            begin = found.chart.held_in(model, state)
            end = self.section(there).passage(model, begin)
            return found.chart.between(begin, end.state), end.signature

        along = _first_slope(changed, found.end.signature)
        matrix = np.column_stack([found.matrix - np.eye(len(found.way)), along])
        tangent = np.linalg.svd(matrix)[2][-1]
        if way is not None and tangent @ way < 0.0:
            tangent = -tangent
        residual = float(np.max(np.abs(found.way), initial=0.0))
        return Orbit(family, state, section, self.within, residual, found), np.concatenate([along, tangent])

    def corrected(self, point: Point, step: float) -> Point:
        """Return the point on the branch whose projection on the way on from a point is a step.

        Raises
        ------
        NoOrbit
            If Newton's method does not arrive.
        OrderOfEvents
            If events change on the way.
        """
        start, chart = point.orbit.state, point.orbit.map.chart
        value = self.value(point)
        m, moved = len(point.tangent) - 1, step * point.tangent
        for _ in range(_CORRECTIONS):
            there = value + moved[m] * self.range
            if not self.low <= there <= self.high:
                raise OutOfRange(there)
            state = chart.moved(self.family.model(**{self.name: there}), start, moved[:m])
            try:
                orbit, rest = self.at(state, there, point.tangent, (point.orbit.map.step,))
            except OrderOfEvents:
                orbit, rest = self.at(state, there, point.tangent)
            along, tangent = rest[:m], rest[m:]
            off = float(point.tangent @ moved - step)
            if orbit.residual <= _CLOSE and abs(off) <= _CLOSE:
                return Point(orbit, tangent, point.along + step)
            matrix = np.zeros((m + 1, m + 1))
            matrix[:m, :m], matrix[:m, m] = orbit.map.matrix - np.eye(m), along
            matrix[m] = point.tangent
            moved = moved + np.linalg.lstsq(matrix, -np.append(orbit.map.way, off), rcond=1e-12)[0]
            if not np.max(np.abs(moved)) < 10.0:
                break
        raise NoOrbit("the corrections do not arrive")


def _first_slope(changed: Sampled, expected: Signature) -> Floats:
    """Return a derivative with the first step that changes no order of events."""
    for step in (_ALONG, 0.1 * _ALONG):
        with contextlib.suppress(OrderOfEvents, InvalidInput):
            return slope(changed, step, expected, SECOND)
    return slope(changed, 1e-2 * _ALONG, expected, SECOND)
