"""Steps of ``run`` and ``resume``: compute, judge, save, report. Ctrl-C stops a run at the next safe point."""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any, cast

from nonsmooth.cli.execute.outputs import Saver, without_display
from nonsmooth.cli.parse.request import Job
from nonsmooth.cli.report import run_report
from nonsmooth.cli.report.messages import complain, tell
from nonsmooth.errors import STUCK, InvalidInput, PluginError, RunFailed
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
"""Callback that takes the time reached [s], the end time [s] and the number of events so far."""
Compute = Callable[[Progress], Solution]
"""Function that computes a solution, and calls the given progress callback."""


class Interrupt:
    """Context in which the first Ctrl-C stops the run at the next :meth:`check`, and a second Ctrl-C stops it at once.

    An interrupt at any other place could divide a record.  A background process of a script ignores Ctrl-C from the
    start, but ``kill -INT`` stops its run in the same way and keeps the results.
    """

    def __init__(self) -> None:
        self.asked = False

    def __enter__(self) -> Interrupt:
        self._previous = signal.signal(signal.SIGINT, self._ask)
        return self

    def __exit__(self, *error: Any) -> None:
        signal.signal(signal.SIGINT, self._previous)

    def _ask(self, number: int, frame: FrameType | None) -> None:
        if self.asked:
            raise KeyboardInterrupt
        self.asked = True
        tell("\ninterrupt: stopping at the next safe point; once more stops at once")

    def check(self) -> None:
        """Raise KeyboardInterrupt after a first Ctrl-C."""
        if self.asked:
            raise KeyboardInterrupt

    def progress(self, meter: ProgressMeter) -> Callable[..., None]:
        """Return the callback ``(t, t_end, *n_events)`` that a run calls with the time reached and the end time [s].

        It shows the progress, with the number of events if this is given.  After Ctrl-C it raises KeyboardInterrupt.
        """
        shown = TimeReached(meter)

        def after_steps(t: float, t_end: float, *n_events: int) -> None:
            shown(t, t_end, *n_events)
            if t < t_end:
                self.check()

        return after_steps


def perform(
    job: Job,
    head: run_report.Report,
    compute: Compute,
    saver: Saver,
    *,
    is_judged: bool = False,
    show: Callable[[Solution], None] | None = None,
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
    saver : Saver
        Saves the solution, if it has a folder, and notes failures.
    is_judged : bool
        Whether the scenario's acceptance criteria judge the run.
    show : callable, optional
        Shows the solution at the end.
    """
    scenario = job.scenario
    owner = type(scenario).__name__
    solution, status, message = computed(compute)
    report: run_report.Report = head | {"status": status, "message": message} | run_report.of_solution(solution)
    report |= {"final": None, "summary": None, "units": {**run_report.UNITS, **scenario.units}}
    if solution is None:
        return report
    if saver.folder is not None:
        _save_solution(scenario, solution, saver, saver.folder)
    with saver.noting(f"{owner}.final"):
        report["final"] = dict(scenario.final(solution))
    with saver.noting(f"{owner}.summarise"):
        report["summary"] = dict(scenario.summarise(solution))
    if is_judged:
        with saver.noting(f"{owner}.acceptance"):
            report["acceptance"] = judged(scenario, solution)
    if saver.folder is not None:
        saver.text(run_report.as_json(report), "summary.json")
        _save_figures(job, solution, saver)
        if not saver.troubles:
            tell(f"results are in {saver.folder}")
    if show is not None:
        with saver.noting("the view"):
            show(solution)
    return report


def computed(compute: Compute) -> tuple[Solution | None, str, str]:
    """Return the solution up to the time reached (None without results), the status, and the reason of the end."""
    try:
        with ProgressMeter(on_standard_error()) as meter, Interrupt() as interrupt:
            solution = compute(interrupt.progress(meter))
    except RunFailed as error:
        kept = cast("Solution | None", error.solution)
        message = kept.message if kept else str(error)
        complain(message)
        tell(STUCK)
        return kept, "failed", message
    except (PluginError, FileError) as error:
        complain(str(error))
        return None, "failed", str(error)
    except KeyboardInterrupt:
        complain("interrupted before the run began")
        return None, "interrupted", "interrupted before the run began"
    if solution.status == "suspect":
        complain(f"suspect: {solution.message}")
        tell(STUCK)
    return solution, solution.status, solution.message


def check_acceptance(job: Job) -> None:
    """Raise InvalidInput if laws are replaced: the criteria of a scenario hold for its own laws only."""
    if job.laws:
        rule, remedy = "must be left out of a run with --law", "The criteria are for its own laws."
        raise InvalidInput("--accept", rule, sorted(job.laws), remedy)


def judged(scenario: Scenario, solution: Solution) -> list[dict[str, Any]]:
    """Return the acceptance criteria of a run with their results, and print the failed criteria."""
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


def _save_solution(scenario: Scenario, solution: Solution, saver: Saver, folder: Path) -> None:
    """Add the scenario's coordinates and a table of events to the folder that the run has written."""
    with saver.noting(f"{type(scenario).__name__}.coordinates"):
        written = SolutionFolder.held(Output(folder))
        with contextlib.closing(written):
            # if the disk was full, the folder is unfinished: it has fewer samples than the coordinates
            if written.status != UNFINISHED:
                written.add_coordinates(scenario.coordinates(solution), scenario.unit_of)
    with saver.noting("saving the events"):
        save_events(solution, folder / "events.csv")


def _save_figures(job: Job, solution: Solution, saver: Saver) -> None:
    without_display()
    graph = transition_graph(solution) if are_recorded(solution) else None
    if graph is None:
        tell("no picture of transitions: the engine records no modes")
    elif len(graph.shares) > 1:
        with saver.noting("drawing the transitions"):
            saver.figures({"transitions": draw(graph)})
    else:
        tell("no picture of transitions: the run has one mode")
    with saver.noting(f"{type(job.scenario).__name__}.figures"):
        # the figures get a note, because their titles may still name the scenario's own laws
        note = f"In place of the scenario's own:\n{chr(10).join(map(repr, job.laws.values()))}" if job.laws else ""
        saver.figures(job.scenario.figures(solution), note)
