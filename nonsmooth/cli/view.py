"""``nonsmooth view``: a run, played in the browser."""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from nonsmooth.cli import engine, law, outputs, request, resume
from nonsmooth.cli.messages import tell
from nonsmooth.cli.perform import computed
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Scenario
from nonsmooth.results.opening import open_solution
from nonsmooth.results.output import Output
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.simulate import assemble
from nonsmooth.solution.solution import Solution


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = commands.add_parser("view", help="play a run in the browser", allow_abbrev=False)
    command.add_argument(
        "run", metavar="RESULT|SCENARIO", help="a folder that `run --out` was given, or a scenario as for `run`"
    )
    command.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="as for `run`")
    command.add_argument("--law", action="append", default=[], metavar="ROLE=LAW", help=law.HELP)
    command.add_argument("--engine", metavar="ENGINE", help=engine.HELP)
    command.add_argument("--html", type=Path, metavar="FILE", help="write the page there and open nothing")
    outputs.add_to(command)
    command.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> bool:
    """Write the page and open it; tell whether the run came to its end."""
    if arguments.html is not None:
        outputs.prepare_file(arguments.html, arguments.overwrite)
    with contextlib.redirect_stdout(sys.stderr):
        stored = Path(arguments.run).is_dir()
        title, solution = _stored(arguments) if stored else _computed(arguments)
        if solution is None:
            return False
        look = in_browser(title) if arguments.html is None else to_file(title, arguments.html)
        look(solution)
    return stored or solution.status == "done"


def title_of(scenario: Scenario) -> str:
    """Return the title of a scenario, or of the file that it comes from."""
    return str(scenario.resolved().get("title", type(scenario).title))


def in_browser(title: str) -> Callable[[Solution], None]:
    """Return what plays a run in the browser and says where its page is."""
    return lambda solution: tell(f"the run plays in the browser, from {solution.view(title=title)}")


def to_file(title: str, path: Path) -> Callable[[Solution], None]:
    """Return what writes the page of a run and says where it is."""
    return lambda solution: tell(f"the page is {solution.to_html(path, title=title)}")


def _stored(arguments: argparse.Namespace) -> tuple[str, Solution]:
    if arguments.set or arguments.law or arguments.engine:
        raise InvalidInput(
            "view", "takes --set, --law and --engine for a scenario only", arguments.run, "Leave them out."
        )
    output = Output(Path(arguments.run))
    folder = SolutionFolder.opened(output)
    name, job = resume.job_of(output, folder, trust=False)
    return str(folder.attributes.get("title") or name), open_solution(output, system=job.build())


def _computed(arguments: argparse.Namespace) -> tuple[str, Solution | None]:
    job = request.job(arguments.run, arguments.set, arguments.law, arguments.engine)
    model, scenario = assemble(job.build(), job.engine), job.scenario
    solution, _, _ = computed(
        lambda told: model.run(
            scenario.t_end,
            sample_interval=scenario.sample_interval,
            progress=lambda t, t_end: told(t, t_end, model.n_events),
        )
    )
    return title_of(scenario), solution
