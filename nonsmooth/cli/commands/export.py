"""``nonsmooth export``: a run as a file for other programs."""

from __future__ import annotations

import argparse
import contextlib
import inspect
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

from nonsmooth.cli.execute import obtain
from nonsmooth.cli.parse import outputs
from nonsmooth.cli.parse.options import Command, Option
from nonsmooth.cli.report.messages import tell
from nonsmooth.solution.exports import FORMATS, exporter


def _options_of_formats() -> tuple[Option, ...]:
    """Return the options of all formats; the help of each begins with the suffixes that have it."""
    found = dict[str, tuple[list[str], Option]]()
    for suffix, form in FORMATS.items():
        owner = form.func if isinstance(form, partial) else form
        given = len(form.args) if isinstance(form, partial) else 0
        for name in list(inspect.signature(owner).parameters)[given:]:
            suffixes, _ = found.setdefault(name, ([], Option.of(owner, name)))
            suffixes.append(suffix)
    # an option that is left out is not given: it may be none of the format
    return tuple(
        replace(one, text=f"of {', '.join(suffixes)}: {one.text}", default=None) for suffixes, one in found.values()
    )


_FORMATS = _options_of_formats()
_FILE = Option("file", f"the file to write; its suffix is the format: {', '.join(FORMATS)}", metavar="FILE")


def _execute(arguments: argparse.Namespace) -> bool:
    """Write the file; return whether the run reached its end."""
    given = {one.place: getattr(arguments, one.place) for one in _FORMATS}
    with contextlib.redirect_stdout(sys.stderr):
        write = exporter(arguments.file, **{name: value for name, value in given.items() if value is not None})
        outputs.prepare_file(Path(arguments.file), arguments.overwrite)
        run = obtain.obtain("export", arguments)
        if run.solution is not None:
            tell(f"the run is in {write(run.solution)}")
    return run.is_complete


COMMANDS = {"export": Command(_execute, (*obtain.OPTIONS, _FILE, *_FORMATS, outputs.OVERWRITE))}
