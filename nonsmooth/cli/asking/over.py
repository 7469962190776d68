"""What ``--over`` and ``--sample`` say: a sampling, the values of one parameter, or its range."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.cli.asking.request import assignments
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.studies.sampling import Sampling, grid, latin_hypercube, random, sobol

HELP = (
    "a parameter and its values: NAME=LOW:HIGH:N for N values, both ends among them, NAME=A,B,C for these; "
    "NAME=LOW:HIGH with --sample; may come often"
)
_DRAWS: Mapping[str, Callable[..., Sampling]] = {"random": random, "sobol": sobol, "latin_hypercube": latin_hypercube}
_GRID, _RANGE = "LOW:HIGH:N, or values apart by commas", "LOW:HIGH"
_EXAMPLE = "For example --over restitution=0.5:0.9:41"


def sampling(words: Iterable[str], sample: str | None, seed: int) -> Sampling:
    """Return the sampling that was asked for.

    Raises
    ------
    InvalidInput
        If a word has another form, or a range is empty.
    """
    named: dict[str, str] = {}
    for word in words:
        name, values = _cut(word)
        if name in named:
            raise InvalidInput(f"--over {name}", "must come once", word, "Leave one out.")
        named[name] = values
    if sample is None:
        return grid(**{name: _values(name, word) for name, word in named.items()})
    kind, _, count = sample.partition(":")
    if kind not in _DRAWS:
        raise UnknownName("--sample", kind, _DRAWS)
    ranges = {name: _range(name, word) for name, word in named.items()}
    return _DRAWS[kind](_whole("--sample", count), seed, **ranges)


def axis(word: str) -> tuple[str, list[float]]:
    """Return a parameter and its values.

    Raises
    ------
    InvalidInput
        If the word has another form, a range is empty, or a value is no number.
    """
    name, values = _cut(word)
    row = _values(name, values)
    if not np.issubdtype(row.dtype, np.floating):
        raise _refusal(name, _GRID, values)
    return name, row.tolist()


def span(word: str) -> tuple[str, tuple[float, float]]:
    """Return a parameter and its range.

    Raises
    ------
    InvalidInput
        If the word has another form.
    """
    name, values = _cut(word)
    return name, _range(name, values)


def check_not_set(words: Iterable[str], given: Iterable[str]) -> None:
    """Refuse a parameter that has a value besides those it is varied over.

    Raises
    ------
    InvalidInput
        If there is one.
    """
    fixed = assignments(given)
    for name in (_cut(word)[0] for word in words):
        if name in fixed:
            raise InvalidInput(f"--set {name}", f"must be left out with --over {name}", fixed[name], "Leave one out.")


def _cut(word: str) -> tuple[str, str]:
    name, equals, values = (part.strip() for part in word.partition("="))
    if not (name and equals and values):
        raise InvalidInput("--over", "must have the form NAME=VALUES", word, f"{_EXAMPLE}.")
    return name, values


def _values(name: str, word: str) -> NDArray[Any]:
    if ":" in word:
        *parts, n = word.split(":")
        if len(parts) != 2:
            raise _refusal(name, _GRID, word)
        ends = _numbers(name, parts, _GRID)
        if not ends[0] < ends[1]:
            raise InvalidInput(f"--over {name}", "must be a range, the lower end first", word, f"{_EXAMPLE}.")
        return np.linspace(*ends, _whole(f"--over {name}", n))
    parts = word.split(",")
    try:
        return np.array([float(part) for part in parts])
    except ValueError:
        return np.array(parts)


def _range(name: str, word: str) -> tuple[float, float]:
    return _numbers(name, word.split(":"), _RANGE)


def _numbers(name: str, words: list[str], form: str) -> tuple[float, float]:
    """Return two numbers out of as many words."""
    try:
        low, high = (float(word) for word in words)
    except ValueError:
        raise _refusal(name, form, ":".join(words)) from None
    return low, high


def _refusal(name: str, form: str, word: str) -> InvalidInput:
    return InvalidInput(f"--over {name}", f"must have the form {form}", word, f"{_EXAMPLE}, or 0.5:0.9 for a range.")


def _whole(thing: str, word: str) -> int:
    if not word.isdigit() or int(word) < 1:
        raise InvalidInput(thing, "must have a positive whole number of values", word, "For example 41.")
    return int(word)
