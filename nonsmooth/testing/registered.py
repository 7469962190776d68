"""The properties of a class that is installed under a name or stands in a file."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from typing import Any

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import (
    Body,
    ContactKinematics,
    DistanceBackend,
    Engine,
    FrictionLaw,
    Guard,
    ImpactLaw,
    Joint,
    Load,
    Motion,
    NormalLaw,
    Scenario,
    Shape,
    TractionLaw,
)
from nonsmooth.plugins import registry
from nonsmooth.testing.body import check_body
from nonsmooth.testing.component import make
from nonsmooth.testing.distances import check_distance_backend
from nonsmooth.testing.engine import check_engine
from nonsmooth.testing.friction import check_friction_law
from nonsmooth.testing.guard import check_guard
from nonsmooth.testing.impact import check_impact_law
from nonsmooth.testing.joint import check_joint
from nonsmooth.testing.kinematics import check_contact_kinematics
from nonsmooth.testing.load import check_load
from nonsmooth.testing.motion import check_motion
from nonsmooth.testing.normal import check_normal_law
from nonsmooth.testing.outcome import place_of
from nonsmooth.testing.property import Property
from nonsmooth.testing.scenario import check_scenario
from nonsmooth.testing.shape import check_shape
from nonsmooth.testing.traction import check_traction_law

_CHECKS: Mapping[Any, Callable[..., list[Property]]] = {
    NormalLaw: check_normal_law,
    FrictionLaw: check_friction_law,
    TractionLaw: check_traction_law,
    ImpactLaw: check_impact_law,
    Body: check_body,
    Joint: check_joint,
    Load: check_load,
    Motion: check_motion,
    Shape: check_shape,
    Guard: check_guard,
    DistanceBackend: check_distance_backend,
    Engine: check_engine,
    Scenario: check_scenario,
}
"""The function of the kit for each interface that a class may have."""


def check_class(owner: Any, name: str, words: Mapping[str, str]) -> list[Property]:
    """Return the properties of a component of a class, of each kind that it is.

    Parameters
    ----------
    owner : type
        The class.
    name : str
        Its name, for messages.
    words : mapping of str to str
        Parameters; those that are required and not given are those of the class's example, or take a value inside of
        their range.

    Raises
    ------
    InvalidInput
        If a value is wrong, a field without default is no declared number and not in the example, or the kit does not
        know its kind.
    """
    if issubclass(owner, ContactKinematics):
        return _of_pair(owner, name, words)
    component = make(owner, name, words)
    try:
        found = [prop for kind, check in _CHECKS.items() if isinstance(component, kind) for prop in check(component)]
    except InvalidInput as error:
        remedy = f"{error.remedy} See {place_of(owner)}."
        raise InvalidInput(error.thing, error.rule, error.value, remedy) from error
    if not found:
        kind = registry.kind_of(owner)
        raise InvalidInput(f"check {name}", "must be of a kind that the kit knows", kind, "Nothing would be checked.")
    return found


def _of_pair(owner: type[ContactKinematics], name: str, words: Mapping[str, str]) -> list[Property]:
    if words:
        remedy = f"The parameters of {name} follow from its shapes."
        raise InvalidInput("--set", "must be left out", dict(words), remedy)
    brought = owner.example()
    first, second = (
        brought[place] if place in brought else make(_installed(kind), kind.__name__, {})
        for place, kind in zip(("first", "second"), owner.pair, strict=True)
    )
    # a pair may hold by contacts of several classes
    own = next(contact for contact in owner.between(first, second) if type(contact) is owner)
    return check_contact_kinematics(own, first, second)


def _installed(kind: type[Shape]) -> type[Shape]:
    """Return a class of shapes, or of an abstract class the first installed that derives from it."""
    if not inspect.isabstract(kind):
        return kind
    shapes: list[type[Shape]] = list(registry.load_all("shapes").values())
    derived = [shape for shape in shapes if issubclass(shape, kind)]
    if not derived:
        remedy = "No installed shape is such a shape."
        raise InvalidInput("check", "must be of a pair of shapes that are installed", kind.__name__, remedy)
    return derived[0]
