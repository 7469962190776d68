"""``nonsmooth export``: a run as a file for other programs."""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from nonsmooth.cli.asking import outputs
from nonsmooth.cli.running import obtain
from nonsmooth.cli.telling.messages import tell
from nonsmooth.export.camera import VIEWS
from nonsmooth.solution.csv_tables import SERIES
from nonsmooth.solution.exports import FORMATS, exporter

_OPTIONS: Mapping[str, tuple[type, str]] = {
    "view": (str, f"of pictures, where they are seen from: {', '.join(VIEWS)}"),
    "speed": (float, "of pictures, time of the run that passes in one second watched"),
    "frames_per_second": (float, "of pictures, how many in one second watched"),
    "size": (int, "of pictures, the longer side in pixels"),
    "series": (str, f"of a table, what is in it: {', '.join(SERIES)}"),
    "count": (int, "of a VTK series, at how many times"),
    "most_knots": (int, "of GLB, at how many times besides the instants of events"),
}


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = commands.add_parser("export", help="write a run for other programs", allow_abbrev=False)
    obtain.add_to(command)
    command.add_argument("file", metavar="FILE", help=f"where to; its suffix is the format: {', '.join(FORMATS)}")
    for name, (kind, words) in _OPTIONS.items():
        command.add_argument(f"--{name.replace('_', '-')}", type=kind, help=words)
    outputs.add_to(command)
    command.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> bool:
    """Write the file; tell whether the run came to its end."""
    given = {name: getattr(arguments, name) for name in _OPTIONS}
    with contextlib.redirect_stdout(sys.stderr):
        write = exporter(arguments.file, **{name: value for name, value in given.items() if value is not None})
        outputs.prepare_file(Path(arguments.file), arguments.overwrite)
        run = obtain.obtain("export", arguments)
        if run.solution is not None:
            tell(f"the run is in {write(run.solution)}")
    return run.whole
