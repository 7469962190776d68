"""``nonsmooth view``: a run, played in the browser."""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from nonsmooth.cli.asking import outputs
from nonsmooth.cli.running import obtain
from nonsmooth.cli.telling.messages import tell
from nonsmooth.solution.solution import Solution


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = commands.add_parser("view", help="play a run in the browser", allow_abbrev=False)
    obtain.add_to(command)
    command.add_argument("--html", type=Path, metavar="FILE", help="write the page there and open nothing")
    outputs.add_to(command)
    command.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> bool:
    """Write the page and open it; tell whether the run came to its end."""
    if arguments.html is not None:
        outputs.prepare_file(arguments.html, arguments.overwrite)
    with contextlib.redirect_stdout(sys.stderr):
        run = obtain.obtain("view", arguments)
        if run.solution is not None:
            look = in_browser(run.title) if arguments.html is None else to_file(run.title, arguments.html)
            look(run.solution)
    return run.whole


def in_browser(title: str) -> Callable[[Solution], None]:
    """Return what plays a run in the browser and says where its page is."""

    def look(solution: Solution) -> None:
        # imported when asked for: the other commands start faster without it
        from nonsmooth.solution.pages import MOST_KNOTS, not_opened, show

        path, opened = show(solution, title, MOST_KNOTS)
        tell(f"the run plays in the browser, from {path}" if opened else not_opened(path))

    return look


def to_file(title: str, path: Path) -> Callable[[Solution], None]:
    """Return what writes the page of a run and says where it is."""
    return lambda solution: tell(f"the page is {solution.to_html(path, title=title)}")
