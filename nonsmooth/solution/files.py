"""Result files: a NetCDF file with samples and events, and the events as a table."""

from __future__ import annotations

import contextlib
import csv
import errno
import io
import os
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from nonsmooth.errors import NonsmoothError
from nonsmooth.solution.solution import Solution

if TYPE_CHECKING:
    import xarray

Coordinates = Mapping[str, Any]
_NONE: Coordinates = MappingProxyType({})
_ENERGIES = ("driven_work", "restitution_loss", "friction_loss", "closing_loss")


_REMEDY = "Free space there or choose another folder."
_REMEDIES = {errno.ENOTDIR: "Name a folder; one that is not there is made."}


class FileError(NonsmoothError, OSError):
    """A file or folder that could not be written; the message names the path."""

    def __init__(self, path: object, error: OSError) -> None:
        reason = error.strerror or error
        super().__init__(f"{path} could not be written: {reason}. {_REMEDIES.get(error.errno or 0, _REMEDY)}")


def prepare(folder: Path) -> None:
    """Create a folder and try to write into it, so that a wrong path is found before a run and not after it.

    Raises
    ------
    FileError
        If that is not possible.
    """
    try:
        if folder.exists() and not folder.is_dir():
            raise NotADirectoryError(errno.ENOTDIR, "It is a file")
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder) as probe:
            probe.write(b"probe")
    except OSError as error:
        raise FileError(folder, error) from error


@contextlib.contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a path to write to; it becomes ``path`` when all is written, so that no half file takes that name.

    Raises
    ------
    FileError
        If writing fails; an older file of that name stays as it was.
    """
    part = path.with_name(f".{path.name}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield part
        os.replace(part, path)
    except OSError as error:
        raise FileError(path, error) from error
    finally:
        with contextlib.suppress(OSError):
            part.unlink()


def to_dataset(solution: Solution, coordinates: Coordinates = _NONE) -> xarray.Dataset:
    """Return samples and events of a solution as one dataset with units.

    ``coordinates`` are further variables over the samples, as a scenario gives them: name -> array [n_samples].
    """
    import xarray

    events = solution.events
    variables: dict[str, tuple[tuple[str, ...], object, dict[str, str]]] = {
        "q": (("time", "coordinate"), solution.q, {"long_name": "coordinates of all bodies, SI"}),
        "u": (("time", "velocity"), solution.u, {"long_name": "velocities of all bodies, SI"}),
        "event_cause": (("event",), np.array(events.causes(), dtype=str), {"long_name": "cause"}),
        "event_contact": (
            ("event",),
            events.contact,
            {"long_name": "index of the contact or guard, from 0; -1 at the start"},
        ),
        "event_trigger": (("event",), np.array(solution.triggers(), dtype=str), {"long_name": "contact or guard"}),
        "event_phases": (("event",), events.phases, {"long_name": "changes of phase within the impact"}),
        "event_truncated": (("event",), events.truncated, {"long_name": "1 where an endless cascade was cut short"}),
        "impulse": (
            ("event", "contact", "direction"),
            events.impulse,
            {"units": "N s", "long_name": "normal and tangential impulses"},
        ),
        "event_q": (("event", "coordinate"), events.q, {"long_name": "coordinates at the event"}),
        "event_u_before": (("event", "velocity"), events.u_before, {"long_name": "velocities before"}),
        "event_u_after": (("event", "velocity"), events.u_after, {"long_name": "velocities after"}),
    }
    for which in ("before", "during", "after"):
        spelled = np.array(events.words(which), dtype=str)
        variables[f"mode_{which}"] = (("event",), spelled, {"long_name": f"mode word {which} the event"})
    for name in _ENERGIES:
        variables[name] = (("event",), getattr(events, name), {"units": "J", "long_name": name.replace("_", " ")})
    for name, values in coordinates.items():
        variables[name] = (("time",), values, {"long_name": "coordinate of the scenario, SI"})
    return xarray.Dataset(
        variables,
        coords={
            "time": ("time", solution.t, {"units": "s"}),
            "event_time": ("event", events.time, {"units": "s"}),
        },
        attrs=vars(solution.energy)
        | {
            "status": solution.status,
            "message": solution.message,
            "t_end": solution.t_end,
            "energy_residual": solution.energy.residual,
        },
    )


def save(solution: Solution, folder: Path, coordinates: Coordinates = _NONE) -> list[Path]:
    """Write ``solution.nc`` and ``events.csv`` into a folder; return the paths.

    ``coordinates`` are those of :func:`to_dataset`.

    Raises
    ------
    FileError
        If a file cannot be written; the other one is written all the same.
    """
    failures = []
    paths = {folder / "solution.nc": _write_dataset, folder / "events.csv": _write_events}
    for path, write in paths.items():
        try:
            with replacing(path) as part:
                write(solution, coordinates, part)
        except FileError as error:
            failures.append(error)
    if failures:
        raise failures[0]
    return list(paths)


def _write_dataset(solution: Solution, coordinates: Coordinates, path: Path) -> None:
    import h5netcdf  # type: ignore[import-untyped]
    from xarray.backends import H5NetCDFStore

    # in memory first: where a disk is full, HDF5 fails once per object, at length, and again when the process ends
    content = io.BytesIO()
    with h5netcdf.File(content, "w") as file:
        to_dataset(solution, coordinates).dump_to_store(H5NetCDFStore(file))
    path.write_bytes(content.getbuffer())


def _write_events(solution: Solution, coordinates: Coordinates, path: Path) -> None:
    events = solution.events
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(
            ["time [s]", "cause", "contact or guard", "mode before", "mode during", "mode after", "phases"]
            + [f"{name} [J]" for name in _ENERGIES]
        )
        columns = zip(
            events.time.tolist(),
            events.causes(),
            solution.triggers(),
            events.words("before"),
            events.words("during"),
            events.words("after"),
            events.phases.tolist(),
            *(getattr(events, name).tolist() for name in _ENERGIES),
            strict=True,
        )
        for time, *rest in columns:
            table.writerow([repr(time), *rest])
