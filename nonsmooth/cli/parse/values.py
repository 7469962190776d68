"""Values of a parameter from one argument: lists, ranges and draws of ``--over``, and the period of ``--period``."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.cli.parse.request import assignments
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.studies.orbits.scan import Period
from nonsmooth.studies.sampling import Sampling, grid, latin_hypercube, random, sobol

OVER = (
    "NAME=LOW:HIGH:N for N values, both ends among them, NAME=A,B,C for these, NAME=LOW:HIGH with --sample; may come "
    "often"
)
PERIOD = "a number, or N/NAME or Npi/NAME if the parameter NAME of --over is the frequency"
_DRAWS: Mapping[str, Callable[..., Sampling]] = {"random": random, "sobol": sobol, "latin_hypercube": latin_hypercube}
_GRID, _RANGE = "LOW:HIGH:N, or values apart by commas", "LOW:HIGH"
_SAMPLED = ", or 0.5:0.9 for a range, with --sample"
_EXAMPLE = "For example --over restitution=0.5:0.9:41"
_PERIOD = re.compile(r"(?P<count>\d*\.?\d*)\s*(?P<pi>pi)?\s*/\s*(?P<name>\S+)")


def sampling(words: Iterable[str], sample: str | None, seed: int) -> Sampling:
    """Return the sampling that the values of ``--over``, ``--sample`` and ``--seed`` describe.

    Raises
    ------
    InvalidInput
        If a value is malformed, a parameter is given twice, or a range is empty.
    """
    named: dict[str, str] = {}
    for word in words:
        name, values = _cut(word)
        if name in named:
            raise InvalidInput(f"--over {name}", "must come once", word, "Leave one out.")
        named[name] = values
    if sample is None:
        return grid(**{name: _values(name, word, _SAMPLED) for name, word in named.items()})
    kind, _, count = sample.partition(":")
    if kind not in _DRAWS:
        raise UnknownName("--sample", kind, _DRAWS)
    ranges = {name: _numbers(name, word.split(":"), _RANGE) for name, word in named.items()}
    return _DRAWS[kind](_count("--sample", count), seed, **ranges)


def axis(word: str) -> tuple[str, list[float]]:
    """Return parameter and values of NAME=LOW:HIGH:N or NAME=A,B,C; InvalidInput if a value is not a number."""
    name, values = _cut(word)
    row = _values(name, values)
    if not np.issubdtype(row.dtype, np.floating):
        raise _refusal(name, _GRID, values)
    return name, row.tolist()


def span(word: str) -> tuple[str, tuple[float, float]]:
    """Return the parameter and both ends of its range from NAME=LOW:HIGH."""
    name, values = _cut(word)
    return name, _numbers(name, values.split(":"), _RANGE)


def check_not_set(words: Iterable[str], given: Iterable[str]) -> None:
    """Raise InvalidInput if the user gives a parameter by both ``--over`` and ``--set``."""
    fixed = assignments(given)
    for name in (_cut(word)[0] for word in words):
        if name in fixed:
            raise InvalidInput(f"--set {name}", f"must be left out with --over {name}", fixed[name], "Leave one out.")


def period(word: str, name: str) -> Period:
    """Return the period [s], or a function that computes the period [s] from a value of the parameter.

    Parameters
    ----------
    word : str
        A number of seconds, "1/frequency" or "2pi/omega".
    name : str
        The parameter that is varied.

    Raises
    ------
    InvalidInput
        If the text is malformed, or names another parameter.
    """
    try:
        return float(word)
    except ValueError:
        pass
    found = _PERIOD.fullmatch(word.strip())
    if found is None or not (found["count"].strip(".") or found["pi"]):
        remedy = f"For example --period 0.04, --period 1/{name} or --period 2pi/{name}."
        raise InvalidInput("--period", "must be a number of seconds, N/NAME or Npi/NAME", word, remedy)
    if found["name"] != name:
        raise UnknownName("--period: parameter of --over", found["name"], [name])
    number = float(found["count"] or 1.0) * (math.pi if found["pi"] else 1.0)
    return lambda value: number / value if value else math.inf


def tolerance(thing: str, word: str) -> tuple[str, float]:
    """Return name and tolerance from NAME=TOLERANCE; ``thing`` names the option in messages."""
    name, _, number = word.partition("=")
    try:
        return name.strip(), float(number)
    except ValueError:
        remedy = f"For example {thing} {name.strip()}=1e-3."
        raise InvalidInput(thing, "must have the form NAME=TOLERANCE", word, remedy) from None


def _cut(word: str) -> tuple[str, str]:
    name, equals, values = (part.strip() for part in word.partition("="))
    if not (name and equals and values):
        raise InvalidInput("--over", "must have the form NAME=VALUES", word, f"{_EXAMPLE}.")
    return name, values


def _values(name: str, word: str, more: str = "") -> NDArray[Any]:
    """Return the values of a list ("1,2,5") or of a grid; error messages also name ``more``, another accepted form."""
    if ":" in word:
        *parts, n = word.split(":")
        if len(parts) != 2:
            raise _refusal(name, _GRID, word, more)
        ends = _numbers(name, parts, _GRID)
        if not ends[0] < ends[1]:
            raise InvalidInput(f"--over {name}", "must be a range, the lower end first", word, f"{_EXAMPLE}.")
        return np.linspace(*ends, _count(f"--over {name}", n))
    parts = word.split(",")
    try:
        return np.array([float(part) for part in parts])
    except ValueError:
        return np.array(parts)


def _numbers(name: str, words: list[str], form: str) -> tuple[float, float]:
    """Return both ends of a range as numbers; ``form`` is the expected form, for messages."""
    try:
        low, high = (float(word) for word in words)
    except ValueError:
        raise _refusal(name, form, ":".join(words)) from None
    return low, high


def _refusal(name: str, form: str, word: str, more: str = "") -> InvalidInput:
    return InvalidInput(f"--over {name}", f"must have the form {form}", word, f"{_EXAMPLE}{more}.")


def _count(thing: str, word: str) -> int:
    if not word.isdigit() or int(word) < 1:
        raise InvalidInput(thing, "must have a positive whole number of values", word, "For example 41.")
    return int(word)
