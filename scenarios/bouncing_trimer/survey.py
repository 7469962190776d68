"""Many runs over Gamma and frequency."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, cast

from nonsmooth.errors import RunFailed
from nonsmooth.interfaces import Run
from nonsmooth.solution.solution import Solution
from scenarios.bouncing_trimer.scenario import BouncingTrimer


@dataclass(frozen=True)
class Entry:
    """One run of a survey.

    Attributes
    ----------
    gamma, frequency : float
        Of the plate [1], [Hz].
    numbers : mapping
        What :meth:`BouncingTrimer.summarise` says.
    residual : float
        Of the energy account.
    status : str
        "done", or "failed" where the run could not go on; the numbers are those of what it computed.
    """

    gamma: float
    frequency: float
    numbers: Mapping[str, Any]
    residual: float
    status: str


def survey(
    scenario: BouncingTrimer,
    gammas: Iterable[float],
    frequencies: Iterable[float],
    periods: float,
    run: Run,
) -> list[Entry]:
    """Run a scenario for so many plate periods at every pair of Gamma and frequency [Hz]."""
    runs = [
        dataclasses.replace(scenario, gamma=gamma, frequency=frequency, t_end=periods / frequency)
        for frequency in frequencies
        for gamma in gammas
    ]
    found = []
    for one in runs:
        solution = _finished(one, run)
        numbers = one.summarise(solution)
        found.append(Entry(one.gamma, one.frequency, numbers, solution.energy.residual, solution.status))
    return found


def _finished(scenario: BouncingTrimer, run: Run) -> Solution:
    """Return the solution of a run, as far as it came: one that stops must not cost the survey."""
    try:
        return run(scenario)
    except RunFailed as error:
        return cast("Solution", error.solution)
