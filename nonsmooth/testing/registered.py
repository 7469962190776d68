"""Check a component class against the rules of its interfaces.

The class is installed under a name or defined in a file, as in ``nonsmooth check``. Its interfaces decide which
functions of :mod:`nonsmooth.testing` check it.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from typing import Any

from nonsmooth import interfaces, testing
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.plugins import registry
from nonsmooth.testing.component import make
from nonsmooth.testing.outcome import place_of
from nonsmooth.testing.property import Property

_CHECKS: Mapping[Any, Callable[..., list[Property]]] = {
    interfaces.NormalLaw: testing.check_normal_law,
    interfaces.FrictionLaw: testing.check_friction_law,
    interfaces.TractionLaw: testing.check_traction_law,
    interfaces.ImpactLaw: testing.check_impact_law,
    interfaces.Body: testing.check_body,
    interfaces.Joint: testing.check_joint,
    interfaces.Load: testing.check_load,
    interfaces.Motion: testing.check_motion,
    interfaces.Shape: testing.check_shape,
    interfaces.Guard: testing.check_guard,
    interfaces.DistanceBackend: testing.check_distance_backend,
    interfaces.Engine: testing.check_engine,
    interfaces.Scenario: testing.check_scenario,
}
"""Function of the kit that checks a component, by the interface of the component."""


def check_class(owner: Any, name: str, words: Mapping[str, str]) -> list[Property]:
    """Return the properties of a component of a class, for every interface that it implements.

    Parameters
    ----------
    owner : type
        The class.
    name : str
        Name of the class in messages.
    words : mapping of str to str
        Values of parameters. Parameters that are not given are taken from the example of the class. Parameters without
        example and default get a value inside their range.

    Raises
    ------
    InvalidInput
        A value is wrong, a field without default and example is not a declared number, or the kit has no checks for the
        class.
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
    return testing.check_contact_kinematics(owner, first, second)


def _installed(kind: type[Shape]) -> type[Shape]:
    """Return a class of shapes; for an abstract class, the first installed class that derives from it."""
    if not inspect.isabstract(kind):
        return kind
    shapes: list[type[Shape]] = list(registry.load_all("shapes").values())
    derived = [shape for shape in shapes if issubclass(shape, kind)]
    if not derived:
        remedy = "No installed shape is such a shape."
        raise InvalidInput("check", "must be of a pair of shapes that are installed", kind.__name__, remedy)
    return derived[0]
