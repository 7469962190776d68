"""The functions of the laws of a contact, and the fields of a contact by which the engine finds each of them.

The engine calls a function by its address, with its parameters. Both are fields of a contact.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from nonsmooth.engine.memory import owners
from nonsmooth.interfaces import (
    CompliantNormalLaw,
    FrictionLaw,
    ImpactLaw,
    ImpactProcess,
    NormalLaw,
    StatefulFrictionLaw,
    TangentialLaw,
    TractionLaw,
)
from nonsmooth.parameters import Component

_CONTACT = owners.ContactRecord


class LawFunction(NamedTuple):
    """A function of the laws of a contact.

    Attributes
    ----------
    address, parameters : declaration
        Fields of a contact: the address of the function, and the offset of its parameters among the floats.
    law : Component
        The law.
    function : callable
        The function.
    form : str
        The form of its arguments (:data:`nonsmooth.engine.native.forms.FORMS`).
    """

    address: Any
    parameters: Any
    law: Component
    function: Callable[..., Any]
    form: str


def law_functions(
    friction: TangentialLaw, impact: ImpactLaw | None = None, normal: NormalLaw | None = None
) -> Iterator[LawFunction]:
    """Yield the functions of a contact's laws that the engine calls by address.

    The function of an impact map is not among them, because it belongs to all contacts at once and not to this contact.
    """
    if isinstance(friction, TractionLaw):
        yield LawFunction(
            _CONTACT.traction_function, _CONTACT.traction_parameters, friction, friction.traction, "traction"
        )
    if isinstance(friction, FrictionLaw):
        yield LawFunction(
            _CONTACT.friction_function, _CONTACT.friction_parameters, friction, friction.coefficient, "scalar"
        )
    if isinstance(friction, StatefulFrictionLaw):
        yield LawFunction(_CONTACT.rates_function, _CONTACT.rates_parameters, friction, friction.rates, "rates")
    if isinstance(normal, CompliantNormalLaw):
        yield LawFunction(_CONTACT.normal_function, _CONTACT.normal_parameters, normal, normal.force, "compliance")
    if isinstance(impact, ImpactProcess):
        yield LawFunction(
            _CONTACT.impact_force_function, _CONTACT.impact_force_parameters, impact, impact.force, "scalar"
        )
        yield LawFunction(
            _CONTACT.efficiency_function, _CONTACT.efficiency_parameters, impact, impact.efficiency, "scalar"
        )
