"""Simulate a system or a scenario, and assemble a system to be run often."""

from __future__ import annotations

import contextlib
from pathlib import Path

from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.interfaces import Engine, Scenario
from nonsmooth.progress import ProgressMeter, TimeReached, of_long_run
from nonsmooth.results.output import Output
from nonsmooth.results.overwriting import check_free
from nonsmooth.runs.checks import check_times
from nonsmooth.runs.loop import Progress
from nonsmooth.runs.model import Model
from nonsmooth.runs.so_far import Until
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

__all__ = ["Progress", "assemble", "run_scenario", "simulate"]


def assemble(system: System, engine: Engine | None = None) -> Model:
    """Assemble a system once, to run it many times: ``model.run(t_end, start=...)``.

    Parameters
    ----------
    system : System
        Bodies, contacts, starts.  Later changes of the system do not change the model.
    engine : Engine, optional
        Engine with its options; :class:`EventDriven` by default.

    Returns
    -------
    Model
        The model.

    Warns
    -----
    UndeclaredOverlap
        If two bodies overlap at the start that have no contact, no joint and no exclusion between them.

    Raises
    ------
    InvalidInput
        If the engine cannot run the system, or the start is not valid.
    """
    return Model.of(system, _engine(engine))


def simulate(
    system: System,
    t_end: float,
    *,
    sample_interval: float | None = None,
    engine: Engine | None = None,
    until: Until | None = None,
    progress: Progress | bool | None = True,
    output: Output | Path | str | None = None,
) -> Solution:
    """Simulate a system from t = 0: assemble it and run it once.

    Parameters
    ----------
    system : System
        Bodies, contacts, starts.
    t_end : float
        End time [s].
    sample_interval : float, optional
        Time between stored samples [s]; t_end / 2000 by default.  Events are stored exactly in any case.
    engine : Engine, optional
        Engine with its options; :class:`EventDriven` by default.
    until : callable, optional
        A condition that ends the run (:meth:`nonsmooth.Model.run`).
    progress : callable or bool, optional
        ``progress(time, t_end)`` [s], called repeatedly, also within a long impact.  An exception ends the run and is
        raised.  By default a run of more than 3 s shows a bar on standard error, if this is a terminal or the output
        of a notebook; False or None shows none.
    output : Output, Path or str, optional
        A folder to which events and samples are appended during the run (:meth:`nonsmooth.Model.run`).  The system is
        stored there, too, if all of its classes are installed; otherwise give it to :func:`open_solution`.

    Returns
    -------
    Solution
        Its status is "done", "suspect" if a check of the run failed (the message names it), or "interrupted" after
        Ctrl-C.

    Warns
    -----
    UndeclaredOverlap
        If two bodies overlap at the start that have no contact, no joint and no exclusion between them.

    Raises
    ------
    InvalidInput
        If the engine cannot run this system; if the start of the system or an argument is not valid; or if the folder
        holds a run that is under way or was cut off.  The run has not started then.
    FileError
        If the folder cannot be written to as the run begins.
    RunFailed
        If the run cannot continue, or its results cannot be written any more.  ``solution`` of the error holds the
        results until then.
    """
    check_times("simulate", t_end, sample_interval)
    if output is not None:
        check_free(Output.to(output))
    model = Model.of(system, _engine(engine))
    with contextlib.ExitStack() as stack:
        if isinstance(progress, bool):
            display = of_long_run() if progress else None
            progress = None if display is None else TimeReached(stack.enter_context(ProgressMeter(display)))
        return model.run(t_end, sample_interval=sample_interval, until=until, progress=progress, output=output)


def _engine(given: Engine | None) -> Engine:
    return EventDriven() if given is None else given


def run_scenario(
    scenario: Scenario, engine: Engine | None = None, *, progress: Progress | bool | None = True
) -> Solution:
    """Simulate a scenario until its end time.

    Parameters
    ----------
    scenario : Scenario
        The scenario with its parameters.
    engine : Engine, optional
        Engine with its options; :class:`EventDriven` by default.
    progress : callable or bool, optional
        Called as ``progress(t, t_end)`` with the time reached and the end time [s]; otherwise as for :func:`simulate`.

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
