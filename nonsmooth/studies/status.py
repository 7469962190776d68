"""Status and reason of the runs of a study, as stored codes and in words."""

from __future__ import annotations

import re
from collections.abc import Iterator
from enum import StrEnum
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory import modes

if TYPE_CHECKING:
    import xarray

ALWAYS = ("status", "reason")
"""Names of the records that every study has."""


class CaseStatus(StrEnum):
    """How a run of a study ended; the folder of the study stores its ``code``."""

    NOT_RUN = "not_run"
    """The run has no stored result yet."""
    DONE = "done"
    """The run reached its end."""
    FAILED = "failed"
    """The system could not be built, the run failed, or a record failed."""
    BUDGET = "budget"
    """The run reached its largest number of steps before its end."""
    CRASHED = "crashed"
    """The process of the run died."""
    SUSPECT = "suspect"
    """The run reached its end, but a check of the run failed."""

    @property
    def code(self) -> int:
        """Stored number of the status: its index among the members of this class."""
        return list(CaseStatus).index(self)


MOST_COMPONENTS = 12
"""Largest length of an array of each run whose components are listed and drawn: a figure has as many panels."""
VALUED = (CaseStatus.DONE.code, CaseStatus.SUSPECT.code)
"""Codes of runs that have records."""
WORKER_DIED, RAISED, UNKNOWN = -2, -1, 0
"""Codes of reasons that the engine does not give: the process died, an exception was raised, the run has not begun."""


def reason_of(message: str) -> int:
    """Return the engine's code of the reason in a message; ``RAISED`` if the message has no reason of the engine."""
    return next((code for code, sentence in modes.REASONS.items() if sentence in message), RAISED)


def reason_attributes() -> dict[str, object]:
    """Return codes and names of the reasons as CF attributes."""
    own = {WORKER_DIED: "worker died", RAISED: "raised", UNKNOWN: "not run"}
    named = own | {code: re.split("[,:]", sentence)[0] for code, sentence in sorted(modes.REASONS.items())}
    words = [re.sub(r"\W+", "_", sentence).strip("_") for sentence in named.values()]
    return {"long_name": "why it ended", "flag_values": list(named), "flag_meanings": " ".join(words)}


def summary(study: xarray.Dataset) -> str:
    """Return a text with the number of runs of each status, and the range or the counts of each record.

    Only the records of :func:`scalars_of` are listed.
    """
    valued = np.isin(study.status.values, VALUED)
    lines = [f"  {name}: {of_record(one, valued)}" for name, one in scalars_of(study).items()]
    return "\n".join([f"{study.status.size} runs: {ends(study.status.values)}", *lines])


def ends(status: NDArray[Any]) -> str:
    """Return a text with the number of runs of each status that occurs, such as "10 done, 2 failed"."""
    counts = ((word.replace("_", " "), (status == word.code).sum()) for word in CaseStatus)
    return ", ".join(f"{count} {word}" for word, count in counts if count)


def records_of(study: xarray.Dataset) -> dict[str, xarray.DataArray]:
    """Return the records that are one number, or one word, per run."""
    runs = study.status.dims
    return {str(name): one for name, one in study.data_vars.items() if one.dims == runs and name not in ALWAYS}


def scalars_of(study: xarray.Dataset) -> dict[str, xarray.DataArray]:
    """Return the records that are one number or one word per run, then the components of short vectors by name.

    The vector ``drift_velocity`` gives ``drift_velocity[0]`` and ``drift_velocity[1]``. The components of a state are
    named by its coordinates, as in ``q_end ball x``.
    """
    runs = study.status.dims
    rows = (
        one for one in study.data_vars.values() if one.dims[:-1] == runs and one.sizes[one.dims[-1]] <= MOST_COMPONENTS
    )
    return records_of(study) | {str(one.name): one for row in rows for one in _components(row)}


def _components(row: xarray.DataArray) -> Iterator[xarray.DataArray]:
    """Yield the components of a record that is a vector per run, with names and units."""
    axis = row.dims[-1]
    for i, label in enumerate(row[axis].values):
        one = row.isel({axis: i}, drop=True)
        if row[axis].dtype.kind == "U":
            text, _, unit = str(label).removesuffix("]").rpartition(" [")
            yield one.rename(f"{row.name} {text}").assign_attrs(units=unit)
        else:
            yield one.rename(f"{row.name}[{label}]")


def of_record(record: xarray.DataArray, valued: NDArray[np.bool_]) -> str:
    """Return a text with the values of a record: the range of numbers, or how often each word occurs.

    ``valued`` is True for the runs that have records, shape of ``record``; other runs are left out.
    """
    values = record.values[valued]
    if words := record.attrs.get("flag_meanings"):
        counted = ((word, int((values == i).sum())) for i, word in enumerate(words.split(" ")))
        return ", ".join(f"{word} {n}" for word, n in counted if n) or "none"
    known = values[np.isfinite(values)]
    unit = record.attrs.get("units", "1")
    if not len(known):
        return "none"
    low, high = f"{known.min():.6g}", f"{known.max():.6g}"
    return f"{low if low == high else f'{low} to {high}'}{'' if unit == '1' else f' {unit}'}"
