"""Checks of the arguments of public functions: kinds, and finite numbers."""

from __future__ import annotations

import inspect
import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput


def check_kind(thing: str, value: object, kind: type, remedy: str) -> None:
    """Raise InvalidInput, naming ``thing``, unless the value is of a kind."""
    if not isinstance(value, kind):
        raise InvalidInput(thing, f"must be of the kind {kind.__name__}", value, remedy)


def check_pair(thing: str, value: object) -> None:
    """Raise InvalidInput unless the value is a tuple or list of two."""
    if not isinstance(value, (tuple, list)) or len(value) != 2:
        raise InvalidInput(thing, "must be a pair", value, "Write (one, other).")


def check_callable(thing: str, value: object, call: str) -> None:
    """Raise InvalidInput unless the value is left out, None, or can be called as ``call`` shows: "f(x)"."""
    rule = f"must be a function, called as {call}"
    if value is not None and not callable(value):
        raise InvalidInput(thing, rule, value, "Leave it out, or give a function.")
    if value is None:
        return
    try:
        taken = inspect.signature(value)
    except ValueError:  # some built-in functions do not say what they take
        return
    names = call[call.index("(") + 1 : -1].split(", ")
    try:
        taken.bind(*names)
    except TypeError as error:
        raise InvalidInput(thing, rule, str(taken), f"Let it take {len(names)}: {', '.join(names)}.") from error


def is_finite(value: Any) -> bool:
    """True if a value is a finite number of Python or numpy; booleans are not numbers."""
    if isinstance(value, (bool, np.bool_)):
        return False
    try:
        return math.isfinite(value)
    except (TypeError, OverflowError):
        return False


def check_count(thing: str, value: Any, rule: str, remedy: str, least: int = 1) -> None:
    """Raise InvalidInput unless a value is a whole number of at least ``least``."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < least:
        raise InvalidInput(thing, rule, value, remedy)


def floats(thing: str, value: Any) -> NDArray[np.float64]:
    """Array of numbers of its own; InvalidInput if they are none, as texts and truth values are."""
    try:
        if np.asarray(value).dtype.kind in "USb":
            raise TypeError("texts and truth values are no numbers")
        return np.array(value, dtype=float)
    except (TypeError, ValueError) as error:
        raise InvalidInput(
            thing, "must be an array of numbers", value, "See its shape and units in the help."
        ) from error


def path_of(thing: str, value: object) -> Path:
    """Path that is given as one or as a text.

    Raises
    ------
    InvalidInput
        If it is neither, or a text without a letter, or no path that this machine can have.
    """
    if not isinstance(value, (str, Path)) or not str(value).strip():
        raise InvalidInput(thing, "must be a path", value, 'For example "results".')
    path = Path(value)
    try:
        path.lstat()
    except (FileNotFoundError, NotADirectoryError, PermissionError):
        # whoever writes there says so
        return path
    except (OSError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) else str(error)
        raise InvalidInput(thing, "must be a path that this machine can have", str(value), f"{why}.") from error
    return path
