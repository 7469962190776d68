"""``nonsmooth run --accept``: a run judged by the criteria of its scenario."""

from __future__ import annotations

from typing import Any

from nonsmooth.cli.asking.request import Job
from nonsmooth.cli.telling.messages import complain
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Scenario
from nonsmooth.solution.solution import Solution


def check_request(job: Job) -> None:
    """Raise InvalidInput where other laws than the scenario's own would be judged by its criteria."""
    if job.laws:
        raise InvalidInput(
            "--accept", "must be left out of a run with --law", sorted(job.laws), "The criteria are for its own laws."
        )


def judged(scenario: Scenario, solution: Solution) -> list[dict[str, Any]]:
    """Return the criteria of a run, each with whether it is fulfilled; what fails is told."""
    found = []
    for one in scenario.acceptance(solution):
        row = {name: getattr(one, name) for name in ("name", "value", "lower", "upper", "source", "fulfilled")}
        found.append(row)
        if not one.fulfilled:
            complain(f"not accepted: {one.name} is {one.value:.9g}, must be {one.lower:.9g} to {one.upper:.9g}")
    if not found:
        complain("not accepted: the scenario has no criterion for these parameters")
    return found


def passed(outcome: dict[str, Any]) -> bool:
    """Tell whether there is a criterion and all are fulfilled."""
    rows = outcome.get("acceptance") or []
    return bool(rows) and all(row["fulfilled"] for row in rows)
