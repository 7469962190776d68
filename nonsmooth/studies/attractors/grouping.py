"""Attractors of runs, by recurrences of the stroboscopic map or by recorded numbers that agree."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np

from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.studies.attractors.labels import Along, Group, labelled, over_runs
from nonsmooth.studies.attractors.linkage import Integers, linked, overlapping
from nonsmooth.studies.inputs import check_positive
from nonsmooth.studies.periods import periods
from nonsmooth.studies.state_records import NAME
from nonsmooth.studies.status import VALUED, records_of
from nonsmooth.types import Array

if TYPE_CHECKING:
    import xarray

NEAR = 10.0
"""Tolerance of points of two runs over that of one run: a run that settles is farther from its attractor than it
moves."""


def recurrences(study: xarray.Dataset, tolerance: float = 1e-3, along: Along | None = None) -> xarray.Dataset:
    """Find the attractor of each run by recurrences, and the period of its motion.

    A run repeats after n periods if all of its sections do, within the tolerance.  Runs of the same n are on one
    attractor if all of their points agree within ten times the tolerance, as they may still settle, or through further
    runs that do (single linkage).  Runs that do not repeat are on one attractor if their points overlap: at least half
    of the points of either run are as near to the other run as nine tenths of its points are to each other.  A smaller
    set within a larger one belongs to it.  A run that overlaps no other is "unsettled".

    Parameters
    ----------
    study : Dataset
        A study with the record of a :class:`Stroboscope`.
    tolerance : float
        Largest difference of coordinates that repeat, in units of their scales: the size of the body, and the speed of
        a fall through it.
    along : Along, optional
        A parameter: attractors are found for each of its values, and matched.

    Returns
    -------
    Dataset
        ``attractor``, numbers with names in ``flag_meanings``, the largest first, -1 for runs without records; and
        ``period``, 0 if a run does not repeat, -1 for runs without records.  Add them by ``study.assign(...)``.

    Raises
    ------
    InvalidInput
        If the study has no such record, or a number is not valid.
    UnknownName
        If the study does not vary the parameter.

    References
    ----------
    G. Datseris, A. Wagemakers, "Effortless estimation of basins of attraction", Chaos 32 (2022) 023104: attractors
    by recurrences, there on a grid of cells.
    """
    if NAME not in study:
        remedy = "Record studies.Stroboscope(period=..., within=...)."
        raise InvalidInput("recurrences", f"needs the record {NAME}", list(map(str, study.data_vars)), remedy)
    check_positive("recurrences: tolerance", tolerance, "For example 1e-3.")
    record = study[NAME]
    points = record.values.reshape(-1, *record.shape[-2:]) / np.asarray(record.attrs["scales"])
    valued = np.isin(study.status.values.ravel(), VALUED)
    after = np.where(valued, periods(points, tolerance), -1)
    found = labelled(study, valued, _Recurrences(points, after, tolerance), along)
    attributes = {"units": "1", "long_name": "periods after which it repeats, 0 where it does not"}
    return found.assign(period=over_runs(study, after.astype("int16"), attributes))


@final
@dataclass(frozen=True, eq=False)
class _Recurrences:
    """Groups runs: ``points`` [n_runs, n_sections, n_coordinates] over their scales, ``after`` [n_runs] the periods."""

    points: Array
    after: Integers
    tolerance: float

    def __call__(self, runs: Integers) -> list[Group]:
        """Return the groups of some runs."""
        found, after = list[Group](), self.after[runs]
        for n in np.unique(after[after > 0]).tolist():
            found += self._periodic(runs[after == n], n)
        loose = runs[after == 0]
        for members in overlapping(self.points[loose]) if len(loose) else ():
            found.append(Group(loose[members], self.points[loose[members[0]]], 0))
        return found

    def _periodic(self, runs: Integers, n: int) -> list[Group]:
        looks = self.points[runs]
        whole = looks.shape[1] // n
        means = looks[:, looks.shape[1] - whole * n :].reshape(len(runs), whole, n, -1).mean(axis=1)
        places = linked(means.reshape(len(runs) * n, -1) / (NEAR * self.tolerance)).reshape(len(runs), n)
        sets = dict[frozenset[int], list[int]]()
        for i, row in enumerate(places.tolist()):
            sets.setdefault(frozenset(row), []).append(i)
        return [Group(runs[rows], means[rows[0]], n) for rows in sets.values()]


def features(study: xarray.Dataset, tolerances: Mapping[str, float], along: Along | None = None) -> xarray.Dataset:
    """Find the attractor of each run by recorded numbers.

    Two runs are on one attractor if they agree in every feature within its tolerance, or through further runs that
    do (single linkage).  A missing number is a feature, too: a run that never comes to rest has no time of it.

    Parameters
    ----------
    study : Dataset
        A study.
    tolerances : mapping of str to float
        Largest difference of each feature within an attractor, in its unit; a feature is a record that is one number.
    along : Along, optional
        A parameter: attractors are found for each of its values, and matched.

    Returns
    -------
    Dataset
        ``attractor``, numbers with names in ``flag_meanings``, the largest first, -1 for runs without records.  Add it
        by ``study.assign(...)``.

    Raises
    ------
    InvalidInput
        If there is no feature, or a tolerance is not valid.
    UnknownName
        If a feature is no record with one number per run, or the study does not vary the parameter.
    """
    known = records_of(study)
    if not tolerances:
        raise InvalidInput("features", "must be one at least", dict(tolerances), 'For example {"last_flight": 1e-3}.')
    for name, tolerance in tolerances.items():
        if name not in known:
            raise UnknownName("features: record", name, known)
        check_positive(f"features: tolerance of {name}", tolerance, "Give it in the unit of the record.")
    columns = [known[name].values.ravel() / tolerance for name, tolerance in tolerances.items()]
    values = np.stack(columns, axis=1).astype(float)
    missing = np.isnan(values)
    # missing numbers agree with each other, and with no other number
    points = np.concatenate([np.where(missing, 0.0, values), 2.0 * missing], axis=1)

    def grouping(runs: Integers) -> list[Group]:
        labels = linked(points[runs])
        members = [runs[labels == label] for label in range(labels.max(initial=-1) + 1)]
        return [Group(some, points[some].mean(axis=0)[np.newaxis], None) for some in members]

    return labelled(study, np.isin(study.status.values.ravel(), VALUED), grouping, along)
