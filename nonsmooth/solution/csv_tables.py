"""Tables as CSV: a history with a row for each time, or the events of a run with a row for each event."""

from __future__ import annotations

import csv
import io
import itertools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, TextIO, final, runtime_checkable

import numpy as np

from nonsmooth.checks import check_kind
from nonsmooth.engine.memory.modes import AFTER, BEFORE, CODE, DURING, Mode
from nonsmooth.errors import InvalidInput, MissingPackagesError, UnknownName
from nonsmooth.histories.variables import VARIABLES
from nonsmooth.solution.events import ENERGIES
from nonsmooth.storage.files import replacing

if TYPE_CHECKING:
    import xarray

    from nonsmooth.histories.history import History
    from nonsmooth.solution.solution import Solution


@runtime_checkable
class Series(Protocol):
    """Quantities over time that can become a dataset, such as a :class:`nonsmooth.histories.history.History`."""

    def to_xarray(self) -> xarray.Dataset:
        """Dataset with the coordinate "time" [s]: an axis, or a number at a single time."""


def table(series: Series) -> str:
    """CSV text with a row for each time; the head of each column has its name, labels and unit.

    Raises
    ------
    InvalidInput
        The series is not over time.
    """
    data = series.to_xarray()
    if "time" not in data.coords or "event" in data.sizes:
        rule = "must be over time, with one row for each"
        raise InvalidInput("export: series", rule, series, 'For example solution.history("gap"), or "states".')
    if "time" not in data.dims:
        data = data.expand_dims("time")
    heads, columns = ["time [s]"], [data["time"].to_numpy()]
    for name, variable in data.data_vars.items():
        axes = [str(axis) for axis in variable.dims if axis != "time"]
        values = variable.transpose("time", *axes).to_numpy()
        places = itertools.product(*(range(data.sizes[axis]) for axis in axes))
        # the shape is explicit, because a run that was cut off at once has no rows
        for column, place in zip(values.reshape(len(values), math.prod(values.shape[1:])).T, places, strict=True):
            labels = [_label(data, axis, i) for axis, i in zip(axes, place, strict=True)]
            units = [str(data[f"{axis}_units"].to_numpy()[i]) for axis, i in zip(axes, place, strict=True)
                     if f"{axis}_units" in data.coords]  # fmt: skip
            unit = variable.attrs.get("units", units[0] if units else "")
            heads.append(" ".join([str(name), *labels]) + (f" [{unit}]" if unit else ""))
            columns.append(column)
    file = io.StringIO(newline="")
    rows = csv.writer(file)
    rows.writerow(heads)
    # repr has all digits of a number
    rows.writerows(zip(*([repr(x) for x in column.tolist()] for column in columns), strict=True))
    return file.getvalue()


def _label(data: xarray.Dataset, axis: str, i: int) -> str:
    return str(data[axis].to_numpy()[i]) if axis in data.coords else str(i)


_FORCES = (
    "mode", "normal_force", "friction_force", "friction_moment", "gap", "contact_point", "contact_normal",
    "slip_velocity",
)  # fmt: skip
"""Variables of the series "forces"."""
_ENERGIES = [name for name, row in VARIABLES.items() if row.unit == "J"]
"""Variables of the series "energies"."""
_HEAD = ("time [s]", "cause", "contact or guard", "phases", *(f"{name} [J]" for name in ENERGIES), "modes")
_UNCHANGED = {bits << BEFORE | bits << DURING | bits << AFTER for bits in range(CODE + 1)}
"""Codes whose mode bits are equal before, during and after an event.

The event does not change the mode of a contact with such a code, so the column "modes" does not list the contact.
"""


def _forces(solution: Solution) -> History:
    """Forces of the contacts that are closed at a sample."""
    closed = np.flatnonzero(np.any(solution.history("mode")["mode"] != Mode.OPEN, axis=0))
    return solution.history(*_FORCES, of=closed)


def events_table(solution: Solution) -> str:
    """CSV text of the events of a run, with a row for each event.

    The column "modes" lists the contacts whose bits (closed, approaching, slipping) the event changes, with their bits
    before, during and after it: "ball - plate 000 110 101; ...".
    """
    text = io.StringIO(newline="")
    _write_events(solution, text)
    return text.getvalue()


def _write_events(solution: Solution, file: TextIO) -> None:
    """Write the table of events block by block, because the events of a long run do not fit into memory."""
    names, guards, rows = solution.system.names.contacts, solution.system.names.guards, csv.writer(file)
    rows.writerow(_HEAD)
    for events in solution.events.blocks():
        first, listed, codes = events.first.tolist(), events.listed.tolist(), events.codes.tolist()
        causes, energies = events.causes(), [getattr(events, name).tolist() for name in ENERGIES]
        for i, (time, trigger) in enumerate(zip(events.time.tolist(), events.triggers(names, guards), strict=True)):
            modes = [
                f"{names[listed[j]]} {' '.join(_bits(codes[j] >> shift) for shift in (BEFORE, DURING, AFTER))}"
                for j in range(first[i], first[i + 1])
                if codes[j] not in _UNCHANGED
            ]
            numbers = (repr(column[i]) for column in energies)
            rows.writerow([repr(time), causes[i], trigger, int(events.phases[i]), *numbers, "; ".join(modes)])


def _bits(code: int) -> str:
    return "".join(str(code >> i & 1) for i in range(3))


SERIES: Mapping[str, Callable[[Solution], str]] = {
    "states": lambda solution: table(solution.at()),
    "energies": lambda solution: table(solution.history(*_ENERGIES)),
    "forces": lambda solution: table(_forces(solution)),
    "motion": lambda solution: table(solution.history("gap", "normal_velocity", "slip_speed")),
    "joints": lambda solution: table(solution.history("joint_point", "joint_force", "joint_moment")),
    "events": events_table,
}
"""Name of a series -> function that computes its table of a run, as CSV text."""


@final
@dataclass(frozen=True)
class Csv:
    """Options of a CSV file: the table of a run that it holds.

    Attributes
    ----------
    series : str or History
        "states", "energies", "forces", "motion" or "joints" at the samples, "events", or a history, such as
        ``solution.history("position", times=times, of="ball")``.
    """

    series: Series | str = "states"

    def __post_init__(self) -> None:
        try:
            import xarray  # noqa: F401
        except ImportError as error:
            raise MissingPackagesError('Tables need xarray: pip install "nonsmooth[full]"') from error
        if not isinstance(self.series, str):
            remedy = 'For example "energies", or solution.history("position", of="ball").'
            check_kind("export: series", self.series, Series, remedy)
        elif self.series not in SERIES:
            raise UnknownName("export: series", self.series, SERIES)

    def write(self, solution: Solution, path: Path) -> None:
        """Write the table of a run to a file."""
        text = SERIES[self.series](solution) if isinstance(self.series, str) else table(self.series)
        with replacing(path) as part:
            part.write_bytes(text.encode("utf-8"))


def save_events(solution: Solution, path: Path) -> None:
    """Write the events to a CSV file (:func:`events_table`).

    Raises
    ------
    FileError
        The file cannot be written; an older file of the name is unchanged.
    """
    with replacing(path) as part, part.open("w", encoding="utf-8", newline="") as file:
        _write_events(solution, file)
