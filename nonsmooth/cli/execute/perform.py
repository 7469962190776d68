"""The course of ``run`` and ``resume``: compute, judge, save, report."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, cast

from nonsmooth.cli.execute import saving
from nonsmooth.cli.execute.interrupt import Interrupt
from nonsmooth.cli.parse.request import Job
from nonsmooth.cli.report import run_report
from nonsmooth.cli.report.messages import complain, tell
from nonsmooth.errors import InvalidInput, PluginError, RunFailed
from nonsmooth.interfaces import Scenario
from nonsmooth.progress import ProgressMeter, TimeReached, on_standard_error
from nonsmooth.results.description import UNFINISHED
from nonsmooth.results.output import Output
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.solution.csv_tables import save_events
from nonsmooth.solution.draw_graph import draw
from nonsmooth.solution.modes import are_recorded, transition_graph
from nonsmooth.solution.solution import Solution
from nonsmooth.storage.files import FileError

Progress = Callable[[float, float, int], None]
"""Takes the time reached, the end time [s] and the events so far."""
Compute = Callable[[Progress], Solution]
"""Computes a solution, and reports its progress."""


def perform(
    job: Job,
    head: run_report.Report,
    compute: Compute,
    folder: Path | None,
    accept: bool,
    troubles: list[str],
    further: Sequence[Callable[[Solution], None]] = (),
) -> run_report.Report:
    """Compute a solution, save it, and return the report.

    Parameters
    ----------
    job : Job
        Scenario, laws and engine.
    head : Report
        Beginning of the report.
    compute : callable
        Computes the solution.
    folder : Path or None
        Where it is saved.
    accept : bool
        Whether the scenario's criteria judge it.
    troubles : list of str
        Failures are appended.
    further : sequence of callable
        Called with the solution at the end.
    """
    scenario = job.scenario
    owner = type(scenario).__name__
    solution, status, message = computed(compute)
    report: run_report.Report = head | {"status": status, "message": message} | run_report.of_solution(solution)
    report |= {"final": None, "summary": None, "units": {**run_report.UNITS, **scenario.units}}
    if solution is None:
        return report
    if folder is not None:
        _save_solution(scenario, solution, folder, troubles)
    with saving.noting(troubles, f"{owner}.final"):
        report["final"] = dict(scenario.final(solution))
    with saving.noting(troubles, f"{owner}.summarise"):
        report["summary"] = dict(scenario.summarise(solution))
    if accept:
        with saving.noting(troubles, f"{owner}.acceptance"):
            report["acceptance"] = judged(scenario, solution)
    if folder is not None:
        saving.save_text(run_report.as_json(report), folder / "summary.json", troubles)
        _save_figures(job, solution, folder, troubles)
        if not troubles:
            tell(f"results are in {folder}")
    for step in further:
        with saving.noting(troubles, "the view"):
            step(solution)
    return report


def computed(compute: Compute) -> tuple[Solution | None, str, str]:
    """Return the solution as far as it was computed, the status, and the reason of the end."""

    def after_steps(t: float, t_end: float, n_events: int) -> None:
        progress(t, t_end, n_events)
        if t < t_end:
            interrupt.check()

    try:
        with ProgressMeter(on_standard_error()) as meter, Interrupt() as interrupt:
            progress = TimeReached(meter)
            solution = compute(after_steps)
    except RunFailed as error:
        kept = cast("Solution | None", error.solution)
        message = kept.message if kept else str(error)
        complain(message)
        return kept, "failed", message
    except (PluginError, FileError) as error:
        complain(str(error))
        return None, "failed", str(error)
    except KeyboardInterrupt:
        complain("interrupted before the run began")
        return None, "interrupted", "interrupted before the run began"
    if solution.status == "suspect":
        complain(f"suspect: {solution.message}")
    return solution, solution.status, solution.message


def check_acceptance(job: Job) -> None:
    """Raise InvalidInput if other laws than the scenario's own would be judged by its criteria."""
    if job.laws:
        rule, remedy = "must be left out of a run with --law", "The criteria are for its own laws."
        raise InvalidInput("--accept", rule, sorted(job.laws), remedy)


def judged(scenario: Scenario, solution: Solution) -> list[dict[str, Any]]:
    """Return the criteria of a run, each with its result; failed ones go to standard error."""
    found = []
    for one in scenario.acceptance(solution):
        row = {name: getattr(one, name) for name in ("name", "value", "lower", "upper", "source", "fulfilled")}
        found.append(row)
        if not one.fulfilled:
            complain(f"not accepted: {one.name} is {one.value:.9g}, must be {one.lower:.9g} to {one.upper:.9g}")
    if not found:
        complain("not accepted: the scenario has no criterion for these parameters")
    return found


def is_accepted(report: dict[str, Any]) -> bool:
    """Return True if there is a criterion and all are fulfilled."""
    rows = report.get("acceptance") or []
    return bool(rows) and all(row["fulfilled"] for row in rows)


def _save_solution(scenario: Scenario, solution: Solution, folder: Path, troubles: list[str]) -> None:
    """Add coordinates of the scenario and a table of events to the samples that the run has written."""
    with saving.noting(troubles, f"{type(scenario).__name__}.coordinates"):
        written = SolutionFolder.held(Output(folder))
        with contextlib.closing(written):
            # after a full disk there are fewer samples than in the solution
            if written.status != UNFINISHED:
                written.add_coordinates(scenario.coordinates(solution), scenario.unit_of)
    with saving.noting(troubles, "saving the events"):
        save_events(solution, folder / "events.csv")


def _save_figures(job: Job, solution: Solution, folder: Path, troubles: list[str]) -> None:
    saving.without_display()
    graph = transition_graph(solution) if are_recorded(solution) else None
    if graph is None:
        tell("no picture of transitions: the engine records no modes")
    elif len(graph.shares) > 1:
        with saving.noting(troubles, "drawing the transitions"):
            saving.save_figures({"transitions": draw(graph)}, folder, troubles)
    else:
        tell("no picture of transitions: the run has one mode")
    with saving.noting(troubles, f"{type(job.scenario).__name__}.figures"):
        # titles and captions may mention the laws that were replaced
        note = f"In place of the scenario's own:\n{chr(10).join(map(repr, job.laws.values()))}" if job.laws else ""
        saving.save_figures(job.scenario.figures(solution), folder, troubles, note)
