"""A trial over drawn inputs and over parameters of the component."""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable, Iterable
from typing import Any

from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.errors import NonsmoothError
from nonsmooth.parameters import UnusualValue, rules
from nonsmooth.testing.draws import Case, Space, draws, shrink
from nonsmooth.testing.places import told
from nonsmooth.testing.property import Broken, NotChecked

Trial = Callable[[Any, Case], str]
"""Looks at a component and an input; returns what is wrong, nothing where all is well."""
FEWEST = 3
"""Inputs of trials by the engine in plain mode, where it is some 400 times slower."""


def described(component: Any) -> tuple[str, Any]:
    """Return names and values of the parameters that are given."""
    given = {name: getattr(component, name) for name in rules(type(component))}
    given = {name: value for name, value in given.items() if value is not None}
    if len(given) == 1:
        return next(iter(given.items()))
    return ("parameters", given) if given else ("", "")


def attempt(trial: Trial, component: Any, case: Case) -> str:
    """Return what is wrong, an exception included."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UnusualValue)
            return trial(component, case)
    except NotChecked:
        raise
    except (NonsmoothError, ArithmeticError, LookupError, TypeError, ValueError) as error:
        return told(error)


def _fails(trial: Trial, component: Any, case: Case) -> bool:
    return attempt(trial, component, case) != ""


def examine(
    name: str, components: Iterable[Any], space: Space, trial: Trial, count: int, *, fewest: int | None = None
) -> None:
    """Try ``count`` inputs on each component; in plain mode ``fewest`` of them, if that is given.

    Raises
    ------
    Broken
        If one fails, with the smallest input that does.
    """
    count = fewest if PLAIN and fewest is not None else count
    for component in components:
        for case in draws(space, count, name):
            found = attempt(trial, component, case)
            if found:
                smallest = shrink(case, space, functools.partial(_fails, trial, component))
                again = attempt(trial, component, smallest) or f"{found}; tried again, it holds: something is random"
                raise Broken(again, *described(component), smallest)
