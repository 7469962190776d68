"""Property: a named statement about a component, and what is raised where it does not hold."""

from __future__ import annotations

import unittest
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, final

from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.errors import NonsmoothError
from nonsmooth.parameters import Component
from nonsmooth.testing.places import place_of, told


class PropertyFailed(NonsmoothError, AssertionError):
    """A property that does not hold.

    Parameters
    ----------
    thing : str
        The law, body, kinematics or scenario.
    prop : str
        The name of the property.
    reason : str
        What was found.
    parameter : str
        The parameters of the failing object, or the one at fault.
    value : object
        Their values.
    case : mapping of str to float
        The smallest failing input that was found; empty where the property has no inputs.
    place : str
        Name, file and line of the class, told where the reason names no line.
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
    """A property that could not be looked at, with the reason; pytest counts it as skipped."""


class Departs(NotChecked):
    """A property that does not hold, as the class says in its ``departures``."""


class Broken(Exception):
    """What a check raises inside the kit; :class:`Property` adds the names.

    Parameters
    ----------
    reason : str
        What was found.
    parameter, value, case
        Those of :class:`PropertyFailed`.
    """

    def __init__(
        self, reason: str, parameter: str = "", value: object = "", case: Mapping[str, float] | None = None
    ) -> None:
        super().__init__(reason)
        self.reason, self.parameter, self.value, self.case = reason, parameter, value, case or {}


@final
@dataclass(frozen=True)
class Property:
    """One thing that must hold of a component.

    Attributes
    ----------
    name : str
        A few words.
    says : str
        The statement in full.
    owner : type
        The class of the component.
    check : callable
        Looks at it; call the property instead, which turns whatever goes wrong into PropertyFailed.
    departure : str
        Why the component is known not to have it; nothing otherwise.
    """

    name: str
    says: str
    owner: type
    check: Callable[[], None]
    departure: str = ""

    @property
    def subject(self) -> str:
        """The name of the class."""
        return self.owner.__name__

    def __str__(self) -> str:
        return f"{self.subject}: {self.name}"

    def __call__(self) -> None:
        """Look whether it holds.

        Raises
        ------
        PropertyFailed
            If it does not, or does although the component says that it departs from it.
        NotChecked
            If it could not be looked at.
        Departs
            If it does not, and the component says so.
        """
        try:
            self._look()
        except PropertyFailed as failure:
            if self.departure:
                raise Departs(f"{self}, as it says: {self.departure}. {failure}") from failure
            raise
        if self.departure and not PLAIN:  # fewer inputs are tried in plain mode
            reason = f"it holds, although the class departs from it, as it says, because {self.departure}"
            raise PropertyFailed(self.subject, self.name, reason, "departures", self.name, {})

    def _look(self) -> None:
        try:
            self.check()
        except (PropertyFailed, NotChecked):
            raise
        except Broken as found:
            raise PropertyFailed(
                self.subject, self.name, found.reason, found.parameter, found.value, found.case, place_of(self.owner)
            ) from None
        except Exception as error:
            raise PropertyFailed(self.subject, self.name, told(error), "", "", {}, place_of(self.owner)) from error


Row = tuple[str, str, Callable[[], None]]
"""Name, statement and check of a property."""


def properties(component: Any, rows: list[Row]) -> list[Property]:
    """Return the properties of a component; those that its class departs from are marked."""
    owner: type[Component] = type(component)
    unknown = sorted(set(owner.departures) - {name for name, _, _ in rows})
    if unknown:

        def refuse() -> None:
            raise Broken("there are no such properties", "departures", unknown)

        rows = [*rows, ("departures", "they name properties", refuse)]
    return [Property(name, says, owner, check, owner.departures.get(name, "")) for name, says, check in rows]
