"""Labels of the attractors of a study."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.checks import check_count
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.studies.attractors.matching import Along, Group, Grouping, joined

if TYPE_CHECKING:
    import xarray


UNSETTLED = "unsettled"
"""Attractor of runs that agree with no other run."""


def labelled(
    study: xarray.Dataset, valued: NDArray[np.bool_], grouping: Grouping, along: Along | None
) -> xarray.Dataset:
    """Return the attractor of each run.

    Parameters
    ----------
    study : Dataset
        The study.
    valued : array
        True for runs that have records, shape [n_runs].
    grouping : callable
        Groups some runs.
    along : Along, optional
        The parameter along which groups are matched.
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
    """Return one value for each run over the axes of the study."""
    import xarray

    status = study.status
    return xarray.DataArray(values.reshape(status.shape), status.coords, status.dims, attrs=attributes)


def _word(number: int, group: Group) -> str:
    kinds = {None: "", 0: "_aperiodic"}
    return f"A{number}{kinds.get(group.period, f'_period_{group.period}')}"


def words_of(attractor: xarray.DataArray, thing: str) -> Sequence[str]:
    """Return the names of the attractors of a record.

    Raises
    ------
    InvalidInput
        If it is no record of words.
    """
    words = attractor.attrs.get("flag_meanings")
    if words is None:
        remedy = "Give dataset.attractor of a scenario that classifies, or what recurrences or features return."
        raise InvalidInput(thing, "needs a record of words", attractor.name, remedy)
    return str(words).split(" ")


@final
@dataclass(frozen=True, eq=False)
class RunsByValue:
    """The runs of a study by the values of one parameter.

    Attributes
    ----------
    values : array
        Value of each part, or the middle of its values, shape [n_parts].
    of_runs : array
        Part of each run, shape [n_runs].
    """

    values: NDArray[Any]
    of_runs: NDArray[np.int64]


def runs_by_value(runs: xarray.DataArray, parameter: str, bins: int) -> RunsByValue:
    """Return the runs by the values of a parameter: values of a grid, or ``bins`` equal parts of the range of draws.

    Raises
    ------
    UnknownName
        If the study does not vary the parameter.
    InvalidInput
        If the number of parts is not positive.
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
