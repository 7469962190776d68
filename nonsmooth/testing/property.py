"""Named statements about a component that can be checked, and the exceptions of a statement that does not hold."""

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
"""File name of functions that cloudpickle has sent to the child process. In messages, the file of the component's class
replaces it."""


class PropertyFailed(NonsmoothError, AssertionError):
    """A property that does not hold.

    Parameters
    ----------
    thing : str
        Class name of the component, such as a law, body, kinematics or scenario.
    prop : str
        The name of the property.
    reason : str
        The fault that was found.
    parameter : str
        Name of the parameter or the attribute at fault, or "parameters" for all of the failing component.
    value : object
        Value of that parameter or attribute, or values of all parameters.
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
    """A property that does not hold, as the class declares in its ``departures``."""


@final
@dataclass(frozen=True)
class Property:
    """A statement that must hold of a component.

    Attributes
    ----------
    name : str
        Short name, such as "gap rate".
    says : str
        The statement in full.
    subject : Subject
        The component.
    departure : str
        Reason for which the class declares not to have the property; empty if the property must hold.
    """

    name: str
    says: str
    subject: Subject
    departure: str = ""

    @property
    def owner(self) -> type:
        """The class in whose name messages are written."""
        return self.subject.owner

    def __str__(self) -> str:
        return f"{self._thing}: {self.name}"

    @property
    def _thing(self) -> str:
        label = self.subject.label
        return f"{self.owner.__name__} ({label})" if label else self.owner.__name__

    def __call__(self) -> None:
        """Check the property in a child process, which is ended if the component does not return.

        Raises
        ------
        PropertyFailed
            The property does not hold, or it holds although the class lists it in its ``departures``.
        NotChecked
            The property could not be checked.
        Departs
            The property does not hold, and the class lists it in its ``departures``.
        """
        self._judge(ask(self.subject, self.name))

    def check(self) -> None:
        """Check the property in this process and without a time limit, so that a debugger can follow the check.

        Raises the exceptions of :meth:`__call__`.
        """
        self._judge(outcome_of(self.subject.all[self.name].check))

    def _judge(self, found: Outcome) -> None:
        print(found.printed, end="")
        thing, holds = self._thing, found.kind == "holds"
        # a function of a script or a notebook loses its file name when it is sent to the child process, which then
        # writes `_DYNAMIC` in the reason. Replace it by the file of the component's class
        reason = (
            found.reason.replace(_DYNAMIC, inspect.getfile(self.owner)) if _DYNAMIC in found.reason else found.reason
        )
        if found.kind == "not checked":
            raise NotChecked(reason)
        if holds and self.departure and not PLAIN:  # plain mode tries fewer inputs, so a failure may remain unnoticed
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
    """Return the properties of a component, with the reasons for the departures that it declares.

    ``options`` are those of ``rows``.

    Raises
    ------
    MissingPackagesError
        The package hypothesis or cloudpickle is not installed.
    """
    return properties_of(Subject(component, rows, options, type(component), type(component).departures))


def properties_of(subject: Subject) -> list[Property]:
    """Return the properties of a subject, as :func:`properties` does."""
    require_packages()
    return [Property(row.name, row.says, subject, subject.departures.get(row.name, "")) for row in subject.all.values()]
