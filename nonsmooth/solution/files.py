"""Result files: a NetCDF file with samples and events, and the events as a table."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from nonsmooth.errors import NonsmoothError
from nonsmooth.solution.solution import Solution

if TYPE_CHECKING:
    import xarray

_ENERGIES = ("driven_work", "restitution_loss", "friction_loss", "closing_loss")


class FileError(NonsmoothError, OSError):
    """A result file that could not be written; the message names the path."""


def to_dataset(solution: Solution) -> xarray.Dataset:
    """Return samples and events of a solution as one dataset with units."""
    import xarray

    events = solution.events
    variables: dict[str, tuple[tuple[str, ...], object, dict[str, str]]] = {
        "q": (("time", "coordinate"), solution.q, {"long_name": "coordinates of all bodies, SI"}),
        "u": (("time", "velocity"), solution.u, {"long_name": "velocities of all bodies, SI"}),
        "event_cause": (("event",), np.array(events.causes(), dtype=str), {"long_name": "cause"}),
        "event_contact": (("event",), events.contact, {"long_name": "contact, counted from 0; -1 at the start"}),
        "event_phases": (("event",), events.phases, {"long_name": "changes of phase within the impact"}),
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
    account = {name: value for name, value in vars(solution.energy).items()}
    return xarray.Dataset(
        variables,
        coords={
            "time": ("time", solution.t, {"units": "s"}),
            "event_time": ("event", events.time, {"units": "s"}),
        },
        attrs=account
        | {
            "status": solution.status,
            "message": solution.message,
            "t_end": solution.t_end,
            "energy_residual": solution.energy.residual,
        },
    )


def save(solution: Solution, folder: Path) -> list[Path]:
    """Write ``solution.nc`` and ``events.csv`` into a folder; return the paths.

    Raises
    ------
    FileError
        If a file cannot be written; what could be written stays.
    """
    paths = [folder / "solution.nc", folder / "events.csv"]
    for path, write in zip(paths, (_save_dataset, _save_events), strict=True):
        try:
            folder.mkdir(parents=True, exist_ok=True)
            write(solution, path)
        except OSError as error:
            raise FileError(f"{path} could not be written: {error}. Free space there or give another --out.") from error
    return paths


def _save_dataset(solution: Solution, path: Path) -> None:
    to_dataset(solution).to_netcdf(path, engine="h5netcdf")


def _save_events(solution: Solution, path: Path) -> None:
    events = solution.events
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(
            ["time [s]", "cause", "contact", "mode before", "mode during", "mode after", "phases"]
            + [f"{name} [J]" for name in _ENERGIES]
        )
        columns = zip(
            events.time.tolist(),
            events.causes(),
            (events.contact + 1).tolist(),
            events.words("before"),
            events.words("during"),
            events.words("after"),
            events.phases.tolist(),
            *(getattr(events, name).tolist() for name in _ENERGIES),
            strict=True,
        )
        for time, *rest in columns:
            table.writerow([repr(time), *rest])
