"""Arrays of a study's folder: its records over the runs, its parameters, and the axes of its records."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from nonsmooth.histories.history import LabelledArray
from nonsmooth.storage.chunks import ArrayLayout
from nonsmooth.studies.case import CaseFactory
from nonsmooth.studies.records.record import StudyRecord
from nonsmooth.studies.sampling import Sampling
from nonsmooth.studies.status import UNKNOWN, CaseStatus, reason_attributes


def _classes(words: Sequence[str]) -> dict[str, Any]:
    """Values and names of classes, as the CF conventions have them."""
    return {"flag_values": list(range(len(words))), "flag_meanings": " ".join(word.replace(" ", "_") for word in words)}


def variables(records: Sequence[StudyRecord], n_runs: int, chunk: int) -> dict[str, ArrayLayout]:
    """Arrays of the records, of the reason and of the status, over the runs."""
    found = {}
    for one in records:
        attributes = {**one.attributes, **(_classes(one.words) if one.words else {})}
        shape = (n_runs, *map(len, one.axes.values()))
        found[one.name] = ArrayLayout(
            ("run", *one.axes), np.dtype(one.dtype).name, shape, chunk, np.array(one.none, one.dtype).item(), attributes
        )
    ended = {"long_name": "how it ended", **_classes(list(CaseStatus))}
    found["reason"] = ArrayLayout(("run",), "int8", (n_runs,), chunk, UNKNOWN, reason_attributes())
    return found | {"status": ArrayLayout(("run",), "int8", (n_runs,), chunk, CaseStatus.NOT_RUN.code, ended)}


def coordinates(records: Sequence[StudyRecord], sampling: Sampling, cases: CaseFactory) -> list[LabelledArray]:
    """The parameters over the runs, and the axes of records."""
    found = {
        name: LabelledArray(name, ("run",), values, cases.attributes(name)) for name, values in sampling.columns.items()
    }
    for one in records:
        for axis, labels in one.axes.items():
            attributes = {"units": "s", "long_name": "time"} if axis == "time" else {"long_name": axis}
            found[axis] = LabelledArray(axis, (axis,), np.asarray(labels), attributes)
    return list(found.values())
