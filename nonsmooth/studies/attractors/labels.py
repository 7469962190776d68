"""Attractors of a study: groups of runs, matched from one value of a parameter to the next, and their labels."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.checks import check_count
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.studies.attractors.linkage import Integers, hausdorff
from nonsmooth.studies.inputs import check_positive
from nonsmooth.types import Array

if TYPE_CHECKING:
    import xarray


UNSETTLED = "unsettled"
"""Name that replaces an attractor for runs that agree with no other run."""


@final
@dataclass(frozen=True, eq=False)
class Group:
    """Runs that lead to one attractor.

    Attributes
    ----------
    runs : array
        Numbers of the runs, shape [n_runs].
    points : array
        Points of the attractor, shape [n_points, n_coordinates], in units of the scales of its coordinates, or of the
        tolerances of its features.
    period : int or None
        Number of periods after which the motion repeats, 0 if it does not.  None if the number is unknown, or not the
        same for all runs.
    """

    runs: Integers
    points: Array
    period: int | None


Grouping = Callable[[Integers], list[Group]]
"""Function that sorts runs by attractor: from the numbers of the runs, shape [n_runs], to one group per attractor."""


@final
@dataclass(frozen=True)
class Along:
    """A parameter along which attractors are matched from value to value.

    Parameters
    ----------
    parameter : str
        Name of the parameter.
    tolerance : float
        Largest Hausdorff distance between the points of an attractor at two successive values.  Coordinates count in
        units of their scales, features in units of their tolerances.
    bins : int
        Number of equal intervals of the parameter's range, into which values drawn at random are sorted.  In a grid,
        attractors are matched from each value to the next.
    """

    parameter: str
    tolerance: float
    bins: int = 10

    def __post_init__(self) -> None:
        check_positive(
            "Along: tolerance", self.tolerance, "Give how far an attractor moves from one value to the next."
        )


def matched(known: Sequence[Array], now: Sequence[Array], tolerance: float) -> list[int]:
    """Return, for each attractor of ``now``, the number of the known attractor that matches it; -1 without a match.

    As many attractors as possible are paired within the tolerance, with the least sum of distances.

    Parameters
    ----------
    known, now : sequence of array
        Points of each attractor found at earlier values of the parameter, and of each attractor found at its present
        value, shape [n_points, n_coordinates].
    tolerance : float
        Largest Hausdorff distance of a pair.

    References
    ----------
    G. Datseris, K. L. Rossi, A. Wagemakers, "Framework for global stability analysis of dynamical systems", Chaos 33
    (2023) 073151.
    """
    from scipy.optimize import linear_sum_assignment

    distances = np.array([[hausdorff(one, other) for other in known] for one in now]).reshape(len(now), len(known))
    # a pair beyond the tolerance costs more than all allowed pairs together
    costs = np.where(distances <= tolerance, distances, 1.0 + 2.0 * tolerance * min(distances.shape, default=0))
    found = [-1] * len(now)
    for i, j in zip(*linear_sum_assignment(costs), strict=True):
        if distances[i, j] <= tolerance:
            found[i] = int(j)
    return found


def joined(parts: Sequence[Sequence[Group]], tolerance: float) -> list[Group]:
    """Return the attractors at all values of a parameter; attractors that match from value to value become one group.

    An attractor may vanish and appear again.  So each new attractor is compared with the points of every known
    attractor at the last value at which this attractor was found.

    Parameters
    ----------
    parts : sequence of sequence of Group
        The attractors of each value, in the order of the values.
    tolerance : float
        Largest Hausdorff distance of a matched pair.
    """
    known = list[Group]()
    for part in parts:
        which = matched([one.points for one in known], [one.points for one in part], tolerance)
        for now, place in zip(part, which, strict=True):
            if place < 0:
                known.append(now)
            else:
                before = known[place]
                period = now.period if now.period == before.period else None
                known[place] = Group(np.append(before.runs, now.runs), now.points, period)
    return known


def labelled(
    study: xarray.Dataset, valued: NDArray[np.bool_], grouping: Grouping, along: Along | None
) -> xarray.Dataset:
    """Return a dataset with the attractor of each run.

    The variable ``attractor`` holds a number for each run, -1 for a run without records.  Its attribute
    ``flag_meanings`` holds the names of the attractors in the order of their numbers.

    Parameters
    ----------
    study : Dataset
        The study.
    valued : array
        True for runs that have records, shape [n_runs].
    grouping : callable
        Returns the groups of the runs with given numbers.
    along : Along, optional
        Parameter along which groups are matched; by default all runs are grouped at once.
    """
    import xarray

    runs = np.flatnonzero(valued)
    if along is None:
        found = grouping(runs)
    else:
        split = runs_by_value(study.status, along.parameter, along.bins)
        rows = [runs[split.of_runs[runs] == part] for part in range(len(split.values))]
        found = joined([grouping(row) for row in rows], along.tolerance)
    found.sort(key=lambda one: (-len(one.runs), one.runs.min()))
    labels, words = np.full(len(valued), -1, "int32"), [_word(i, one) for i, one in enumerate(found, 1)]
    for i, one in enumerate(found):
        labels[one.runs] = i
    left = valued & (labels < 0)
    if left.any():
        labels[left] = len(words)
        words.append(UNSETTLED)
    attributes = {"long_name": "attractor", "flag_values": list(range(len(words))), "flag_meanings": " ".join(words)}
    return xarray.Dataset({"attractor": over_runs(study, labels, attributes)}, attrs=study.attrs)


def over_runs(study: xarray.Dataset, values: NDArray[Any], attributes: dict[str, Any]) -> xarray.DataArray:
    """Return values of all runs, shape [n_runs], as an array over the axes of the study."""
    import xarray

    status = study.status
    return xarray.DataArray(values.reshape(status.shape), status.coords, status.dims, attrs=attributes)


def _word(number: int, group: Group) -> str:
    kinds = {None: "", 0: "_aperiodic"}
    return f"A{number}{kinds.get(group.period, f'_period_{group.period}')}"


def words_of(attractor: xarray.DataArray, thing: str) -> Sequence[str]:
    """Return the names of the attractors in an array of attractors; ``thing`` is the subject of the error.

    Raises
    ------
    InvalidInput
        If the array has no names (``flag_meanings``).
    """
    words = attractor.attrs.get("flag_meanings")
    if words is None:
        remedy = "Give dataset.attractor of a scenario that classifies, or what recurrences or features return."
        raise InvalidInput(thing, "needs a record of words", attractor.name, remedy)
    return str(words).split(" ")


@final
@dataclass(frozen=True, eq=False)
class RunsByValue:
    """The runs of a study, split into parts by the value of one parameter.

    Attributes
    ----------
    values : array
        Value of the parameter in each part, shape [n_parts].  If the values were drawn at random, a part is an
        interval, and its value the middle.
    of_runs : array
        Number of the part of each run, shape [n_runs].
    """

    values: NDArray[Any]
    of_runs: Integers


def runs_by_value(runs: xarray.DataArray, parameter: str, bins: int) -> RunsByValue:
    """Split the runs by a parameter.

    In a grid, the runs of each value are one part.  Values drawn at random are sorted into ``bins`` equal intervals of
    their range; the runs of each interval are one part.

    Raises
    ------
    UnknownName
        If the study does not vary the parameter.
    InvalidInput
        If `bins` is not a positive integer.
    """
    known = [str(name) for name, one in runs.coords.items() if set(one.dims) <= set(runs.dims)]
    if parameter not in known:
        raise UnknownName("varied parameter", parameter, known)
    check_count("bins", bins, "must be a positive whole number", "Leave it out.")
    values = runs[parameter].broadcast_like(runs).transpose(*runs.dims).values.ravel()
    if parameter in runs.dims or values.dtype.kind == "U":
        one, of_runs = np.unique(values, return_inverse=True)
        return RunsByValue(one, of_runs.reshape(-1))
    edges = np.linspace(values.min(), values.max(), bins + 1)
    return RunsByValue(
        0.5 * (edges[1:] + edges[:-1]), np.clip(np.searchsorted(edges, values, "right") - 1, 0, bins - 1)
    )
