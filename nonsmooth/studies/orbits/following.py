"""Orbits followed along a parameter, round folds, by the arc length; and the points where their stability changes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.checks import check_callable, is_finite
from nonsmooth.errors import InvalidInput, RunFailed
from nonsmooth.progress import Display, Pace, RangeCovered
from nonsmooth.studies.derivatives.slope import OrderOfEvents
from nonsmooth.studies.displays import display_of
from nonsmooth.studies.orbits.branch import Branch, Special
from nonsmooth.studies.orbits.margins import Foretold, Margins, foretold, margins
from nonsmooth.studies.orbits.path import OutOfRange, Path, Point
from nonsmooth.studies.orbits.periodic import NoOrbit, Orbit
from nonsmooth.studies.orbits.repeating import FUNCTION, period_at
from nonsmooth.studies.orbits.sections import Section

Floats = NDArray[np.float64]
_FIRST, _LARGEST, _SMALLEST = 1e-2, 5e-2, 1e-6
"""Steps along the arc; a step of 1 changes the parameter by its range, or a coordinate by its scale."""
_MOST = 2000
_GROWS = 1.3
_SAME = 1e-6
"""What a motion may differ by from the same a period later, for round-off."""
_SHARES = tuple(0.5**i for i in range(11))
"""Parts of the way to an end of the range at which that is looked at, until a motion can begin there."""
_KNOWN = 1e-9
"""How well margins tell the parameter at which events change, over its value or its range, where no more is looked."""


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
        The period [s] of what drives the system at a value of the parameter; that of the orbit by default.
    most : int
        Steps at most, either way.
    display : Display, optional
        Where progress is shown; on standard error by default, ``nonsmooth.progress.Quiet()`` shows nothing.

    Raises
    ------
    UnknownName
        If the family has no such parameter.
    InvalidInput
        If the range is none, the orbit has corners, or the system has another period somewhere in the range.
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
    check_callable("continuation: period", period, "period(value)")
    section: Callable[[float], Section] = (
        (lambda _: orbit.section)
        if period is None
        else lambda v: orbit.section.lasting(period_at(period, v, "continuation: period"))
    )
    path = Path(orbit.family, name, low, high, section, orbit.within)
    _check_period(path, orbit)
    first = path.at(orbit.state, value, 0.0, None)
    up = first.tangent if first.tangent[-1] >= 0.0 else -first.tangent
    with Pace(display_of(display)) as pace:
        covered = RangeCovered(pace, name, value, span)
        back, on = (_followed(path, replace(first, tangent=way), most, covered) for way in (-up, up))
    orbits = (*reversed(back.orbits), first.orbit, *on.orbits)
    values = np.array([one.family[name] for one in orbits])
    nearness = (*reversed(back.margins[1:]), *on.margins)
    special = (*reversed(back.special), *on.special)
    return Branch(name, values, orbits, nearness, special, f"{back.ending}; {on.ending}")


def _check_period(path: Path, orbit: Orbit) -> None:
    """Look at both ends of the range whether a motion that begins a period later is the same.

    Where the orbit's state is none at an end, as bodies would overlap, nearer values tell.

    Raises
    ------
    InvalidInput
        If it is not.
    """
    value = orbit.family[path.name]
    for end in (path.low, path.high):
        for there in (value + share * (end - value) for share in _SHARES):
            if (off := _shifted(path, orbit, there)) is not None:
                break
        if off is not None and off > _SAME:
            rule = (
                f"must be one of the system at {path.name} = {there:.9g}, where the same motion a period later differs "
                f"by {off:.2g} of its size"
            )
            raise InvalidInput("continuation: period", rule, float(f"{orbit.period:.9g}"), FUNCTION)


def _shifted(path: Path, orbit: Orbit, value: float) -> float | None:
    """Return by how much a motion differs that begins a period later, in units of scales; None if none can begin."""
    model, section, start = path.family.model(**{path.name: value}), path.section(value), orbit.state
    try:
        one = section.passage(model, start).state
        two = section.passage(model, replace(start, time=one.time)).state
    except (InvalidInput, RunFailed):
        return None
    return float(np.max(np.abs(orbit.map.chart.between(one, two)), initial=0.0))


@final
@dataclass(frozen=True)
class _Way:
    """What was found on one of the two ways on from an orbit, whose margins come first."""

    orbits: list[Orbit]
    margins: list[Margins]
    special: list[Special]
    ending: str


def _followed(path: Path, point: Point, most: int, covered: RangeCovered) -> _Way:
    found, left, special, step = [point], [margins(point.orbit)], list[Special](), _FIRST
    ending, bound = f"{most} steps", np.inf
    while len(found) <= most:
        try:
            following = path.corrected(point, step)
            if following.orbit.events != point.orbit.events:
                raise OrderOfEvents(point.orbit.events, following.orbit.events)
        except (OutOfRange, NoOrbit, OrderOfEvents, InvalidInput, RunFailed) as error:
            what = None if isinstance(error, OutOfRange) else _behind(path, found, left)
            known = what is not None and what.error <= _KNOWN * max(path.range, abs(what.value))
            if step > _SMALLEST and not known:
                bound, step = point.along + step, 0.5 * step
                continue
            if isinstance(error, OutOfRange):
                ending = "the end of the range"
            elif what is None and not isinstance(error, OrderOfEvents):
                ending = f"no orbit farther on ({error})"
            else:
                value, kind = (path.value(point), "sequence") if what is None else (what.value, what.kind)
                special.append(Special(kind, value, point.orbit))
                ending = f"events change ({error})"
            break
        special += _between(path, point, step, following)
        found.append(following)
        left.append(margins(following.orbit))
        covered.add(path.value(following))
        point, step = following, min(_GROWS * step, _LARGEST)
        # where nothing was found half of the way is likely to lead to something
        if bound > point.along:
            step = min(step, max(0.5 * (bound - point.along), _SMALLEST))
    return _Way([one.orbit for one in found[1:]], left, special, ending)


def _behind(path: Path, found: Sequence[Point], left: Sequence[Margins]) -> Foretold | None:
    """Return what happens behind the last of some points."""
    along, values = (np.array(row) for row in zip(*((one.along, path.value(one)) for one in found), strict=True))
    return foretold(along, values, left)


def _between(path: Path, one: Point, step: float, two: Point) -> list[Special]:
    """Return the special points between two neighbours."""
    from scipy.optimize import brentq

    found = []
    for kind, test in _TESTS.items():
        if test(one) * test(two) < 0.0:

            def along(length: float, test: Callable[[Point], float] = test) -> float:
                return test(path.corrected(one, length) if length > 0.0 else one)

            there = path.corrected(one, brentq(along, 0.0, step, xtol=1e-13)).orbit
            found.append(Special(kind, there.family[path.name], there))
    return found


def _doubling(point: Point) -> float:
    matrix = point.orbit.map.matrix
    return float(np.linalg.det(matrix + np.eye(len(matrix))))


def _torus(point: Point) -> float:
    """Return the square of the largest absolute value of the complex multipliers, less 1; -1 without any."""
    values = point.orbit.multipliers
    pairs = values[np.abs(values.imag) > 1e-9]
    return float(np.max(np.abs(pairs) ** 2, initial=0.0)) - 1.0


_TESTS: dict[str, Callable[[Point], float]] = {
    "fold": lambda point: float(point.tangent[-1]),
    "period doubling": _doubling,
    "Neimark-Sacker": _torus,
}
"""What changes its sign where something happens, by what does."""
