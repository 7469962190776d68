"""``nonsmooth resume``: a run that was cut off goes on."""

from __future__ import annotations

import argparse
import contextlib
import sys
from pathlib import Path
from typing import Any

from nonsmooth.cli import extras, report, request
from nonsmooth.cli.messages import say, tell
from nonsmooth.cli.perform import Told, perform
from nonsmooth.files.scenario import FileScenario
from nonsmooth.plugins import file, registry
from nonsmooth.results.opening import stored_setup
from nonsmooth.results.output import Output
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.runs.resuming import check_resumable
from nonsmooth.simulate import assemble
from nonsmooth.solution.solution import Solution


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = commands.add_parser(
        "resume", help="go on with a run that was cut off, to the same end", allow_abbrev=False
    )
    command.add_argument("folder", type=Path, metavar="DIR", help="what `run --out` was given")
    command.add_argument(
        "--trust",
        action="store_true",
        help="load the Python files that the run was asked with, for the scenario's own figures and summary",
    )
    command.add_argument("--json", action="store_true", help="print one JSON object and nothing else")
    command.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> bool:
    """Go on with the run; tell whether all went well."""
    troubles: list[str] = []
    with contextlib.redirect_stdout(sys.stderr):  # whatever a plug-in prints: standard output is for the result
        outcome = _perform(Output(arguments.folder), arguments.trust, troubles)
    say(report.as_json(outcome) if arguments.json else report.as_text(outcome))
    return outcome["status"] == "done" and not troubles


def _perform(output: Output, trust: bool, troubles: list[str]) -> report.Report:
    extras.require(extras.PICTURES)
    folder = SolutionFolder.opened(output)
    name, job = job_of(output, folder, trust)
    system = job.build()
    check_resumable(output)

    def compute(told: Told) -> Solution:
        model = assemble(system, job.engine)
        return model.resume(output, progress=lambda t, t_end: told(t, t_end, model.n_events))

    return perform(job, {"scenario": name, **job.head()}, compute, output.folder, False, troubles)


def job_of(output: Output, folder: SolutionFolder, trust: bool) -> tuple[str, request.Job]:
    """Return what ran: a scenario by its name, all else by what the folder says of its system.

    No Python file is executed because the folder names it, unless the user trusts it.
    """
    asked = folder.said("request")
    name = str(asked.get("scenario", output.folder))
    words = [name, *(word.partition("=")[2] for word in asked.get("law", ())), asked.get("engine") or ""]
    files = [word for one in words if file.is_file(word := one.partition(",")[0])]
    if (name in registry.names("scenarios") or file.is_file(name)) and (trust or not files):
        return name, request.job(name, asked["set"], asked["law"], asked.get("engine"))
    if files:
        tell(f"without {', '.join(files)}, and so without what only they can say: see --trust")
    setup = stored_setup(output, folder)
    return name, request.Job(FileScenario(setup), setup.engine, {})
