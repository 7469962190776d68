"""Checks of the arguments of a run, before anything runs."""

from __future__ import annotations

from nonsmooth.checks import check_callable, is_finite
from nonsmooth.errors import InvalidInput
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.runs.loop import Progress
from nonsmooth.runs.so_far import Until
from nonsmooth.solution.request import RunRequest

_DEFAULT_SAMPLES = 2000
"""Number of samples if no interval is given: enough for a curve as wide as a screen."""
_MOST_SAMPLES = 10**8
"""Largest number of samples of a run. Those of one small body then take more memory than most machines have."""
_MOST_STEPS = 10**10
"""Largest number of steps of a run. At a microsecond each, the least possible, they take three hours."""


def check_calls(name: str, until: Until | None, progress: Progress | None) -> None:
    """Check that ``until`` and ``progress`` of the method ``name`` can be called.

    Raises
    ------
    InvalidInput
        If one is no function of its arguments.
    """
    check_callable(f"{name}: until", until, "until(run)")
    check_callable(f"{name}: progress", progress, "progress(t, t_end)")


def check_steps(duration: float, largest_step: float) -> None:
    """Check that a run of a duration [s] can end within hours if no step exceeds ``largest_step`` [s], 0 if unlimited.

    Raises
    ------
    InvalidInput
        If the run would take more than 1e10 steps.
    """
    if largest_step > 0.0 and duration > _MOST_STEPS * largest_step:
        raise InvalidInput(
            "run: largest step",
            f"must be at least {duration / _MOST_STEPS:.3g} s for a run of {duration:.6g} s, {_MOST_STEPS:.0e} steps",
            largest_step,
            "It is the least of EventDriven.largest_step and, of prescribed motions, the time scale over "
            "EventDriven.steps_per_period. Run for a shorter time, or let the motion change more slowly.",
        )


def check_times(name: str, t_end: float, sample_interval: float | None, start: float = 0.0) -> float:
    """Check the times [s] of a run from ``start``. Time between samples [s]: a 2000th of the run if None is given.

    ``name`` is that of the user's call, for messages. Comparisons are written so that NaN fails them.

    Raises
    ------
    InvalidInput
        If the end time is not after the start, a time is not finite, or the interval is not positive or too short.
    """
    if not is_finite(t_end) or not t_end > start:
        rule = "must be positive and finite" if start == 0.0 else f"must be finite and after the start at {start:.9g} s"
        raise InvalidInput(f"{name}: t_end", rule, t_end, "Give it in [s].")
    interval = (t_end - start) / _DEFAULT_SAMPLES if sample_interval is None else sample_interval
    if not (is_finite(interval) and interval > 0.0):
        raise InvalidInput(f"{name}: sample_interval", "must be positive and finite", interval, "Give it in [s].")
    if not t_end - start <= _MOST_SAMPLES * interval:
        rule = f"must give at most {_MOST_SAMPLES:.0e} samples within {t_end - start:.6g} s"
        raise InvalidInput(f"{name}: sample_interval", rule, interval, "Take a longer one, in [s].")
    return interval


def checked_request(folder: SolutionFolder, until: Until | None) -> RunRequest:
    """Arguments of a run that was cut off, read from its folder, so that it can be resumed with them.

    Raises
    ------
    InvalidInput
        If the run was not cut off, its condition is missing, or the folder is damaged.
    """
    folder.check_cut_off()
    request = folder.request
    if request.is_conditional and until is None:
        raise InvalidInput(
            f"resume {folder.place}: until",
            "must be given for a run that was to end on a condition, which no file holds",
            None,
            "Give the same function: nonsmooth.resume(folder, until=...).",
        )
    check_times(f"resume {folder.place}", request.t_end, request.sample_interval, request.sample_start)
    return request
