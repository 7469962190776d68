"""``nonsmooth view`` shows a run, ``export`` writes a run to a file, and ``save`` writes a scenario to a file."""

from __future__ import annotations

import argparse
import contextlib
import inspect
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

from nonsmooth.cli.execute import obtain, outputs
from nonsmooth.cli.parse.options import Command, Option
from nonsmooth.cli.parse.request import ENGINE, LAW, SCENARIO, SET, TRUST, job
from nonsmooth.cli.report.messages import tell
from nonsmooth.files import formats
from nonsmooth.files.writing import save_system
from nonsmooth.solution.exports import FORMATS, exporter
from nonsmooth.solution.solution import Solution


def _options_of_formats() -> tuple[Option, ...]:
    """Return the options of all file formats; the help of an option begins with the suffixes of its formats."""
    found = dict[str, tuple[list[str], Option]]()
    for suffix, form in FORMATS.items():
        owner = form.func if isinstance(form, partial) else form
        given = len(form.args) if isinstance(form, partial) else 0
        for name in list(inspect.signature(owner).parameters)[given:]:
            suffixes, _ = found.setdefault(name, ([], Option.of(owner, name)))
            suffixes.append(suffix)
    # the default None marks an option that the user left out: it is not passed on, because the format may lack it
    return tuple(
        replace(one, text=f"of {', '.join(suffixes)}: {one.text}", default=None) for suffixes, one in found.values()
    )


_FORMATS = _options_of_formats()
_HTML = Option("--html", "write the page there and open nothing", metavar="FILE", kind=Path)
_EXPORT = Option("file", f"the file to write; its suffix is the format: {', '.join(FORMATS)}", metavar="FILE")
_SAVE = Option("file", "the file to write, .toml or .yaml", metavar="FILE", kind=Path)


def in_browser(title: str, solution: Solution) -> None:
    """Play a run in the browser and print the path of its page."""
    # imported on use: the other commands start faster without it
    from nonsmooth.solution.pages import MOST_KNOTS, not_opened, show

    path, opened = show(solution, title, MOST_KNOTS)
    tell(f"the run plays in the browser, from {path}" if opened else not_opened(path))


def _view(arguments: argparse.Namespace) -> bool:
    """Write the page of a run, and open it unless ``--html`` is given; return whether the run is complete."""
    if arguments.html is not None:
        outputs.prepare_file(arguments.html, arguments.overwrite)
    with contextlib.redirect_stdout(sys.stderr):
        run = obtain.obtain("view", arguments)
        if run.solution is not None and arguments.html is None:
            in_browser(run.title, run.solution)
        elif run.solution is not None:
            tell(f"the page is {run.solution.to_html(arguments.html, title=run.title)}")
    return run.is_complete


def _export(arguments: argparse.Namespace) -> bool:
    """Write a run to a file of another format; return whether the run is complete."""
    given = {one.place: getattr(arguments, one.place) for one in _FORMATS}
    with contextlib.redirect_stdout(sys.stderr):
        write = exporter(arguments.file, **{name: value for name, value in given.items() if value is not None})
        outputs.prepare_file(Path(arguments.file), arguments.overwrite)
        run = obtain.obtain("export", arguments)
        if run.solution is not None:
            tell(f"the run is in {write(run.solution)}")
    return run.is_complete


def _save(arguments: argparse.Namespace) -> bool:
    made = job(arguments.scenario, arguments.set, arguments.law, arguments.engine, trust=arguments.trust)
    one, path = made.scenario, arguments.file
    formats.of(path)
    outputs.prepare_file(path, arguments.overwrite)
    system, title = made.build(), made.title
    save_system(system, path, t_end=one.t_end, sample_interval=one.sample_interval, engine=made.engine, title=title)
    tell(f"the system is in {path}")
    return True


COMMANDS = {
    "view": Command(_view, (*obtain.OPTIONS, _HTML, outputs.OVERWRITE)),
    "export": Command(_export, (*obtain.OPTIONS, _EXPORT, *_FORMATS, outputs.OVERWRITE)),
    "save": Command(_save, (SCENARIO, _SAVE, SET, LAW, ENGINE, TRUST, outputs.OVERWRITE)),
}
