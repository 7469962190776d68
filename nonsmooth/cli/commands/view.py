"""``nonsmooth view``: a run, played in the browser."""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Callable
from pathlib import Path

from nonsmooth.cli.execute import obtain
from nonsmooth.cli.parse import outputs
from nonsmooth.cli.parse.options import Command, Option
from nonsmooth.cli.report.messages import tell
from nonsmooth.solution.solution import Solution

_HTML = Option("--html", "write the page there and open nothing", metavar="FILE", kind=Path)


def _execute(arguments: argparse.Namespace) -> bool:
    """Write the page and open it; return whether the run reached its end."""
    if arguments.html is not None:
        outputs.prepare_file(arguments.html, arguments.overwrite)
    with contextlib.redirect_stdout(sys.stderr):
        run = obtain.obtain("view", arguments)
        if run.solution is not None:
            play = in_browser(run.title) if arguments.html is None else _to_file(run.title, arguments.html)
            play(run.solution)
    return run.is_complete


def in_browser(title: str) -> Callable[[Solution], None]:
    """Return a function that plays a run in the browser and prints the path of its page."""

    def play(solution: Solution) -> None:
        # imported on use: the other commands start faster without it
        from nonsmooth.solution.pages import MOST_KNOTS, not_opened, show

        path, opened = show(solution, title, MOST_KNOTS)
        tell(f"the run plays in the browser, from {path}" if opened else not_opened(path))

    return play


def _to_file(title: str, path: Path) -> Callable[[Solution], None]:
    return lambda solution: tell(f"the page is {solution.to_html(path, title=title)}")


COMMANDS = {"view": Command(_execute, (*obtain.OPTIONS, _HTML, outputs.OVERWRITE))}
