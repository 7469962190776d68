"""Find the law function that returned a value in the engine that is not finite, and the input of this call.

The engine stores the input of such a call in front of the function's parameters.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from nonsmooth.binding import interpreted
from nonsmooth.binding.compile import parameter_names
from nonsmooth.binding.law_functions import LawFunction
from nonsmooth.binding.source import described, returned
from nonsmooth.engine.native.forms import FORMS

REMEDY = "It must return a finite number; with NONSMOOTH_PLAIN=1 a debugger can step through it."


class Finding(NamedTuple):
    """Result of the search for the failure of a law function whose value in the engine was not finite.

    ``text`` is the message for the user. ``again`` is True if a second call with the same input fails, too.
    """

    text: str
    again: bool


def first_without_value(findings: Iterable[Finding | None]) -> str:
    """Message on the first function that gave no finite value; "" if there is no such function.

    A function that fails again if it is called with the same input has precedence. In ``findings``, None is a function
    without failure.
    """
    found = [finding for finding in findings if finding is not None]
    return next((finding.text for finding in found if finding.again), found[0].text if found else "")


def without_value(
    heap: NDArray[np.float64], part: LawFunction, state: Sequence[float] | NDArray[np.float64] = (), where: str = ""
) -> Finding | None:
    """Message on the last call of a law function in the engine whose value was not finite, with the call's input.

    The result is None if all values were finite.

    Parameters
    ----------
    heap : array
        The engine's memory from the beginning of the function's block on, which has the stored input and then the
        parameters.
    part : LawFunction
        The function.
    state : sequence of float
        The inner states of the law.
    where : str
        The contact, for the message.
    """
    numbers = heap[: FORMS[part.form].n_recorded].tolist()
    if not np.all(np.isfinite(numbers)):
        return None
    offered = {**part.law.parameters(), "state": np.array(state)}
    values = {name: offered[name] for name in parameter_names(part.function, part.form)}
    vectors = {"motion": np.array(numbers[1:]), "state": np.array(state)}
    inputs = {role: vectors[role] if role in vectors else numbers[i] for i, role in enumerate(FORMS[part.form].given)}
    words, again = _outcome(part, inputs, values, len(state))
    given = {name: _plain(value) for name, value in values.items()}
    at = ", ".join(f"{name} = {_plain(value)}" for name, value in inputs.items())
    at = _plain(numbers[0]) if part.form == "scalar" else at
    owner = f"{type(part.law).__name__}: {described(part.function)},"
    return Finding(f"{owner} {words} at {at} with {given}. {REMEDY} ({where})", again)


def _outcome(part: LawFunction, inputs: dict[str, Any], values: dict[str, Any], n_state: int) -> tuple[str, bool]:
    """Value or error of a call of a law's function as text; True if it raised an error or its value is not finite."""
    if noted := interpreted.noted(part.function):
        return noted, True
    if FORMS[part.form].returns:
        words, value = returned(part.function, *inputs.values(), **values)
        return words, not (isinstance(value, (int, float)) and math.isfinite(value))
    out = np.zeros(5 + n_state)
    words, _ = returned(part.function, *inputs.values(), out, **values)
    words = words.replace("returns None", f"writes {out.tolist()}")
    return words, words.startswith("raises") or not bool(np.all(np.isfinite(out)))


def _plain(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else value
