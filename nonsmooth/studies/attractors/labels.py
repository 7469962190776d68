"""From groups of runs to the labels of a study."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput
from nonsmooth.studies.attractors.following import Along, Grouping, followed
from nonsmooth.studies.attractors.group import Group
from nonsmooth.studies.attractors.parts import parts

if TYPE_CHECKING:
    import xarray

UNSETTLED = "unsettled"
"""Runs of which no other one tells that they are on an attractor."""


def labelled(
    study: xarray.Dataset, valued: NDArray[np.bool_], grouping: Grouping, along: Along | None
) -> xarray.Dataset:
    """Return the attractor of each run.

    Parameters
    ----------
    study : Dataset
        The study.
    valued : array
        Which runs have records, shape [n_runs].
    grouping : callable
        Groups some runs.
    along : Along, optional
        Along which parameter they are followed.
    """
    import xarray

    runs = np.flatnonzero(valued)
    if along is None:
        found = grouping(runs)
    else:
        split = parts(study.status, along.parameter, along.bins)
        rows = [runs[split.of_runs[runs] == part] for part in range(len(split.values))]
        found = followed([grouping(row) for row in rows], along.tolerance)
    found.sort(key=lambda one: (-len(one.runs), one.runs.min()))
    labels, words = np.full(len(valued), -1, "int32"), [_word(i, one) for i, one in enumerate(found, 1)]
    for i, one in enumerate(found):
        labels[one.runs] = i
    left = valued & (labels < 0)
    if left.any():
        labels[left] = len(words)
        words.append(UNSETTLED)
    told = {"long_name": "attractor", "flag_values": list(range(len(words))), "flag_meanings": " ".join(words)}
    return xarray.Dataset({"attractor": over_runs(study, labels, told)}, attrs=study.attrs)


def over_runs(study: xarray.Dataset, values: NDArray[Any], told: dict[str, Any]) -> xarray.DataArray:
    """Return one value for each run over the axes of the study."""
    import xarray

    status = study.status
    return xarray.DataArray(values.reshape(status.shape), status.coords, status.dims, attrs=told)


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
