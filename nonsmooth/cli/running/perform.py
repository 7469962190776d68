"""What `run` and `resume` have in common: compute, judge, save, report."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import cast

from nonsmooth.cli.asking import request
from nonsmooth.cli.running import acceptance, results
from nonsmooth.cli.running.interrupt import Interrupt
from nonsmooth.cli.telling import report
from nonsmooth.cli.telling.messages import complain, tell
from nonsmooth.errors import PluginError, RunFailed
from nonsmooth.interfaces import Scenario
from nonsmooth.progress import Pace, TimeReached, on_standard_error
from nonsmooth.results.description import UNFINISHED
from nonsmooth.results.output import Output
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.solution.csv_tables import save_events
from nonsmooth.solution.draw_graph import draw
from nonsmooth.solution.modes import are_recorded, transition_graph
from nonsmooth.solution.solution import Solution
from nonsmooth.storage.files import FileError

Told = Callable[[float, float, int], None]
"""Takes the time reached, the end time [s] and the events so far."""
Compute = Callable[[Told], Solution]
"""From what takes the progress to the solution."""
Look = Callable[[Solution], None]
"""What else is done with it."""


def perform(
    job: request.Job,
    head: report.Report,
    compute: Compute,
    folder: Path | None,
    accept: bool,
    troubles: list[str],
    looks: Sequence[Look] = (),
) -> report.Report:
    """Compute a solution, save what there is to save, and return the report; ``head`` is its beginning."""
    scenario = job.scenario
    solution, status, message = computed(compute)
    outcome: report.Report = head | {"status": status, "message": message} | report.of_solution(solution)
    outcome |= {"final": None, "summary": None, "units": {**report.UNITS, **scenario.units}}
    if solution is None:
        return outcome
    if folder is not None:
        _save_solution(scenario, solution, folder, troubles)
    with results.noting(troubles, f"{type(scenario).__name__}.final"):
        outcome["final"] = dict(scenario.final(solution))
    with results.noting(troubles, f"{type(scenario).__name__}.summarise"):
        outcome["summary"] = dict(scenario.summarise(solution))
    if accept:
        with results.noting(troubles, f"{type(scenario).__name__}.acceptance"):
            outcome["acceptance"] = acceptance.judged(scenario, solution)
    if folder is not None:
        results.save_text(report.as_json(outcome), folder / "summary.json", troubles)
        _save_figures(job, solution, folder, troubles)
        if not troubles:
            tell(f"results are in {folder}")
    for look in looks:
        with results.noting(troubles, "the view"):
            look(solution)
    return outcome


def computed(compute: Compute) -> tuple[Solution | None, str, str]:
    """Return the solution, as far as there is one, the status and why the run stopped."""

    def after_steps(t: float, t_end: float, n_events: int) -> None:
        progress(t, t_end, n_events)
        if t < t_end:
            interrupt.check()

    try:
        with Pace(on_standard_error()) as pace, Interrupt() as interrupt:
            progress = TimeReached(pace)
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


def _save_solution(scenario: Scenario, solution: Solution, folder: Path, troubles: list[str]) -> None:
    """Add what belongs to the samples and events that the run has written."""
    with results.noting(troubles, f"{type(scenario).__name__}.coordinates"):
        written = SolutionFolder.held(Output(folder))
        with contextlib.closing(written):
            # where the disk was full there are fewer samples than there were
            if written.status != UNFINISHED:
                written.add_coordinates(scenario.coordinates(solution), scenario.unit_of)
    with results.noting(troubles, "saving the events"):
        save_events(solution, folder / "events.csv")


def _save_figures(job: request.Job, solution: Solution, folder: Path, troubles: list[str]) -> None:
    results.without_display()
    graph = transition_graph(solution) if are_recorded(solution) else None
    if graph is None:
        tell("no picture of transitions: the engine records no modes")
    elif len(graph.shares) > 1:
        with results.noting(troubles, "drawing the transitions"):
            results.save_figures({"transitions": draw(graph)}, folder, troubles)
    else:
        tell("no picture of transitions: the run has one mode")
    with results.noting(troubles, f"{type(job.scenario).__name__}.figures"):
        # titles and captions may speak of the laws that were replaced
        note = f"In place of the scenario's own:\n{chr(10).join(map(repr, job.laws.values()))}" if job.laws else ""
        results.save_figures(job.scenario.figures(solution), folder, troubles, note)
