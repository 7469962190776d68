"""Branches: orbits along a parameter by pseudo-arclength continuation, and the bifurcations on the way."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import final

import numpy as np

from nonsmooth.checks import check_callable, is_finite
from nonsmooth.errors import InvalidInput, RunFailed
from nonsmooth.progress import Display, RangeCovered
from nonsmooth.studies.derivatives.differences import OrderOfEvents
from nonsmooth.studies.inputs import meter
from nonsmooth.studies.orbits.arc_length import ContinuationPoint, OutOfRange, Path
from nonsmooth.studies.orbits.grazing import GrazingDistance, grazing_distance, predicted_change
from nonsmooth.studies.orbits.periodic import NoOrbit, Orbit
from nonsmooth.studies.orbits.scan import FREQUENCY_REMEDY, period_at
from nonsmooth.studies.orbits.sections import Section
from nonsmooth.types import Array

_FIRST, _LARGEST, _SMALLEST = 1e-2, 5e-2, 1e-6
"""First, largest and smallest step of arc length, in units in which the range of the parameter and the scales of the
coordinates are 1."""
_MOST = 2000
"""Largest number of steps in each direction, by default."""
_GROWS = 1.3
"""Factor by which the step of arc length grows after each orbit that is found."""
_SAME = 1e-6
"""Two motions from one state, which begin a period apart, are equal if they differ by at most this.

It is relative to the scales of the coordinates, and larger than the errors of runs.
"""
_PARTS = tuple(0.5**i for i in range(11))
"""Parts of the distance from the orbit's parameter to an end of the range, at which the period is tested.

The test begins with the farthest value, and ends at the first value at which a motion can begin.  The last value, after
ten halvings, is a thousandth of the distance from the orbit.
"""
_KNOWN = 1e-9
"""Largest error, relative to the range, of a predicted parameter at which events change, to end the branch there.

If the error is larger, the step of arc length is halved further.
"""


@final
@dataclass(frozen=True)
class Special:
    """A special point of a branch.

    Attributes
    ----------
    kind : str
        "fold", "period doubling" or "Neimark-Sacker".  If the branch ends because events change: "grazing",
        "simultaneous impacts", or "sequence" for all other changes.
    value : float
        Value of the parameter at the point; for a "sequence", at the last orbit before the point.
    orbit : Orbit
        The orbit at the point; if events change there, the last orbit before the point.
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
        Name of the parameter.
    values : array
        Value of the parameter at each orbit, shape [n].
    orbits : tuple of Orbit
        The orbits, in their order along the branch.
    grazing_distances : tuple of GrazingDistance
        Distance of each orbit to grazing and to simultaneous impacts.
    special : tuple of Special
        Bifurcations, and changes of events at the ends.
    ending : str
        Reason why the branch ends, for each of its two ends.
    """

    name: str
    values: Array
    orbits: tuple[Orbit, ...]
    grazing_distances: tuple[GrazingDistance, ...]
    special: tuple[Special, ...]
    ending: str


def continuation(
    orbit: Orbit,
    name: str,
    span: tuple[float, float],
    *,
    period: Callable[[float], float] | None = None,
    most: int = _MOST,
    display: Display | None = None,
) -> Branch:
    """Follow a periodic orbit along a parameter, both ways, and locate its bifurcations.

    Parameters
    ----------
    orbit : Orbit
        The first orbit.
    name : str
        Name of the parameter.
    span : tuple of float
        Range of the parameter, around its value at the orbit.
    period : callable, optional
        ``period(value)`` returns the period of the drive at a value of the parameter [s]; by default the
        period of the orbit.
    most : int
        Largest number of steps in each direction.
    display : Display, optional
        Where progress is shown; on standard error by default, ``nonsmooth.progress.Quiet()`` shows nothing.

    Raises
    ------
    UnknownName
        If the family has no such parameter.
    InvalidInput
        If the range is empty, the orbit has no derivative, or the drive has another period somewhere in the range.
    """
    value, (low, high) = orbit.family[name], span
    if not (is_finite(low) and is_finite(high) and low <= value <= high and low < high):
        remedy = f"The orbit has {name} = {value:.9g}."
        raise InvalidInput("continuation: span", "must be a range around the value of the orbit", span, remedy)
    if orbit.non_differentiable:
        directions = ", ".join(point.direction for point in orbit.non_differentiable)
        remedy = "Leave these directions out of `within`, if the motion stays in the others."
        raise InvalidInput("continuation: orbit", "must have a derivative", directions, remedy)
    check_callable("continuation: period", period, "period(value)")

    def section(value: float) -> Section:
        return orbit.section if period is None else orbit.section.with_period(period_at(period, value, _PERIOD))

    path = Path(orbit.family, name, low, high, section, orbit.within)
    _check_period(path, orbit)
    first = path.at(orbit.state, value, 0.0, None)
    up = first.tangent if first.tangent[-1] >= 0.0 else -first.tangent
    with meter(display) as shown:
        covered = RangeCovered(shown, name, value, span)
        back, on = (_followed(path, replace(first, tangent=way), most, covered) for way in (-up, up))
    values, orbits = np.concatenate([back.values[:0:-1], on.values]), back.orbits[:0:-1] + on.orbits
    distances, special = back.grazing_distances[:0:-1] + on.grazing_distances, back.special[::-1] + on.special
    return Branch(name, values, orbits, distances, special, f"{back.ending}; {on.ending}")


_PERIOD = "continuation: period"


def _check_period(path: Path, orbit: Orbit) -> None:
    """Check, near both ends of the range of the parameter, that the period of the orbit is a period of the drive.

    Two motions from one state, which begin one period apart, must then be equal.  If no motion can begin at an end of
    the range, because bodies would overlap, values nearer to the parameter of the orbit are tested.

    Raises
    ------
    InvalidInput
        If the motions differ: the drive has another period at this value of the parameter.
    """
    value = orbit.family[path.name]
    for end in (path.low, path.high):
        for there in (value + part * (end - value) for part in _PARTS):
            if (off := _shifted(path, orbit, there)) is not None:
                break
        if off is not None and off > _SAME:
            rule = (
                f"must be one of the system at {path.name} = {there:.9g}, where the same motion a period later differs "
                f"by {off:.2g} of its size"
            )
            raise InvalidInput(_PERIOD, rule, float(f"{orbit.period:.9g}"), FREQUENCY_REMEDY)


def _shifted(path: Path, orbit: Orbit, value: float) -> float | None:
    """Return the difference, after one period, of two motions from one state that begin one period apart.

    It is zero if the period is a period of the drive.  It is the largest difference of a coordinate, relative to the
    scale of the coordinate.  It is None if one of the motions cannot run.
    """
    model, section, start = path.family.model(**{path.name: value}), path.section(value), orbit.state
    try:
        one = section.flow(model, start).state
        two = section.flow(model, replace(start, time=one.time)).state
    except (InvalidInput, RunFailed):
        return None
    return float(np.max(np.abs(orbit.map.chart.between(one, two)), initial=0.0))


def _followed(path: Path, point: ContinuationPoint, most: int, covered: RangeCovered) -> Branch:
    """Follow the branch from a point in one direction, for at most ``most`` steps of arc length.

    The step grows after a success and is halved after a failure.  ``covered`` displays the part of the range that is
    done.
    """
    found, distances, special, step = [point], [grazing_distance(point.orbit)], list[Special](), _FIRST
    ending, bound = f"{most} steps", np.inf
    while len(found) <= most:
        try:
            following = path.corrected(point, step)
            if following.orbit.events != point.orbit.events:
                raise OrderOfEvents(point.orbit.events, following.orbit.events)
        except (OutOfRange, NoOrbit, OrderOfEvents, InvalidInput, RunFailed) as error:
            along, values = np.array([one.along for one in found]), np.array([path.value(one) for one in found])
            change = None if isinstance(error, OutOfRange) else predicted_change(along, values, distances)
            is_known = change is not None and change.error <= _KNOWN * max(path.range, abs(change.value))
            if step > _SMALLEST and not is_known:
                bound, step = point.along + step, 0.5 * step
                continue
            if isinstance(error, OutOfRange):
                ending = "the end of the range"
            elif change is None and not isinstance(error, OrderOfEvents):
                ending = f"no orbit farther on ({error})"
            else:
                value, kind = (path.value(point), "sequence") if change is None else (change.value, change.kind)
                special.append(Special(kind, value, point.orbit))
                ending = f"events change ({error})"
            break
        special += _between(path, point, step, following)
        found.append(following)
        distances.append(grazing_distance(following.orbit))
        covered.add(path.value(following))
        point, step = following, min(_GROWS * step, _LARGEST)
        # ``bound`` is the arc length at which a step failed last: half of the distance to it is likely to succeed
        if bound > point.along:
            step = min(step, max(0.5 * (bound - point.along), _SMALLEST))
    values, orbits = np.array([path.value(one) for one in found]), tuple(one.orbit for one in found)
    return Branch(path.name, values, orbits, tuple(distances), tuple(special), ending)


def _between(path: Path, one: ContinuationPoint, step: float, two: ContinuationPoint) -> list[Special]:
    """Return the bifurcations between two successive points, at which a test function changes its sign."""
    from scipy.optimize import brentq

    found = []
    for kind, test in _TESTS.items():
        if test(one) * test(two) < 0.0:

            def along(length: float, test: Callable[[ContinuationPoint], float] = test) -> float:
                return test(path.corrected(one, length) if length > 0.0 else one)

            there = path.corrected(one, brentq(along, 0.0, step, xtol=1e-13)).orbit
            found.append(Special(kind, there.family[path.name], there))
    return found


def _doubling(point: ContinuationPoint) -> float:
    matrix = point.orbit.map.matrix
    return float(np.linalg.det(matrix + np.eye(len(matrix))))


def _torus(point: ContinuationPoint) -> float:
    """Return |z|^2 - 1 of the largest complex multiplier z; -1 if all multipliers are real."""
    values = point.orbit.multipliers
    pairs = values[np.abs(values.imag) > 1e-9]
    return float(np.max(np.abs(pairs) ** 2, initial=0.0)) - 1.0


_TESTS: dict[str, Callable[[ContinuationPoint], float]] = {
    "fold": lambda point: float(point.tangent[-1]),
    "period doubling": _doubling,
    "Neimark-Sacker": _torus,
}
"""Test function of each bifurcation, by its kind; it changes its sign at the bifurcation."""
