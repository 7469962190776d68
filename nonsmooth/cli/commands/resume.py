"""``nonsmooth resume``: a run that was cut off goes on."""

from __future__ import annotations

import argparse
import contextlib
import sys
from pathlib import Path
from typing import Any

from nonsmooth.cli.asking import extras, trust
from nonsmooth.cli.running import obtain
from nonsmooth.cli.running.perform import Told, perform
from nonsmooth.cli.telling import report
from nonsmooth.cli.telling.messages import say
from nonsmooth.results.output import Output
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.runs.resuming import check_resumable
from nonsmooth.runs.simulate import assemble
from nonsmooth.solution.solution import Solution


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = commands.add_parser(
        "resume", help="go on with a run that was cut off, to the same end", allow_abbrev=False
    )
    command.add_argument("folder", type=Path, metavar="DIR", help="what `run --out` was given")
    trust.add_to(command)
    command.add_argument("--json", action="store_true", help="print one JSON object and nothing else")
    command.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> bool:
    """Go on with the run; tell whether all went well."""
    troubles: list[str] = []
    with contextlib.redirect_stdout(sys.stderr):  # whatever a plug-in prints: standard output is for the result
        outcome = _perform(Output(arguments.folder), arguments.trust, troubles)
    say(report.as_json(outcome) if arguments.json else report.as_text(outcome))
    return outcome["status"] == "done" and not troubles


def _perform(output: Output, is_trusted: bool, troubles: list[str]) -> report.Report:
    extras.require(extras.PICTURES)
    folder = SolutionFolder.opened(output)
    name, job = obtain.job_of(output, folder, is_trusted)
    system = job.build()
    check_resumable(output)

    def compute(told: Told) -> Solution:
        model = assemble(system, job.engine)
        return model.resume(output, progress=lambda t, t_end: told(t, t_end, model.n_events))

    return perform(job, {"scenario": name, **job.head()}, compute, output.folder, False, troubles)
