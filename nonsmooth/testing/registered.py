"""The properties of a class that is installed under a name or stands in a file."""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import warnings
from collections.abc import Mapping
from typing import Any

from nonsmooth.errors import InvalidInput, NonsmoothError, PluginError
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
from nonsmooth.parameters import Rule, UnusualValue, from_words, rules
from nonsmooth.plugins import registry
from nonsmooth.testing.inputs import typical
from nonsmooth.testing.outcome import place_of, words_of
from nonsmooth.testing.property import Property

_CHECKS: Mapping[Any, str] = {
    NormalLaw: "normal.check_normal_law",
    FrictionLaw: "friction.check_friction_law",
    TractionLaw: "traction.check_traction_law",
    ImpactLaw: "impact.check_impact_law",
    Body: "body.check_body",
    Joint: "joint.check_joint",
    Load: "load.check_load",
    Motion: "motion.check_motion",
    Shape: "shape.check_shape",
    Guard: "guard.check_guard",
    DistanceBackend: "distances.check_distance_backend",
    Engine: "engine.check_engine",
    Scenario: "scenario.check_scenario",
}
"""Interface -> module and function of the kit, which is imported for the interfaces that a class has."""


def _check(interface: Any, component: Any) -> list[Property]:
    module, _, name = _CHECKS[interface].partition(".")
    found: list[Property] = vars(importlib.import_module(f"nonsmooth.testing.{module}"))[name](component)
    return found


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
        found = [
            prop for interface in _CHECKS if isinstance(component, interface) for prop in _check(interface, component)
        ]
    except InvalidInput as error:
        remedy = f"{error.remedy} See {place_of(owner)}."
        raise InvalidInput(error.thing, error.rule, error.value, remedy) from error
    if not found:
        kind = registry.kind_of(owner)
        raise InvalidInput(f"check {name}", "must be of a kind that the kit knows", kind, "Nothing would be checked.")
    return found


def _of_pair(owner: type[ContactKinematics], name: str, words: Mapping[str, str]) -> list[Property]:
    from nonsmooth.testing.kinematics import check_contact_kinematics

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


def make(owner: Any, name: str, words: Mapping[str, str]) -> Any:
    """Return a component with the parameters given, those of its example, and some value for others without default.

    Raises
    ------
    InvalidInput
        If a value is wrong, or a field without default is no declared number and not in the example.
    PluginError
        If the class raises anything else.
    """
    values = {**owner.example(), **from_words(owner, words, name)}
    for field in dataclasses.fields(owner):
        if field.name in values or not field.init or field.default is not field.default_factory:
            continue
        rule = rules(owner)[field.name][1] if field.name in rules(owner) else Rule("", "")
        if rule.unit == "" and not rule.choices:
            remedy = f"Let {owner.__name__}.example return one, or pass an object to the function of nonsmooth.testing."
            raise InvalidInput(f"{name}.{field.name}", "must have a value to be checked with", None, remedy)
        values[field.name] = rule.choices[0] if rule.choices else typical(rule)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnusualValue)
        try:
            return owner(**values)
        except NonsmoothError:
            raise
        except Exception as error:
            raise PluginError(f"{name} cannot be made with {values}: {words_of(error)}.") from error
