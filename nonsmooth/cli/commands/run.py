"""``nonsmooth run``: run a scenario, say what happened, save it."""

from __future__ import annotations

import argparse
import contextlib
import json
import sys
from typing import Any

from nonsmooth.cli.asking import engine, extras, law, outputs, request, trust
from nonsmooth.cli.commands import view
from nonsmooth.cli.running import acceptance, obtain
from nonsmooth.cli.running.perform import Told, perform
from nonsmooth.cli.telling import report
from nonsmooth.cli.telling.messages import say
from nonsmooth.results.output import Output
from nonsmooth.results.overwriting import check_free
from nonsmooth.runs.simulate import assemble
from nonsmooth.solution.solution import Solution


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = commands.add_parser("run", help="run a scenario", allow_abbrev=False)
    command.add_argument(
        "scenario",
        metavar="SCENARIO",
        help="a name of `nonsmooth list scenarios`, a FILE.toml or FILE.yaml, or FILE.py:CLASS",
    )
    command.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="a parameter of `nonsmooth show SCENARIO`, in SI units; may come often",
    )
    command.add_argument("--law", action="append", default=[], metavar="ROLE=LAW", help=law.HELP)
    command.add_argument("--engine", metavar="ENGINE", help=engine.HELP)
    trust.add_to(command)
    command.add_argument("--out", metavar="DIR", help="save results and figures there, an empty or new folder")
    outputs.add_to(command)
    command.add_argument(
        "--accept", action="store_true", help="judge the run by the scenario's own criteria; exit status 1 if one fails"
    )
    command.add_argument("--view", action="store_true", help="play it in the browser")
    command.add_argument("--json", action="store_true", help="print one JSON object and nothing else")
    command.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> bool:
    """Run the scenario; tell whether all went well."""
    troubles: list[str] = []
    with contextlib.redirect_stdout(sys.stderr):  # whatever a plug-in prints: standard output is for the result
        outcome = _perform(arguments, troubles)
    say(report.as_json(outcome) if arguments.json else report.as_text(outcome))
    accepted = not arguments.accept or acceptance.passed(outcome)
    return outcome["status"] == "done" and not troubles and accepted


def _perform(arguments: argparse.Namespace, troubles: list[str]) -> report.Report:
    job = request.job(arguments.scenario, arguments.set, arguments.law, arguments.engine, trust=arguments.trust)
    scenario = job.scenario
    if arguments.accept:
        acceptance.check_request(job)
    head, folder, output = {"scenario": arguments.scenario, **job.head()}, None, None
    system = job.build()
    if arguments.out is not None:
        extras.require(extras.PICTURES)
        asked = {name: getattr(arguments, name) for name in ("scenario", "set", "law", "engine")}
        folder = Output.to(arguments.out).folder
        described = json.loads(report.as_json(head))
        output = Output(folder, obtain.title_of(scenario), asked, described, arguments.overwrite)
        check_free(output)
        outputs.prepare_folder(folder, arguments.overwrite)

    def compute(told: Told) -> Solution:
        model = assemble(system, job.engine)
        return model.run(
            scenario.t_end,
            sample_interval=scenario.sample_interval,
            progress=lambda t, t_end: told(t, t_end, model.n_events),
            output=output,
        )

    looks = [view.in_browser(obtain.title_of(scenario))] if arguments.view else []
    return perform(job, head, compute, folder, arguments.accept, troubles, looks)
