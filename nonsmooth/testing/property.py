"""Property: a named statement about a component, and the exceptions of a property that does not hold."""

from __future__ import annotations

import inspect
import sys
import unittest
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from types import TracebackType
from typing import Any, NamedTuple, final

from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.errors import NonsmoothError
from nonsmooth.parameters import Component, rules
from nonsmooth.testing.inputs import require_packages

_OTHERS = ("nonsmooth", "numpy", "scipy", "numba")
"""Packages that raise an exception because of what a component gives them."""


class PropertyFailed(NonsmoothError, AssertionError):
    """A property that does not hold.

    Parameters
    ----------
    thing : str
        The law, body, kinematics or scenario.
    prop : str
        The name of the property.
    reason : str
        The fault that was found.
    parameter : str
        The parameters of the failing object, or the parameter at fault.
    value : object
        Their values.
    case : mapping of str to float
        The simplest failing input that was found; empty for a property without inputs.
    place : str
        Name, file and line of the class. The message ends with it unless the reason names a line.
    """

    def __init__(
        self,
        thing: str,
        prop: str,
        reason: str,
        parameter: str,
        value: object,
        case: Mapping[str, float],
        place: str = "",
    ) -> None:
        self.thing, self.prop, self.reason = thing, prop, reason
        self.parameter, self.value, self.case = parameter, value, dict(case)
        parts = [f"{thing}: {prop!r} does not hold: {reason.rstrip('.')}."]
        if parameter:
            parts.append(f"With {parameter} = {value}.")
        if case:
            inputs = ", ".join(f"{name} = {number:.6g}" for name, number in case.items())
            parts.append(f"Smallest failing input: {inputs}.")
        if place and ", line " not in reason:
            parts.append(f"See {place}.")
        super().__init__(" ".join(parts))


class NotChecked(NonsmoothError, unittest.SkipTest):
    """A property that could not be checked, with the reason; pytest counts it as skipped."""


class Departs(NotChecked):
    """A property that does not hold, as the class says in its ``departures``."""


class Broken(Exception):
    """A fault that a check raises inside the kit; :class:`Property` adds the names.

    Parameters
    ----------
    reason, parameter, value, case
        Those of :class:`PropertyFailed`.
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


class Outcome(NamedTuple):
    """The result of a check: ``kind`` is "holds", "broken" or "not checked"; the rest says why."""

    kind: str
    reason: str = ""
    parameter: str = ""
    value: Any = ""
    case: Mapping[str, float] = {}
    printed: str = ""


def outcome_of(check: Callable[[], None]) -> Outcome:
    """Run a check in this process."""
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
    """A component, and the function that makes its rows.

    Attributes
    ----------
    component : object
        The component.
    rows : callable
        Takes the component and the options, and returns rows.
    options : mapping
        Keyword arguments of the function of the kit.
    """

    component: Any
    rows: Callable[..., list[Row]]
    options: Mapping[str, Any]

    def __reduce__(self) -> Any:
        """Leave the rows behind: another process makes its own."""
        return Subject, (self.component, self.rows, self.options)

    @cached_property
    def all(self) -> Mapping[str, Row]:
        """The rows by name."""
        owner: type[Component] = type(self.component)
        rows = {row.name: row for row in self.rows(self.component, **self.options)}
        if unknown := sorted(set(owner.departures) - set(rows)):
            fault = Broken("there are no such properties", "departures", unknown)
            rows["departures"] = Row("departures", "They name properties", lambda: _raise(fault))
        return rows


def _raise(error: Exception) -> None:
    raise error


@final
@dataclass(frozen=True)
class Property:
    """A statement that must hold of a component.

    Attributes
    ----------
    name : str
        A few words.
    says : str
        The statement in full.
    subject : Subject
        The component.
    departure : str
        Why the class is known not to have the property; empty otherwise.
    """

    name: str
    says: str
    subject: Subject
    departure: str = ""

    @property
    def owner(self) -> type:
        """The class of the component."""
        return type(self.subject.component)

    def __str__(self) -> str:
        return f"{self.owner.__name__}: {self.name}"

    def __call__(self) -> None:
        """Check the property in a child process, which is ended if the component does not come back.

        Raises
        ------
        PropertyFailed
            If it does not hold, or if it holds although the class says that it departs from it.
        NotChecked
            If it could not be checked.
        Departs
            If it does not hold, and the class says so.
        """
        from nonsmooth.testing.child import ask

        self._judge(ask(self.subject, self.name))

    def check(self) -> None:
        """Check the property in this process, without a limit of time: for a debugger. Raises as a call does."""
        self._judge(outcome_of(self.subject.all[self.name].check))

    def _judge(self, found: Outcome) -> None:
        print(found.printed, end="")
        thing, holds = self.owner.__name__, found.kind == "holds"
        if found.kind == "not checked":
            raise NotChecked(found.reason)
        if holds and self.departure and not PLAIN:  # fewer inputs are tried in plain mode
            reason = f"it holds, although the class departs from it, as it says, because {self.departure}"
            raise PropertyFailed(thing, self.name, reason, "departures", self.name, {})
        if holds:
            return
        failure = PropertyFailed(
            thing, self.name, found.reason, found.parameter, found.value, found.case, place_of(self.owner)
        )
        if self.departure:
            raise Departs(f"{self}, as it says: {self.departure}. {failure}") from failure
        raise failure


def properties(component: Any, rows: Callable[..., list[Row]], **options: Any) -> list[Property]:
    """Return the properties of a component; those that its class departs from are marked.

    Raises
    ------
    MissingPackagesError
        If hypothesis or cloudpickle is not installed.
    """
    require_packages()
    subject, departures = Subject(component, rows, options), type(component).departures
    return [Property(row.name, row.says, subject, departures.get(row.name, "")) for row in subject.all.values()]


def place_of(owner: type) -> str:
    """Return name, file and line of a class; empty if it has no file."""
    try:
        return f"{owner.__name__} in {inspect.getsourcefile(owner)}, line {inspect.getsourcelines(owner)[1]}"
    except (OSError, TypeError):
        return ""


def words_of(error: BaseException) -> str:
    """Return the message of an exception, with file and line of the last call outside of Python and the packages."""
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
    """Return names and values of the parameters that are given."""
    given = {name: getattr(component, name) for name in rules(type(component))}
    given = {name: value for name, value in given.items() if value is not None}
    if len(given) == 1:
        return next(iter(given.items()))
    return ("parameters", given) if given else ("", "")
