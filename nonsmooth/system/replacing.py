"""Replacement of the contact laws of a system."""

from __future__ import annotations

from nonsmooth.checks import check_kind
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import (
    CompliantNormalLaw,
    ImpactLaw,
    NormalLaw,
    TangentialLaw,
)
from nonsmooth.system.system import System


def with_laws(
    system: System,
    *,
    normal: NormalLaw | None = None,
    friction: TangentialLaw | None = None,
    impact: ImpactLaw | None = None,
) -> System:
    """System of the same bodies, starts, joints, loads and guards, with other laws in all of its contacts.

    Parameters
    ----------
    system : System
        System with the former laws; it is not changed.
    normal, friction, impact : NormalLaw, TangentialLaw, ImpactLaw, optional
        The new laws. A law that is left out is kept, except that a compliant normal law replaces the impact law.

    Raises
    ------
    InvalidInput
        If the system has no contact, a contact was given by :meth:`System.add_contact`, or a law is of the wrong kind.
    """
    check_kind("with_laws: system", system, System, "Make it by nonsmooth.System([...]).")
    if not system.declarations:
        raise InvalidInput("with_laws", "needs a system with contacts", 0, "Declare some with system.contact(...).")
    if system.given_contacts:
        raise InvalidInput(
            "with_laws",
            "needs contacts of System.contact or System.contact_all",
            str(system.given_contacts[0]),
            "Add the contacts of System.add_contact again, with the other laws.",
        )
    made = system.without_contacts()
    for declared in system.declarations:
        laws = declared.laws
        kept = None if isinstance(normal, CompliantNormalLaw) else laws.impact
        made.contact(
            declared.first,
            declared.second,
            normal=laws.normal if normal is None else normal,
            friction=laws.friction if friction is None else friction,
            impact=kept if impact is None else impact,
            shapes=declared.shapes,
            name=declared.name,
        )
    return made
