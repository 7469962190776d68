"""Find the attractor of each run, by recurrences of the stroboscopic map or by recorded numbers that agree."""

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
"""Tolerance between points of two runs on one attractor, relative to the tolerance between points of one run.

It is larger, because a slow run may repeat within the tolerance before it is so close to its attractor.
"""


def recurrences(study: xarray.Dataset, tolerance: float = 1e-3, along: Along | None = None) -> xarray.Dataset:
    """Find the attractor of each run by recurrences, and the period of its motion.

    A point is a recorded state of a run; the stroboscope records one in each period.  A run repeats after n periods if
    all points that are n, 2 n, 3 n ... periods apart agree within the tolerance.  Two runs with the same n are on one
    attractor if their points agree within ten times the tolerance.  This tolerance is larger, because both runs may
    still be settling.  Points may also agree through a chain of points of other runs (single linkage).

    Runs that do not repeat are on one attractor if their points overlap.  The spacing of a run is the distance within
    which nine tenths of its points have a neighbour in the same run.  Two runs overlap if at least half of the points
    of each run are within the spacing of the other run.  Runs that overlap form a group.  If at least half of the
    points of a group are within the spacing of a larger group, both are on one attractor.  A run that overlaps no other
    run is "unsettled".

    Parameters
    ----------
    study : Dataset
        A study with the record of a :class:`Stroboscope`.
    tolerance : float
        Largest difference of coordinates that repeat, in units of their scales.  The scale of a position is the size of
        the body, the scale of a velocity the speed after a fall through this size.
    along : Along, optional
        A parameter: attractors are found for each of its values, then matched from value to value.

    Returns
    -------
    Dataset
        ``attractor``: number of the attractor of each run, with names in ``flag_meanings``; number 0 has the most runs,
        -1 marks runs without records.  ``period``: number of periods after which the run repeats, 0 if it does not, -1
        for runs without records.  Add both by ``study.assign(...)``.

    Raises
    ------
    InvalidInput
        If the study has no record of a :class:`Stroboscope`, or ``tolerance`` or ``along.bins`` is not positive.
    UnknownName
        If the study does not vary the parameter of `along`.

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
    """Groups runs by recurrences.

    Attributes
    ----------
    points : array
        Points of each run, in units of the scales of the coordinates, shape [n_runs, n_points, n_coordinates].
    after : array
        Number of periods after which each run repeats, 0 if it does not, shape [n_runs].
    tolerance : float
        Largest difference of coordinates that repeat.
    """

    points: Array
    after: Integers
    tolerance: float

    def __call__(self, runs: Integers) -> list[Group]:
        """Return a group for each attractor of the runs with these numbers."""
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

    Two runs are on one attractor if all features agree within their tolerances, or if a chain of other runs that agree
    connects them (single linkage).  A missing number agrees with a missing number only.  For example, a run that never
    comes to rest has no time of rest.

    Parameters
    ----------
    study : Dataset
        A study.
    tolerances : mapping of str to float
        Name of each feature, a record with one number per run, and its largest difference within an attractor, in the
        unit of the record.
    along : Along, optional
        A parameter: attractors are found for each of its values, then matched from value to value.

    Returns
    -------
    Dataset
        ``attractor``: number of the attractor of each run, with names in ``flag_meanings``; number 0 has the most runs,
        -1 marks runs without records.  Add it by ``study.assign(...)``.

    Raises
    ------
    InvalidInput
        If `tolerances` is empty, or a tolerance, or ``along.bins``, is not positive.
    UnknownName
        If a name in `tolerances` is not a record with one value per run, or the study does not vary the parameter of
        `along`.
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
