"""Attractors by features: runs whose numbers agree."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.studies.attractors.labels import labelled
from nonsmooth.studies.attractors.linkage import linked
from nonsmooth.studies.attractors.matching import Along, Group
from nonsmooth.studies.inputs import check_positive
from nonsmooth.studies.status import VALUED, records_of

if TYPE_CHECKING:
    import xarray


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

    def grouping(runs: NDArray[np.int64]) -> list[Group]:
        labels = linked(points[runs])
        members = [runs[labels == label] for label in range(labels.max(initial=-1) + 1)]
        return [Group(some, points[some].mean(axis=0)[np.newaxis], None) for some in members]

    return labelled(study, np.isin(study.status.values.ravel(), VALUED), grouping, along)
