"""``nonsmooth run``: run a scenario, say what happened, save it."""

from __future__ import annotations

import argparse
import contextlib
import sys
from pathlib import Path
from typing import Any, cast

from nonsmooth.cli import acceptance, extras, law, report, request, results
from nonsmooth.cli.interrupt import Interrupt
from nonsmooth.cli.messages import complain, say, tell
from nonsmooth.cli.progress import on_standard_error
from nonsmooth.errors import PluginError, RunFailed
from nonsmooth.interfaces import Scenario
from nonsmooth.simulate import assemble
from nonsmooth.solution import files
from nonsmooth.solution.draw_graph import draw
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System


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
    command.add_argument("--out", type=Path, metavar="DIR", help="save results and figures there")
    command.add_argument(
        "--accept", action="store_true", help="judge the run by the scenario's own criteria; exit status 1 if one fails"
    )
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
    job = request.job(arguments.scenario, arguments.set, arguments.law)
    scenario = job.scenario
    if arguments.accept:
        acceptance.check_request(job)
    head = {"scenario": arguments.scenario, **job.head()}
    system = job.build()
    if arguments.out is not None:
        extras.require(extras.RESULTS)
        with results.noting(troubles, "--out"):
            files.prepare(arguments.out)
    if troubles:
        solution, status, message = None, "failed", troubles[0]
    else:
        solution, status, message = _compute(job, system)
    outcome: report.Report = head | {"status": status, "message": message} | report.of_solution(solution)
    outcome |= {"final": None, "summary": None, "units": dict(scenario.units)}
    if solution is None:
        return outcome
    if arguments.out is not None:
        _save_solution(scenario, solution, arguments.out, troubles)
    with results.noting(troubles, f"{type(scenario).__name__}.final"):
        outcome["final"] = dict(scenario.final(solution))
    with results.noting(troubles, f"{type(scenario).__name__}.summarise"):
        outcome["summary"] = dict(scenario.summarise(solution))
    if arguments.accept:
        with results.noting(troubles, f"{type(scenario).__name__}.acceptance"):
            outcome["acceptance"] = acceptance.judged(scenario, solution)
    if arguments.out is not None:
        results.save_text(report.as_json(outcome), arguments.out / "summary.json", troubles)
        _save_figures(job, solution, arguments.out, troubles)
        if not troubles:
            tell(f"results are in {arguments.out}")
    return outcome


def _compute(job: request.Job, system: System) -> tuple[Solution | None, str, str]:
    """Return the solution, as far as there is one, the status and why the run stopped."""
    progress = on_standard_error()

    def after_steps(t: float, t_end: float) -> None:
        progress(t, t_end, model.n_events)
        if t < t_end:
            interrupt.check()

    try:
        with Interrupt() as interrupt:
            model = assemble(system, job.engine)
            solution = model.run(job.scenario.t_end, sample_interval=job.scenario.sample_interval, progress=after_steps)
    except RunFailed as error:
        kept = cast("Solution | None", error.solution)
        message = kept.message if kept else str(error)
        complain(message)
        return kept, "failed", message
    except PluginError as error:
        complain(str(error))
        return None, "failed", str(error)
    except KeyboardInterrupt:
        complain("interrupted before the run began")
        return None, "interrupted", "interrupted before the run began"
    finally:
        progress.finish()
    if solution.status == "suspect":
        complain(f"suspect: {solution.message}")
    return solution, solution.status, solution.message


def _save_solution(scenario: Scenario, solution: Solution, folder: Path, troubles: list[str]) -> None:
    coordinates: dict[str, Any] = {}
    with results.noting(troubles, f"{type(scenario).__name__}.coordinates"):
        coordinates.update(scenario.coordinates(solution))
    with results.noting(troubles, "saving the solution"):
        files.save(solution, folder, coordinates)


def _save_figures(job: request.Job, solution: Solution, folder: Path, troubles: list[str]) -> None:
    results.without_display()
    if len(solution.events) > 0:
        with results.noting(troubles, "drawing the transitions"):
            results.save_figures({"transitions": draw(solution.transition_graph())}, folder, troubles)
    with results.noting(troubles, f"{type(job.scenario).__name__}.figures"):
        # titles and captions may speak of the laws that were replaced
        note = f"In place of the scenario's own:\n{chr(10).join(map(repr, job.laws.values()))}" if job.laws else ""
        results.save_figures(job.scenario.figures(solution), folder, troubles, note)
