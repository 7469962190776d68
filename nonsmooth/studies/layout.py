"""Which arrays a store has for some records over some points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from nonsmooth.studies.case import CaseFactory
from nonsmooth.studies.records.record import StudyRecord
from nonsmooth.studies.sampling import Sampling
from nonsmooth.studies.status import UNKNOWN, RunStatus, reason_attributes
from nonsmooth.studies.store import Coordinate, Variable


def _classes(words: Sequence[str]) -> dict[str, Any]:
    """Return values and names of classes, as the CF conventions have them."""
    return {"flag_values": list(range(len(words))), "flag_meanings": " ".join(word.replace(" ", "_") for word in words)}


def variables(records: Sequence[StudyRecord]) -> list[Variable]:
    """Return the arrays of records, of the status and of the reason."""
    found = []
    for one in records:
        attributes = {**one.attributes, **(_classes(one.words) if one.words else {})}
        axes = {name: len(labels) for name, labels in one.axes.items()}
        found.append(Variable(one.name, one.dtype, one.none, attributes, axes))
    found.append(Variable("reason", "int8", UNKNOWN, reason_attributes()))
    return [
        *found,
        Variable("status", "int8", RunStatus.NOT_RUN.code, {"long_name": "how it ended", **_classes(list(RunStatus))}),
    ]


def coordinates(records: Sequence[StudyRecord], sampling: Sampling, cases: CaseFactory) -> dict[str, Coordinate]:
    """Return the parameters over the runs, and the axes of records."""
    found = {name: Coordinate(("run",), values, cases.attributes(name)) for name, values in sampling.columns.items()}
    for one in records:
        for axis, labels in one.axes.items():
            told = {"units": "s", "long_name": "time"} if axis == "time" else {"long_name": axis}
            found[axis] = Coordinate((axis,), np.asarray(labels), told)
    return found


def labels_of(along: Mapping[str, Coordinate]) -> dict[str, list[str]]:
    """Return the words of those that have words, which are stored as numbers: where each stands among these."""
    return {name: np.unique(one.values).tolist() for name, one in along.items() if one.values.dtype.kind == "U"}


def stored(one: Coordinate) -> Coordinate:
    """Return a coordinate as it is stored."""
    if one.values.dtype.kind != "U":
        return one
    words, places = np.unique(one.values, return_inverse=True)
    marked = [word.replace(" ", "_") for word in words.tolist()]
    return Coordinate(one.dimensions, places.astype("int16"), {**one.attributes, **_classes(marked)})
