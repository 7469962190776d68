"""Run a scenario as it says itself: its system, end time and samples."""

from __future__ import annotations

from nonsmooth.interfaces import Engine, Scenario
from nonsmooth.simulate import Progress, simulate
from nonsmooth.solution.solution import Solution


def run_scenario(scenario: Scenario, engine: Engine | None = None, *, progress: Progress | None = None) -> Solution:
    """Simulate a scenario until its end time.

    Parameters
    ----------
    scenario : Scenario
        The scenario with its parameters.
    engine : Engine, optional
        Engine with its options; :class:`EventDriven` by default.
    progress : callable, optional
        Called as ``progress(t, t_end)`` with the time reached and the end time [s].

    Returns
    -------
    Solution
        The solution.

    Raises
    ------
    InvalidInput
        If the system cannot be simulated; the message names the part and the remedy.
    RunFailed
        If the run fails; the error has the solution up to that time.
    """
    interval = scenario.sample_interval
    return simulate(scenario.build(), scenario.t_end, sample_interval=interval, engine=engine, progress=progress)
