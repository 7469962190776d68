"""The checks of a component, and their outcomes."""

from __future__ import annotations

import inspect
import sys
import unittest
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from types import TracebackType
from typing import Any, NamedTuple, final

from nonsmooth.errors import NonsmoothError
from nonsmooth.parameters import rules

_OTHERS = ("nonsmooth", "numpy", "scipy", "numba")
"""Packages whose code is not named as the place of an exception: the component that called it is named as the cause."""


class NotChecked(NonsmoothError, unittest.SkipTest):
    """A property that could not be checked, with the reason; pytest counts it as skipped."""


class Broken(Exception):
    """Raised inside of a check that finds a fault in a component.

    The user gets a :class:`PropertyFailed`, which is made from it and has the names of component and property, too.

    Parameters
    ----------
    reason, parameter, value, case
        As in :class:`PropertyFailed`.
    """

    def __init__(
        self, reason: str, parameter: str = "", value: object = "", case: Mapping[str, float] | None = None
    ) -> None:
        super().__init__(reason)
        self.reason, self.parameter, self.value, self.case = reason, parameter, value, case or {}


class Row(NamedTuple):
    """Name and statement of a property, and a check that raises Broken, NotChecked or any other exception."""

    name: str
    says: str
    check: Callable[[], None]


def name_of(check: Callable[..., Any]) -> str:
    """Return the name of a property: the name of the function that checks it, with blanks."""
    return check.__name__.strip("_").replace("_", " ")


def says_of(check: Callable[..., Any]) -> str:
    """Return the statement of a property: the docstring of the function that checks it."""
    return " ".join(inspect.cleandoc(check.__doc__ or "").split()).rstrip(".")


class Outcome(NamedTuple):
    """The result of a check.

    Attributes
    ----------
    kind : str
        "holds", "broken" or "not checked".
    reason, parameter, value, case
        As in :class:`PropertyFailed`; the reason is also given for "not checked".
    printed : str
        Text that the component printed during the check.
    """

    kind: str
    reason: str = ""
    parameter: str = ""
    value: Any = ""
    case: Mapping[str, float] = {}
    printed: str = ""


def outcome_of(check: Callable[[], None]) -> Outcome:
    """Run a check in this process and return its outcome."""
    try:
        check()
    except NotChecked as error:
        return Outcome("not checked", str(error))
    except Broken as found:
        value = found.value if isinstance(found.value, (int, float, str, dict)) else str(found.value)
        return Outcome("broken", found.reason, found.parameter, value, dict(found.case))
    except Exception as error:
        return Outcome("broken", words_of(error))
    return Outcome("holds")


@final
@dataclass(frozen=True, eq=False)
class Subject:
    """A component, and the function that returns its properties, each as a :class:`Row`.

    Attributes
    ----------
    component : object
        The component.
    rows : callable
        Takes the component and the options, and returns the properties.
    options : mapping
        Keyword arguments of ``rows``.
    owner : type
        The class in whose name messages are written.
    departures : mapping of str to str
        Properties that the component is known not to have, with reasons.
    label : str
        Suffix of the name of the class in messages, if a class has several subjects; may be empty.
    """

    component: Any
    rows: Callable[..., list[Row]]
    options: Mapping[str, Any]
    owner: type
    departures: Mapping[str, str] = field(default_factory=dict)
    label: str = ""

    def __reduce__(self) -> Any:
        """Pickle the component without its properties: another process makes them again."""
        return Subject, (self.component, self.rows, self.options, self.owner, dict(self.departures), self.label)

    @cached_property
    def all(self) -> Mapping[str, Row]:
        """The properties by name."""
        rows = {row.name: row for row in self.rows(self.component, **self.options)}
        if unknown := sorted(set(self.departures) - set(rows)):
            fault = Broken("there are no such properties", "departures", unknown)
            rows["departures"] = Row("departures", "They name properties", lambda: _raise(fault))
        return rows


def _raise(error: Exception) -> None:
    raise error


def place_of(owner: type) -> str:
    """Return name, file and line of a class as text; "" if the class has no file."""
    try:
        return f"{owner.__name__} in {inspect.getsourcefile(owner)}, line {inspect.getsourcelines(owner)[1]}"
    except (OSError, TypeError):
        return ""


def words_of(error: BaseException) -> str:
    """Return the message of an exception, with file and line of the last call in the component's own code.

    Calls in the standard library and in the packages of :data:`_OTHERS` are skipped.
    """
    trace, place = error.__traceback__, ""
    while trace is not None:
        if not _is_others(trace):
            place = f", in {trace.tb_frame.f_code.co_filename}, line {trace.tb_lineno}"
        trace = trace.tb_next
    return f"it raises {type(error).__name__}: {str(error).rstrip('.')}{place}"


def _is_others(trace: TracebackType) -> bool:
    package = str(trace.tb_frame.f_globals.get("__name__", "")).partition(".")[0]
    return package in _OTHERS or package in sys.stdlib_module_names


def described(component: Any) -> tuple[str, Any]:
    """Return the parameters of a component that have a value, as name and value for a message.

    Several parameters are returned as "parameters" and a mapping, no parameters as "" and "".
    """
    given = {name: getattr(component, name) for name in rules(type(component))}
    given = {name: value for name, value in given.items() if value is not None}
    if len(given) == 1:
        return next(iter(given.items()))
    return ("parameters", given) if given else ("", "")
