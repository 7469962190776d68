"""Exports: a run as files of another format, chosen by the suffix of the path."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from nonsmooth.checks import path_of
from nonsmooth.errors import InvalidInput
from nonsmooth.export.glb import Glb
from nonsmooth.export.movie import Movie
from nonsmooth.export.vtk import Vtk
from nonsmooth.solution.csv_tables import Csv
from nonsmooth.storage.files import prepare

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution


class ExportFormat(Protocol):
    """Interface of an export format: an object holds the options of the format, and writes a run to a file."""

    def write(self, solution: Solution, path: Path) -> None:
        """Write the run to ``path``. A file gets its name when it is complete, so a failure keeps the older file."""


FORMATS: Mapping[str, Callable[..., ExportFormat]] = {
    ".glb": Glb,
    ".pvd": Vtk,
    ".gif": partial(Movie, "gif"),
    ".webp": partial(Movie, "webp"),
    ".png": partial(Movie, "png"),
    ".mp4": partial(Movie, "mp4"),
    ".csv": Csv,
}
"""Suffix -> function that makes the format from its options."""


def exporter(path: Path | str, **options: Any) -> Callable[[Solution], Path]:
    """Function that writes a run to a path (:meth:`nonsmooth.Solution.export`); the options are checked here."""
    found = path_of("export: path", path)
    suffix = found.suffix.lower()
    if suffix not in FORMATS:
        raise InvalidInput(
            "export: path", f"must end in one of {', '.join(FORMATS)}", str(path), "Its suffix names the format."
        )
    known = inspect.signature(FORMATS[suffix]).parameters
    for name, value in options.items():
        if name not in known:
            raise InvalidInput(f"export: {name}", f"is no option of {suffix}", value, f"Known: {', '.join(known)}.")
    chosen = FORMATS[suffix](**options)
    if found.is_dir():
        raise InvalidInput(
            "export: path", "must be a file", str(path), "There is a folder of that name; choose another."
        )
    prepare(found.parent)

    def write(solution: Solution) -> Path:
        chosen.write(solution, found)
        return found

    return write
