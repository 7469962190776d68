"""What ``--period`` says: a time, or a number over the parameter of ``--over``, which is a frequency."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

from nonsmooth.errors import InvalidInput, UnknownName

Period = float | Callable[[float], float]
HELP = "after which what drives it repeats; N/NAME or Npi/NAME if the parameter NAME of --over is its frequency"
_OVER = re.compile(r"(?P<count>\d*\.?\d*)\s*(?P<pi>pi)?\s*/\s*(?P<name>\S+)")


def period(word: str, name: str) -> Period:
    """Return the period [s], or the function of the parameter that returns it.

    Parameters
    ----------
    word : str
        A number of seconds, "1/frequency" or "2pi/omega".
    name : str
        The parameter that is varied.

    Raises
    ------
    InvalidInput
        If the word has another form, or names another parameter.
    """
    try:
        return float(word)
    except ValueError:
        pass
    found = _OVER.fullmatch(word.strip())
    if found is None or not (found["count"].strip(".") or found["pi"]):
        remedy = f"For example --period 0.04, --period 1/{name} or --period 2pi/{name}."
        raise InvalidInput("--period", "must be a number of seconds, N/NAME or Npi/NAME", word, remedy)
    if found["name"] != name:
        raise UnknownName("--period: parameter of --over", found["name"], [name])
    number = float(found["count"] or 1.0) * (math.pi if found["pi"] else 1.0)

    def over(value: float) -> float:
        return number / value if value else math.inf

    return over
