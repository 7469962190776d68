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
    """Raise InvalidInput, naming ``thing``, unless the value is an instance of ``kind``."""
    if not isinstance(value, kind):
        raise InvalidInput(thing, f"must be of the kind {kind.__name__}", value, remedy)


def check_pair(thing: str, value: object) -> None:
    """Raise InvalidInput unless the value is a tuple or list of two entries."""
    if not isinstance(value, (tuple, list)) or len(value) != 2:
        raise InvalidInput(thing, "must be a pair", value, "Write (one, other).")


def check_callable(thing: str, value: object, call: str) -> None:
    """Raise InvalidInput unless the value is None, or can be called as ``call`` shows, such as "f(x)"."""
    rule = f"must be a function, called as {call}"
    if value is not None and not callable(value):
        raise InvalidInput(thing, rule, value, "Leave it out, or give a function.")
    if value is None:
        return
    try:
        taken = inspect.signature(value)
    except ValueError:  # some built-in functions have no signature
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
    """Raise InvalidInput unless a value is an integer of at least ``least``."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < least:
        raise InvalidInput(thing, rule, value, remedy)


def floats(thing: str, value: Any) -> NDArray[np.float64]:
    """Return a value as a new array of floats.  Raise InvalidInput if it has texts, booleans or other non-numbers."""
    try:
        if np.asarray(value).dtype.kind in "USb":
            raise TypeError("texts and truth values are no numbers")
        return np.array(value, dtype=float)
    except (TypeError, ValueError) as error:
        raise InvalidInput(
            thing, "must be an array of numbers", value, "See its shape and units in the help."
        ) from error


def path_of(thing: str, value: object) -> Path:
    """Path from a path or a text.

    Raises
    ------
    InvalidInput
        If the value is not a path or text, is blank, or is not a path that this machine can have.
    """
    if not isinstance(value, (str, Path)) or not str(value).strip():
        raise InvalidInput(thing, "must be a path", value, 'For example "results".')
    path = Path(value)
    try:
        path.lstat()
    except (FileNotFoundError, NotADirectoryError, PermissionError):
        # the function that writes to the path reports a missing or forbidden folder
        return path
    except (OSError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) else str(error)
        raise InvalidInput(thing, "must be a path that this machine can have", str(value), f"{why}.") from error
    return path
