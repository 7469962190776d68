"""Contact laws by the materials of two bodies."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import final

from nonsmooth.certificates import coefficient_of
from nonsmooth.checks import check_kind
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.interfaces import (
    CompliantNormalLaw,
    FrictionLaw,
    ImpactLaw,
    ImpactMap,
    ImpactProcess,
    NormalLaw,
    TangentialLaw,
    TractionLaw,
)

_ROLES: dict[str, tuple[type, str]] = {
    "normal": (NormalLaw, "a NormalLaw"),
    "friction": (TangentialLaw, "a FrictionLaw or TractionLaw"),
    "impact": (ImpactLaw, "an ImpactLaw"),
}


@final
@dataclass(frozen=True)
class ContactLaws:
    """The three laws of a contact.

    Attributes
    ----------
    normal, friction : NormalLaw, TangentialLaw
        The laws of sustained contact.
    impact : ImpactLaw, optional
        The law of impacts; None if the normal law is compliant.

    Raises
    ------
    InvalidInput
        If a law is of the wrong kind.
    """

    normal: NormalLaw
    friction: TangentialLaw
    impact: ImpactLaw | None = None

    def __post_init__(self) -> None:
        check_laws("ContactLaws", self.normal, self.friction, self.impact)


@final
@dataclass(frozen=True)
class Materials:
    """A table of contact laws by pair of materials.

    Attributes
    ----------
    pairs : mapping
        (one material, the other) -> ContactLaws, in either order; a material with itself is a pair like any other.
    default : ContactLaws, optional
        Laws of pairs that are not in the table, and of bodies without a material. Without a default these are errors.

    Raises
    ------
    InvalidInput
        If a pair is not two names, is given in both orders, or has something else than ContactLaws.
    """

    pairs: Mapping[tuple[str, str], ContactLaws] = field(default_factory=dict)
    default: ContactLaws | None = None

    def __post_init__(self) -> None:
        check_kind("Materials.pairs", self.pairs, Mapping, "Write {('steel', 'glass'): ContactLaws(...)}.")
        object.__setattr__(self, "pairs", dict(self.pairs))
        for pair, laws in self.pairs.items():
            if not (isinstance(pair, tuple) and len(pair) == 2 and all(isinstance(n, str) and n for n in pair)):
                raise InvalidInput("Materials.pairs", "must be keyed by two names", pair, "Write ('steel', 'glass').")
            if pair[0] != pair[1] and pair[::-1] in self.pairs:
                raise InvalidInput("Materials.pairs", "must hold a pair once", pair, "Keep one of the two orders.")
            _check_bundle(f"Materials.pairs[{pair[0]!r}, {pair[1]!r}]", laws)
        if self.default is not None:
            _check_bundle("Materials.default", self.default)

    @functools.cached_property
    def names(self) -> tuple[str, ...]:
        """All materials of the table, sorted."""
        return tuple(sorted({name for pair in self.pairs for name in pair}))

    def require(self, name: str) -> None:
        """Raise UnknownName unless the table has the material."""
        if name not in self.names:
            raise UnknownName("material", name, self.names)

    def laws(self, one: str | None, other: str | None) -> ContactLaws:
        """Laws of a contact between two materials; None stands for a body without a material.

        Raises
        ------
        UnknownName
            If the table does not have a material.
        InvalidInput
            If the table has no laws for the pair, and no default.
        """
        for name in (one, other):
            if name is not None:
                self.require(name)
        if one is not None and other is not None:
            found = self.pairs.get((one, other)) or self.pairs.get((other, one))
            if found is not None:
                return found
        if self.default is None:
            materials = " and ".join("no material" if name is None else repr(name) for name in (one, other))
            raise InvalidInput(
                f"Materials: the pair of {materials}",
                "must have laws",
                "neither in the table nor covered by a default",
                f"Add pairs[{one!r}, {other!r}] or a default."
                if one is not None and other is not None
                else "Give every body a material, or the table a default.",
            )
        return self.default


def check_laws(where: str, normal: NormalLaw, friction: TangentialLaw, impact: ImpactLaw | None) -> None:
    """Raise InvalidInput, naming ``where``, if a law is of the wrong kind or cannot be combined with the other laws."""
    _check_role(where, "normal", normal)
    _check_role(where, "friction", friction)
    if isinstance(normal, CompliantNormalLaw):
        if impact is not None:
            raise InvalidInput(
                where,
                f"takes no impact law beside the compliant {type(normal).__name__}",
                impact,
                "Leave `impact` out: the force over the time of the contact is the impact.",
            )
        return
    if isinstance(friction, TractionLaw):
        raise InvalidInput(
            where,
            f"needs a compliant normal law for {type(friction).__name__}",
            normal,
            "Take one, such as hertz, or a friction law with a coefficient, such as coulomb.",
        )
    _check_role(where, "impact", impact)
    if not isinstance(impact, (ImpactProcess, ImpactMap)):
        raise InvalidInput(where, "needs an ImpactProcess or ImpactMap", impact, "Subclass one of the two.")


def _check_role(where: str, role: str, law: object) -> None:
    kind, words = _ROLES[role]
    if isinstance(law, kind):
        return
    meant = [other for other, (owner, _) in _ROLES.items() if isinstance(law, owner)]
    if meant:
        remedy = f"That is a law for {meant[0]}=."
    elif isinstance(law, type):
        remedy = f"Make an object of the class: {law.__name__}(...)."
    elif isinstance(law, (int, float)):
        remedy = "A number is no law: give it to one of `nonsmooth list laws`, as its parameter."
    else:
        remedy = "See `nonsmooth list laws`."
    raise InvalidInput(f"{where}: {role}", f"needs {words}", law, remedy)


def _check_bundle(where: str, laws: ContactLaws) -> None:
    if not isinstance(laws, ContactLaws):
        raise InvalidInput(where, "must be ContactLaws", laws, "Write ContactLaws(normal, friction, impact).")


_MOST = 2
"""Largest number of compliant contacts with static friction between two bodies.

With more contacts, the distribution of static friction over them does not follow changes of their normal forces.
"""


def check_sharing(where: str, laws: ContactLaws, n: int) -> None:
    """Raise InvalidInput if more than two contacts between two bodies are compliant and have static friction.

    Static friction is rigid, so its distribution over the contacts is not unique. The distribution that is computed
    does not follow changes of the normal forces of compliant contacts. ``n`` is the number of contacts between the
    bodies, ``laws`` are their laws, and ``where`` begins the message.
    """
    if n <= _MOST or not isinstance(laws.normal, CompliantNormalLaw):
        return
    friction = laws.friction
    if isinstance(friction, FrictionLaw) and coefficient_of(friction)(0.0) > 0.0:
        raise InvalidInput(
            f"{where}: {type(friction).__name__}",
            f"can hold at most {_MOST} compliant contacts between two bodies",
            n,
            "Take bristles, which share the load by their stiffness (bristle, coulomb_contensou), or rigid contacts.",
        )
