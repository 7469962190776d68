"""Property: a named statement about a component, and the exceptions of a property that does not hold."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, final

from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.errors import NonsmoothError
from nonsmooth.testing.child import ask
from nonsmooth.testing.inputs import require_packages
from nonsmooth.testing.outcome import NotChecked, Outcome, Row, Subject, outcome_of, place_of

_DYNAMIC = "<dynamic-code>"
"""File that cloudpickle gives the functions that it carries."""


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


class Departs(NotChecked):
    """A property that does not hold, as the class says in its ``departures``."""


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
        self._judge(ask(self.subject, self.name))

    def check(self) -> None:
        """Check the property in this process, without a limit of time: for a debugger. Raises as a call does."""
        self._judge(outcome_of(self.subject.all[self.name].check))

    def _judge(self, found: Outcome) -> None:
        print(found.printed, end="")
        thing, holds = self.owner.__name__, found.kind == "holds"
        # a function of a script or a notebook has lost its file on the way to the other process
        reason = (
            found.reason.replace(_DYNAMIC, inspect.getfile(self.owner)) if _DYNAMIC in found.reason else found.reason
        )
        if found.kind == "not checked":
            raise NotChecked(reason)
        if holds and self.departure and not PLAIN:  # fewer inputs are tried in plain mode
            held = f"it holds, although the class departs from it, as it says, because {self.departure}"
            raise PropertyFailed(thing, self.name, held, "departures", self.name, {})
        if holds:
            return
        failure = PropertyFailed(
            thing, self.name, reason, found.parameter, found.value, found.case, place_of(self.owner)
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
