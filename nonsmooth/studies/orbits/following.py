"""Orbits followed along a parameter, round folds, by the arc length; and the points where their stability changes."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from nonsmooth.checks import is_finite
from nonsmooth.errors import InvalidInput, RunFailed
from nonsmooth.progress import Display, Pace, RangeCovered, on_standard_error
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.derivatives.passage import Signature, passage
from nonsmooth.studies.derivatives.slope import OrderOfEvents, Sampled, slope
from nonsmooth.studies.orbits.linear import STEPS, linear
from nonsmooth.studies.orbits.periodic import NoOrbit, Orbit

Floats = NDArray[np.float64]
_CLOSE = 1e-11
_CORRECTIONS = 12
_FIRST, _LARGEST, _SMALLEST = 1e-2, 5e-2, 1e-6
"""Steps along the arc; a step of 1 changes the parameter by its range, or a coordinate by its scale."""
_MOST = 2000
_ALONG = 1e-5
"""Change of the parameter over its range: of what it does no more than some digits are needed."""
_GROWS = 1.3


@final
@dataclass(frozen=True)
class Special:
    """Where something happens to an orbit.

    Attributes
    ----------
    kind : str
        "fold", "period doubling", "Neimark-Sacker", or "sequence" where the branch ends as events change.
    value : float
        The parameter there.
    orbit : Orbit
        The orbit there, the last one of its events where these change.
    """

    kind: str
    value: float
    orbit: Orbit


@final
@dataclass(frozen=True)
class Branch:
    """Orbits along a parameter.

    Attributes
    ----------
    name : str
        The parameter.
    values : array
        Its values, shape [n].
    orbits : tuple of Orbit
        The orbits.
    special : tuple of Special
        What happens on the way.
    ending : str
        Why it ended.
    """

    name: str
    values: Floats
    orbits: tuple[Orbit, ...]
    special: tuple[Special, ...]
    ending: str


@final
@dataclass(frozen=True)
class _Point:
    """An orbit with the way on: along its chart, and in the parameter over its range, which is the last number."""

    orbit: Orbit
    tangent: Floats


@final
@dataclass(frozen=True)
class _Path:
    """What is followed, over which range of which parameter; ``period`` gives that of a value [s]."""

    family: Family
    name: str
    low: float
    high: float
    period: Callable[[float], float]
    within: tuple[str, ...] | None

    @property
    def range(self) -> float:
        return self.high - self.low

    def at(
        self, state: State, value: float, way: Floats | None, steps: Sequence[float] = STEPS
    ) -> tuple[Orbit, Floats]:
        """Return the map about a state as an orbit, what the parameter does, and the tangent, on along a way if given.

        The last two are one array, shape [2 m + 1].
        """
        family = self.family.at(**{self.name: value})
        period = self.period(value)
        found = linear(family.model(), state, state.time + period, self.within, steps)
        if found.corners:
            raise OrderOfEvents(found.end.signature, found.corners[0].signatures[0])

        def changed(change: float) -> tuple[Floats, Signature]:
            there = value + change * self.range
            end = passage(self.family.model(**{self.name: there}), state, state.time + self.period(there))
            return found.chart.between(state, end.state), end.signature

        along = _first_slope(changed, found.end.signature)
        matrix = np.column_stack([found.matrix - np.eye(len(found.way)), along])
        tangent = np.linalg.svd(matrix)[2][-1]
        if way is not None and tangent @ way < 0.0:
            tangent = -tangent
        residual = float(np.max(np.abs(found.way), initial=0.0))
        return Orbit(family, state, period, self.within, residual, found), np.concatenate([along, tangent])

    def corrected(self, point: _Point, step: float) -> _Point:
        """Return the point on the branch whose projection on the way on from a point is a step.

        Raises
        ------
        NoOrbit
            If Newton's method does not arrive.
        OrderOfEvents
            If events change on the way.
        """
        start, chart = point.orbit.state, point.orbit.map.chart
        value = point.orbit.family[self.name]
        m, moved = len(point.tangent) - 1, step * point.tangent
        for _ in range(_CORRECTIONS):
            state = chart.moved(start, moved[:m])
            there = value + moved[m] * self.range
            if not self.low <= there <= self.high:
                raise _OutOfRange(there)
            try:
                orbit, rest = self.at(state, there, point.tangent, (point.orbit.map.step,))
            except OrderOfEvents:
                orbit, rest = self.at(state, there, point.tangent)
            along, tangent = rest[:m], rest[m:]
            off = float(point.tangent @ moved - step)
            if orbit.residual <= _CLOSE and abs(off) <= _CLOSE:
                return _Point(orbit, tangent)
            matrix = np.zeros((m + 1, m + 1))
            matrix[:m, :m], matrix[:m, m] = orbit.map.matrix - np.eye(m), along
            matrix[m] = point.tangent
            moved = moved + np.linalg.lstsq(matrix, -np.append(orbit.map.way, off), rcond=1e-12)[0]
            if not np.max(np.abs(moved)) < 10.0:
                break
        raise NoOrbit("the corrections do not arrive")


class _OutOfRange(Exception):
    pass


def continuation(
    orbit: Orbit,
    name: str,
    span: tuple[float, float],
    *,
    period: Callable[[float], float] | None = None,
    most: int = _MOST,
    display: Display | None = None,
) -> Branch:
    """Follow an orbit along a parameter, both ways, as far as a range or its events go.

    Parameters
    ----------
    orbit : Orbit
        Where to begin.
    name : str
        The parameter.
    span : tuple of float
        Its range, around the value of the orbit.
    period : callable, optional
        The period [s] at a value of the parameter; that of the orbit by default.
    most : int
        Steps at most, either way.
    display : Display, optional
        Where progress is shown; on standard error by default.

    Raises
    ------
    UnknownName
        If the family has no such parameter.
    InvalidInput
        If the range is none, or the orbit has corners.
    """
    value, (low, high) = orbit.family[name], span
    if not (is_finite(low) and is_finite(high) and low <= value <= high and low < high):
        remedy = f"The orbit has {name} = {value:.9g}."
        raise InvalidInput("continuation: span", "must be a range around the value of the orbit", span, remedy)
    if orbit.corners:
        raise InvalidInput(
            "continuation: orbit",
            "must have a derivative",
            ", ".join(corner.direction for corner in orbit.corners),
            "Leave these directions out of `within`, if the motion stays in the others.",
        )
    path = _Path(orbit.family, name, low, high, period or (lambda _: orbit.period), orbit.within)
    first, rest = path.at(orbit.state, value, None)
    tangent = rest[len(first.map.way) :]
    up = tangent if tangent[-1] >= 0.0 else -tangent
    with Pace(display or on_standard_error()) as pace:
        covered = RangeCovered(pace, name, value, span)
        back, special_back, why_back = _followed(path, _Point(first, -up), most, covered)
        on, special_on, why_on = _followed(path, _Point(first, up), most, covered)
    orbits = (*(p.orbit for p in reversed(back)), first, *(p.orbit for p in on))
    values = np.array([one.family[name] for one in orbits])
    return Branch(name, values, orbits, (*reversed(special_back), *special_on), f"{why_back}; {why_on}")


def _followed(path: _Path, point: _Point, most: int, covered: RangeCovered) -> tuple[list[_Point], list[Special], str]:
    found, special, step = list[_Point](), list[Special](), _FIRST
    while len(found) < most:
        try:
            following = path.corrected(point, step)
            if following.orbit.events != point.orbit.events:
                raise OrderOfEvents(point.orbit.events, following.orbit.events)
        except _OutOfRange:
            if step <= _SMALLEST:
                return found, special, "the end of the range"
            step *= 0.5
            continue
        except (NoOrbit, OrderOfEvents, InvalidInput, RunFailed) as error:
            if step <= _SMALLEST:
                special.append(Special("sequence", point.orbit.family[path.name], point.orbit))
                return found, special, f"events change ({error})"
            step *= 0.5
            continue
        special += _between(path, point, step, following)
        found.append(following)
        covered.add(following.orbit.family[path.name])
        point, step = following, min(_GROWS * step, _LARGEST)
    return found, special, f"{most} steps"


def _between(path: _Path, one: _Point, step: float, two: _Point) -> list[Special]:
    """Return the special points between two neighbours."""
    found = []
    for kind, test in _TESTS.items():
        if test(one) * test(two) < 0.0:

            def along(length: float, test: Callable[[_Point], float] = test) -> float:
                return test(path.corrected(one, length) if length > 0.0 else one)

            there = path.corrected(one, brentq(along, 0.0, step, xtol=1e-13)).orbit
            found.append(Special(kind, there.family[path.name], there))
    return found


def _first_slope(changed: Sampled, expected: Signature) -> Floats:
    """Return a derivative with the first step that changes no order of events."""
    for step in (_ALONG, 0.1 * _ALONG):
        with contextlib.suppress(OrderOfEvents, InvalidInput):
            return slope(changed, step, expected)
    return slope(changed, 1e-2 * _ALONG, expected)


def _doubling(point: _Point) -> float:
    matrix = point.orbit.map.matrix
    return float(np.linalg.det(matrix + np.eye(len(matrix))))


def _torus(point: _Point) -> float:
    """Return the square of the largest absolute value of the complex multipliers, less 1; -1 without any."""
    values = point.orbit.multipliers
    pairs = values[np.abs(values.imag) > 1e-9]
    return float(np.max(np.abs(pairs) ** 2, initial=0.0)) - 1.0


_TESTS: dict[str, Callable[[_Point], float]] = {
    "fold": lambda point: float(point.tangent[-1]),
    "period doubling": _doubling,
    "Neimark-Sacker": _torus,
}
"""What changes its sign where something happens, by what does."""
