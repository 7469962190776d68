"""Checks of the inputs of studies: optional packages, displays, numbers."""

from __future__ import annotations

import importlib.util
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.checks import check_count, check_kind, floats, is_finite
from nonsmooth.errors import InvalidInput, MissingPackagesError
from nonsmooth.progress import Display, ProgressMeter, on_standard_error
from nonsmooth.types import Array

_REMEDY = 'pip install "nonsmooth[studies]"'


def require(what: str, *packages: str) -> None:
    """Raise MissingPackagesError unless all packages are installed; they are not imported."""
    missing = [name for name in packages if importlib.util.find_spec(name) is None]
    if missing:
        raise MissingPackagesError(f"{what} needs {', '.join(missing)}: {_REMEDY}")


def meter(display: Display | None) -> ProgressMeter:
    """Return a meter that reports progress to ``display``, by default to the display of standard error.

    Raises
    ------
    InvalidInput
        If `display` is not a :class:`Display`.
    """
    remedy = "Leave it out, or give nonsmooth.progress.Quiet(), which shows nothing, or a Display of your own."
    if display is not None:
        check_kind("display", display, Display, remedy)
    return ProgressMeter(display or on_standard_error())


def check_positive(thing: str, value: Any, remedy: str, rule: str = "must be positive and finite") -> None:
    """Raise InvalidInput unless a number is positive and finite."""
    if not (is_finite(value) and value > 0.0):
        raise InvalidInput(thing, rule, value, remedy)


def check_periods(study: str, **counts: int) -> None:
    """Raise InvalidInput unless all counts of periods are positive whole numbers."""
    for name, count in counts.items():
        rule = "must be positive and a whole number of periods"
        check_count(f"{study}: {name}", count, rule, f"For example {name}=64.")


def check_phase(thing: str, at: Any, period: float | None) -> None:
    """Raise InvalidInput unless ``at`` is a time within a period [s]."""
    if period is None or not (is_finite(at) and 0.0 <= at < period):
        remedy = "Give it in [s]." if period is None else f"Give it in [s]; a period has {period:.9g} s."
        raise InvalidInput(thing, "must be a time within a period", at, remedy)


def rising_times(thing: str, at: ArrayLike) -> Array:
    """Return times as an array [s], shape [n].

    Raises
    ------
    InvalidInput
        If the times are not positive, or do not rise.
    """
    times = np.atleast_1d(floats(thing, at))
    if not (len(times) and times[0] > 0.0 and np.all(np.diff(times) > 0.0)):
        raise InvalidInput(thing, "must be positive, rising times", times.tolist(), "Give them in [s].")
    return times
