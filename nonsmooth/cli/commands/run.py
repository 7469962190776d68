"""``nonsmooth run`` and ``resume``: run a scenario or continue an interrupted run, report the results, save them."""

from __future__ import annotations

import argparse
import contextlib
import json
import sys
from functools import partial
from pathlib import Path

from nonsmooth.cli.commands.export import in_browser
from nonsmooth.cli.execute import outputs
from nonsmooth.cli.execute.obtain import computation, job_of
from nonsmooth.cli.execute.outputs import Saver
from nonsmooth.cli.execute.perform import Progress, check_acceptance, is_accepted, perform
from nonsmooth.cli.parse.options import Command, Option, flag
from nonsmooth.cli.parse.request import ENGINE, JSON, LAW, SCENARIO, SET, TRUST, job
from nonsmooth.cli.report import run_report
from nonsmooth.cli.report.messages import say
from nonsmooth.results.output import Output
from nonsmooth.results.overwriting import check_free
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.runs.resuming import check_resumable
from nonsmooth.runs.simulate import assemble
from nonsmooth.solution.solution import Solution

_RUN = (
    SCENARIO,
    SET,
    LAW,
    ENGINE,
    TRUST,
    Option("--out", "folder of results and figures, empty or new", metavar="DIR"),
    outputs.OVERWRITE,
    flag("--accept", "judge the run by the scenario's own criteria; exit status 1 if one fails"),
    flag("--view", "play it in the browser"),
    JSON,
)
_RESUME = (Option("folder", "the folder that `run --out` was given", metavar="DIR", kind=Path), TRUST, JSON)


def _run(arguments: argparse.Namespace) -> bool:
    saver = Saver(None if arguments.out is None else Output.to(arguments.out).folder)
    # prints of a plug-in go to standard error, because standard output is for the result only
    with contextlib.redirect_stdout(sys.stderr):
        report = _performed(arguments, saver)
    accepted = not arguments.accept or is_accepted(report)
    return _said(report, saver, arguments.json) and accepted


def _performed(arguments: argparse.Namespace, saver: Saver) -> run_report.Report:
    made = job(arguments.scenario, arguments.set, arguments.law, arguments.engine, trust=arguments.trust)
    if arguments.accept:
        check_acceptance(made)
    head, output = {"scenario": arguments.scenario, **made.head()}, None
    if saver.folder is not None:
        outputs.require_matplotlib()
        words = {name: getattr(arguments, name) for name in ("scenario", "set", "law", "engine")}
        output = Output(saver.folder, made.title, words, json.loads(run_report.as_json(head)), arguments.overwrite)
    compute = computation(made, output)
    if output is not None:
        check_free(output)
        outputs.prepare_folder(output.folder, arguments.overwrite)
    show = partial(in_browser, made.title) if arguments.view else None
    return perform(made, head, compute, saver, is_judged=arguments.accept, show=show)


def _resume(arguments: argparse.Namespace) -> bool:
    saver, output = Saver(arguments.folder), Output(arguments.folder)
    with contextlib.redirect_stdout(sys.stderr):
        outputs.require_matplotlib()
        name, made = job_of(output, SolutionFolder.opened(output), arguments.trust)
        system = made.build()
        check_resumable(output)

        def compute(progress: Progress) -> Solution:
            model = assemble(system, made.engine)
            return model.resume(output, progress=lambda t, t_end: progress(t, t_end, model.n_events))

        report = perform(made, {"scenario": name, **made.head()}, compute, saver)
    return _said(report, saver, arguments.json)


def _said(report: run_report.Report, saver: Saver, as_json: bool) -> bool:
    """Print a report; return whether the run reached its end and all was saved."""
    say(run_report.as_json(report) if as_json else run_report.as_text(report))
    return report["status"] == "done" and not saver.troubles


COMMANDS = {"run": Command(_run, _RUN), "resume": Command(_resume, _RESUME)}
