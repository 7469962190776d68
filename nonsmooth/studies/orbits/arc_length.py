"""Predictor and corrector of pseudo-arclength continuation: orbits on a branch, and the tangent of the branch."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.differences import SECOND, OrderOfEvents, Sampled, derivative, slope
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.derivatives.flow import Signature
from nonsmooth.studies.orbits.linear import linear
from nonsmooth.studies.orbits.periodic import NoOrbit, Orbit
from nonsmooth.studies.orbits.sections import Section
from nonsmooth.types import Array

_CLOSE = 1e-11
"""Largest residual of an orbit on the branch, relative to the scales of the coordinates."""
_CORRECTIONS = 12
"""Largest number of steps of Newton's method that correct a predicted orbit; then a smaller step of arc length is
tried."""
_FIRST = 1e-3
"""Largest step of the finite differences of the period map with respect to the parameter, relative to the largest
absolute value in the parameter's range.  Smaller steps follow until the error is below ``_ENOUGH``."""
_ENOUGH = 1e-4
"""Relative error of the derivative of the period map with respect to the parameter at which no smaller step is tried.
This derivative only directs the steps of the continuation."""


class OutOfRange(Exception):
    """A step leads out of the range of the parameter."""


@final
@dataclass(frozen=True)
class ContinuationPoint:
    """An orbit of a branch, and the tangent of the branch there.

    Attributes
    ----------
    orbit : Orbit
        The orbit.
    by : array
        Derivative of the state after one period with respect to the parameter divided by its range, shape [m].  Its
        components belong to the directions of ``orbit.map.chart``.
    step : float
        Step of the finite difference that gives this derivative, in the unit of the parameter.
    tangent : array
        Unit tangent of the branch, shape [m + 1]: along the directions of the chart, then along the parameter in units
        of its range.
    along : float
        Arc length from the start of the branch [1].
    """

    orbit: Orbit
    by: Array
    step: float
    tangent: Array
    along: float


@final
@dataclass(frozen=True)
class Path:
    """The orbits of a family over a range of a parameter; ``section(value)`` returns the section at a value."""

    family: Family
    name: str
    low: float
    high: float
    section: Callable[[float], Section]
    within: tuple[str, ...] | None

    @property
    def range(self) -> float:
        """Width of the range of the parameter."""
        return self.high - self.low

    def value(self, point: ContinuationPoint) -> float:
        """Return the value of the parameter at a point of the branch."""
        return point.orbit.family[self.name]

    def at(
        self, state: State, value: float, along: float, before: ContinuationPoint | None, *, is_quick: bool = False
    ) -> ContinuationPoint:
        """Return the continuation point of a state at a value of the parameter.

        ``along`` is the arc length of the branch up to the point [1].  ``before`` is a point of the branch nearby, None
        at its first point: the new tangent has the sense of the tangent of ``before``.  With ``is_quick``, derivatives
        use the step sizes of ``before`` and get no error estimates, which is enough for a step of Newton's method.

        Raises
        ------
        OrderOfEvents
            If the map lacks a derivative.
        """
        family = self.family.at(**{self.name: value})
        section = self.section(value)
        near = before if is_quick else None
        found = linear(family.model(), state, section, self.within, near and near.orbit.map.step, is_smooth=True)

        def changed(change: float) -> tuple[Array, Signature]:
            there = value + change
            model = self.family.model(**{self.name: there})
            # closed contacts stay closed as the parameter moves bodies
            begin = found.chart.held_in(model, state)
            end = self.section(there).flow(model, begin)
            return found.chart.between(begin, end.state), end.signature

        by, step = self._by(changed, found.end.signature, near)
        tangent = np.linalg.svd(np.column_stack([found.matrix - np.eye(len(found.way)), by]))[2][-1]
        if before is not None and tangent @ before.tangent < 0.0:
            tangent = -tangent
        residual = float(np.max(np.abs(found.way), initial=0.0))
        return ContinuationPoint(Orbit(family, state, section, self.within, residual, found), by, step, tangent, along)

    def _by(self, changed: Sampled, expected: Signature, near: ContinuationPoint | None) -> tuple[Array, float]:
        """Return the derivative of the period map with respect to the parameter divided by its range, and a step.

        The step is the step of the finite difference, in the unit of the parameter.
        """
        if near is not None:
            with contextlib.suppress(OrderOfEvents, InvalidInput):
                return self.range * slope(changed, near.step, expected, SECOND), near.step
        largest = _FIRST * max(abs(self.low), abs(self.high))
        found = derivative(changed, largest, expected, _ENOUGH)
        return self.range * found.value, found.step

    def corrected(self, point: ContinuationPoint, step: float) -> ContinuationPoint:
        """Return the orbit of the branch at a ``step`` from ``point``, by Newton's method (corrector).

        The step is the displacement from ``point`` to the new orbit, along the tangent of ``point`` [1].

        Raises
        ------
        NoOrbit
            If Newton's method does not converge.
        OrderOfEvents
            If the order of events changes.
        OutOfRange
            If the parameter leaves its range.
        """
        start, chart = point.orbit.state, point.orbit.map.chart
        value = self.value(point)
        m, moved = len(point.tangent) - 1, step * point.tangent
        for _ in range(_CORRECTIONS):
            there = value + moved[m] * self.range
            if not self.low <= there <= self.high:
                raise OutOfRange(there)
            state = chart.moved(self.family.model(**{self.name: there}), start, moved[:m])
            here = self.at(state, there, point.along + step, point, is_quick=True)
            off = float(point.tangent @ moved - step)
            if here.orbit.residual <= _CLOSE and abs(off) <= _CLOSE:
                return self.at(state, there, point.along + step, point)
            matrix = np.zeros((m + 1, m + 1))
            matrix[:m, :m], matrix[:m, m] = here.orbit.map.matrix - np.eye(m), here.by
            matrix[m] = point.tangent
            moved = moved + np.linalg.lstsq(matrix, -np.append(here.orbit.map.way, off), rcond=1e-12)[0]
            if not np.max(np.abs(moved)) < 10.0:
                break
        raise NoOrbit(
            f"Newton's method leaves {here.orbit.residual:.2g} of the scales near {self.name} = {there:.9g}; "
            "call orbit(...) there to see whether there is one"
        )
