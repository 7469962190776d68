"""CSV: anything of a run that goes over time, and its events."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, final

from nonsmooth.checks import check_kind
from nonsmooth.errors import MissingPackagesError, UnknownName
from nonsmooth.export.table import Series, table
from nonsmooth.solution.events_table import events_table
from nonsmooth.storage.files import replacing

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

SERIES: Mapping[str, Callable[[Solution], str]] = {
    "states": lambda solution: table(solution.at()),
    "energies": lambda solution: table(solution.energies()),
    "forces": lambda solution: table(solution.contact_forces()),
    "motion": lambda solution: table(solution.contact_motion()),
    "joints": lambda solution: table(solution.joint_forces()),
    "events": events_table,
}
"""Series of every run, by their names."""


@final
@dataclass(frozen=True)
class Csv:
    """A table with a row for each time, and name and unit over each column.

    Attributes
    ----------
    series : str or history
        "states", "energies", "forces" and "motion" of all contacts, or "joints", at the samples, or "events"; else what
        a method of the solution returned, for times of one's own, such as ``solution.poses("ball", times)``.
    """

    series: Series | str = "states"

    def __post_init__(self) -> None:
        try:
            import xarray  # noqa: F401
        except ImportError as error:
            raise MissingPackagesError('Tables need xarray: pip install "nonsmooth[full]"') from error
        if not isinstance(self.series, str):
            check_kind("export: series", self.series, Series, 'For example "energies", or solution.poses("ball").')
        elif self.series not in SERIES:
            raise UnknownName("export: series", self.series, SERIES)

    def write(self, solution: Solution, path: Path) -> None:
        """Write the file of a run."""
        text = SERIES[self.series](solution) if isinstance(self.series, str) else table(self.series)
        with replacing(path) as part:
            part.write_bytes(text.encode("utf-8"))
