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
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.derivatives.passage import Signature
from nonsmooth.studies.derivatives.slope import OrderOfEvents, Sampled, slope
from nonsmooth.studies.orbits.linear import STEPS, smooth
from nonsmooth.studies.orbits.margins import Foretold, Margins, foretold, margins
from nonsmooth.studies.orbits.periodic import NoOrbit, Orbit
from nonsmooth.studies.orbits.sections import Section, Strobe

Floats = NDArray[np.float64]
_CLOSE = 1e-11
_CORRECTIONS = 12
_FIRST, _LARGEST, _SMALLEST = 1e-2, 5e-2, 1e-6
"""Steps along the arc; a step of 1 changes the parameter by its range, or a coordinate by its scale."""
_MOST = 2000
_ALONG = 1e-5
"""Change of the parameter over its range: of what it does no more than some digits are needed."""
_GROWS = 1.3
_KNOWN = 1e-9
"""How well margins tell the parameter at which events change, over its value or its range, where no more is looked."""


@final
@dataclass(frozen=True)
class Special:
    """Where something happens to an orbit.

    Attributes
    ----------
    kind : str
        "fold", "period doubling", "Neimark-Sacker"; where the branch ends as events change "grazing", "corner" where
        two impacts come to be at once, or "sequence" for all others.
    value : float
        The parameter there; where events change for another reason than the two, that of the last orbit.
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
    margins : tuple of Margins
        How far each is from grazing, and from two impacts at once.
    special : tuple of Special
        What happens on the way.
    ending : str
        Why it ended.
    """

    name: str
    values: Floats
    orbits: tuple[Orbit, ...]
    margins: tuple[Margins, ...]
    special: tuple[Special, ...]
    ending: str


@final
@dataclass(frozen=True)
class _Point:
    """An orbit with the way on: along its chart, and in the parameter over its range, which is the last number.

    ``along`` is how far it is from where the branch began.
    """

    orbit: Orbit
    tangent: Floats
    along: float


@final
@dataclass(frozen=True)
class _Path:
    """What is followed, over which range of which parameter; ``section`` gives that of a value."""

    family: Family
    name: str
    low: float
    high: float
    section: Callable[[float], Section]
    within: tuple[str, ...] | None

    @property
    def range(self) -> float:
        return self.high - self.low

    def value(self, point: _Point) -> float:
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
        value = self.value(point)
        m, moved = len(point.tangent) - 1, step * point.tangent
        for _ in range(_CORRECTIONS):
            there = value + moved[m] * self.range
            if not self.low <= there <= self.high:
                raise _OutOfRange(there)
            state = chart.moved(self.family.model(**{self.name: there}), start, moved[:m])
            try:
                orbit, rest = self.at(state, there, point.tangent, (point.orbit.map.step,))
            except OrderOfEvents:
                orbit, rest = self.at(state, there, point.tangent)
            along, tangent = rest[:m], rest[m:]
            off = float(point.tangent @ moved - step)
            if orbit.residual <= _CLOSE and abs(off) <= _CLOSE:
                return _Point(orbit, tangent, point.along + step)
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
    progress: Callable[[Orbit, int], None] | None = None,
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
        The period [s] of what drives the system at a value of the parameter; that of the orbit by default.
    most : int
        Steps at most, either way.
    progress : callable, optional
        Called with each orbit found and their number.

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
    section: Callable[[float], Section] = (lambda _: orbit.section) if period is None else lambda v: Strobe(period(v))
    path = _Path(orbit.family, name, low, high, section, orbit.within)
    first, rest = path.at(orbit.state, value, None)
    tangent = rest[len(first.map.way) :]
    up = tangent if tangent[-1] >= 0.0 else -tangent
    count = 0

    def told(found: Orbit) -> None:
        nonlocal count
        count += 1
        if progress is not None:
            progress(found, count)

    back, on = (_followed(path, _Point(first, way, 0.0), most, told) for way in (-up, up))
    orbits = (*reversed(back.orbits), first, *on.orbits)
    values = np.array([one.family[name] for one in orbits])
    nearness = (*reversed(back.margins[1:]), *on.margins)
    special = (*reversed(back.special), *on.special)
    return Branch(name, values, orbits, nearness, special, f"{back.ending}; {on.ending}")


@final
@dataclass(frozen=True)
class _Way:
    """What was found on one of the two ways on from an orbit, whose margins come first."""

    orbits: list[Orbit]
    margins: list[Margins]
    special: list[Special]
    ending: str


def _followed(path: _Path, point: _Point, most: int, told: Callable[[Orbit], None]) -> _Way:
    found, left, special, step = [point], [margins(point.orbit)], list[Special](), _FIRST
    ending, bound = f"{most} steps", np.inf
    while len(found) <= most:
        try:
            following = path.corrected(point, step)
            if following.orbit.events != point.orbit.events:
                raise OrderOfEvents(point.orbit.events, following.orbit.events)
        except (_OutOfRange, NoOrbit, OrderOfEvents, InvalidInput, RunFailed) as error:
            what = None if isinstance(error, _OutOfRange) else _behind(path, found, left)
            known = what is not None and what.error <= _KNOWN * max(path.range, abs(what.value))
            if step > _SMALLEST and not known:
                bound, step = point.along + step, 0.5 * step
                continue
            ending = "the end of the range"
            if not isinstance(error, _OutOfRange):
                value, kind = (path.value(point), "sequence") if what is None else (what.value, what.kind)
                special.append(Special(kind, value, point.orbit))
                ending = f"events change ({error})"
            break
        special += _between(path, point, step, following)
        found.append(following)
        left.append(margins(following.orbit))
        told(following.orbit)
        point, step = following, min(_GROWS * step, _LARGEST)
        # where nothing was found half of the way is likely to lead to something
        if bound > point.along:
            step = min(step, max(0.5 * (bound - point.along), _SMALLEST))
    return _Way([one.orbit for one in found[1:]], left, special, ending)


def _behind(path: _Path, found: Sequence[_Point], left: Sequence[Margins]) -> Foretold | None:
    """Return what happens behind the last of some points."""
    along, values = (np.array(row) for row in zip(*((one.along, path.value(one)) for one in found), strict=True))
    return foretold(along, values, left)


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
