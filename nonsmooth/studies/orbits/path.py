"""The path of orbits along a parameter: points on it, and the way on from them."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.extrapolation import derivative
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.derivatives.passage import Signature
from nonsmooth.studies.derivatives.slope import SECOND, OrderOfEvents, Sampled, slope
from nonsmooth.studies.orbits.linear import smooth
from nonsmooth.studies.orbits.periodic import NoOrbit, Orbit
from nonsmooth.studies.orbits.sections import Section

Floats = NDArray[np.float64]
_CLOSE = 1e-11
_CORRECTIONS = 12
_FIRST = 1e-3
"""Largest step of derivatives by the parameter, relative to its largest absolute value in the range."""
_ENOUGH = 1e-4
"""Relative error of derivatives by the parameter: they direct steps, and orbits do not depend on them."""


class OutOfRange(Exception):
    """A step leads out of the range of the parameter."""


@final
@dataclass(frozen=True)
class Point:
    """An orbit, and the direction in which the branch continues.

    Attributes
    ----------
    orbit : Orbit
        The orbit.
    by : array
        Derivative of the map by the parameter over its range, along the directions of the chart, shape [m].
    step : float
        Step of the parameter that it was taken with, in the unit of the parameter.
    tangent : array
        Unit tangent of the branch: directions of the chart, then the parameter over its range, shape [m + 1].
    along : float
        Arc length from where the branch began.
    """

    orbit: Orbit
    by: Floats
    step: float
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

    def at(self, state: State, value: float, along: float, before: Point | None, *, is_quick: bool = False) -> Point:
        """Return the map about a state with its tangent, which continues that of the point before.

        Quick derivatives use the steps of the point before and have no errors.  They serve Newton's method.

        Raises
        ------
        OrderOfEvents
            If the map lacks a derivative.
        """
        family = self.family.at(**{self.name: value})
        section = self.section(value)
        near = before if is_quick else None
        found = smooth(family.model(), state, section, self.within, near and near.orbit.map.step)

        def changed(change: float) -> tuple[Floats, Signature]:
            there = value + change
            model = self.family.model(**{self.name: there})
            # what is closed moves with what carries it
            begin = found.chart.held_in(model, state)
            end = self.section(there).passage(model, begin)
            return found.chart.between(begin, end.state), end.signature

        by, step = self._by(changed, found.end.signature, near)
        tangent = np.linalg.svd(np.column_stack([found.matrix - np.eye(len(found.way)), by]))[2][-1]
        if before is not None and tangent @ before.tangent < 0.0:
            tangent = -tangent
        residual = float(np.max(np.abs(found.way), initial=0.0))
        return Point(Orbit(family, state, section, self.within, residual, found), by, step, tangent, along)

    def _by(self, changed: Sampled, expected: Signature, near: Point | None) -> tuple[Floats, float]:
        """Return the derivative by the parameter over its range, and the step of the parameter."""
        if near is not None:
            with contextlib.suppress(OrderOfEvents, InvalidInput):
                return self.range * slope(changed, near.step, expected, SECOND), near.step
        largest = _FIRST * max(abs(self.low), abs(self.high))
        found = derivative(changed, largest, expected, _ENOUGH)
        return self.range * found.value, found.step

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
            "orbit(...) there tells whether there is one"
        )
