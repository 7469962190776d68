"""Declarations of the contacts of a system: pairs of bodies or of their shapes, with the laws of their contacts."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeAlias, final

from nonsmooth.checks import check_kind, check_pair
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body, FeaturePair, ImpactLaw, ImpactProcess
from nonsmooth.system.contact import Contact, ContactDeclaration
from nonsmooth.system.contacts import ContactRow, Contacts
from nonsmooth.system.materials import ContactLaws, Materials, check_laws, check_sharing
from nonsmooth.system.members import Members
from nonsmooth.system.names import between
from nonsmooth.system.pairing import ContactGeometries, Side, select

_Facing: TypeAlias = tuple[Side, Side, Sequence[FeaturePair]]
_WITHOUT_SHAPE = -1
"""Stands in ``ContactDeclarations.paired`` for the number of a shape that was given to ``System.add_contact``.

The shapes of these contacts need not belong to their bodies, so they have no numbers.
"""


@final
@dataclass
class ContactDeclarations:
    """Contacts of a system in the order declared, and the pairs of bodies without contact.

    Attributes
    ----------
    members : Members
        The bodies.
    rows : list of ContactRow
        All contacts, by pair of shapes.
    declared : list of ContactDeclaration
        One entry for each call of ``System.contact``, and for each pair of bodies of ``System.contact_all``.
    given : list of Contact
        The contacts of ``System.add_contact``.
    paired : set
        Pairs of shapes that have contacts. A shape is given by the number of its body, and its own number among the
        shapes of this body or ``_WITHOUT_SHAPE``.
    excluded, left_out : list of pairs of Body
        Pairs of ``System.exclude``, and of ``exclude`` in ``System.contact_all``.
    """

    members: Members
    rows: list[ContactRow] = field(default_factory=list)
    declared: list[ContactDeclaration] = field(default_factory=list)
    given: list[Contact] = field(default_factory=list)
    paired: set[frozenset[tuple[int, int]]] = field(default_factory=set)
    excluded: list[tuple[Body, Body]] = field(default_factory=list)
    left_out: list[tuple[Body, Body]] = field(default_factory=list)
    _geometries: ContactGeometries = field(default_factory=ContactGeometries, init=False)
    _contacts: Contacts = field(default_factory=lambda: Contacts(()), init=False)

    @property
    def contacts(self) -> Contacts:
        """All contacts."""
        if len(self._contacts.rows) != len(self.rows):
            self._contacts = Contacts(self.rows)
        return self._contacts

    def copied(self, members: Members) -> ContactDeclarations:
        """Independent copy of these declarations for a copy of the system, whose bodies are ``members``."""
        lists = [*self.rows], [*self.declared], [*self.given]
        return ContactDeclarations(members, *lists, {*self.paired}, [*self.excluded], [*self.left_out])

    def add(
        self,
        first: Body,
        second: Body,
        laws: ContactLaws,
        shapes: tuple[Sequence[int] | None, Sequence[int] | None] = (None, None),
        name: str = "",
    ) -> Contacts:
        """Add the contacts of two bodies; arguments and errors as for ``System.contact``."""
        where = "System.contact"
        names = self._checked(where, first, second, laws.impact)
        sides = select(where, (first, second), shapes, self._geometries.shapes)
        pairs = {frozenset((self._key(one), self._key(other))) for one, other in itertools.product(*sides)}
        if pairs & self.paired:
            raise InvalidInput(
                where,
                "needs two bodies, or shapes of them, that have no contact with each other yet",
                names,
                "One call adds the contacts of all their shapes, or of those named by `shapes`.",
            )
        facing = [self._facing(one, other) for one, other in itertools.product(*sides)]
        wanted = [(between(*self.members.names(where, one.body, two.body)), len(all_)) for one, two, all_ in facing]
        check_sharing(where, laws, sum(count for _, count in wanted))
        given = self.members.naming.give("contact", name, wanted)
        added = [self._row(*named, laws) for named in zip(given, facing, strict=True)]
        self.rows += added
        chosen = tuple(None if numbers is None else tuple(numbers) for numbers in shapes)
        self.declared.append(ContactDeclaration(first, second, (chosen[0], chosen[1]), laws, name))
        self.paired |= pairs
        return Contacts(added)

    def add_given(self, contact: Contact) -> Contact:
        """Add a contact with given kinematics; errors as for ``System.add_contact``."""
        where = "System.add_contact"
        check_kind(where, contact, Contact, "Make it by nonsmooth.system.contact.Contact.of_shapes(...).")
        kinematics, first, second = contact.kinematics, contact.first, contact.second
        check_kind(f"{where}: kinematics", kinematics, FeaturePair, "Take one of `between(first, second)`.")
        check_laws(where, contact.normal, contact.friction, contact.impact)
        names = self._checked(where, first, second, contact.impact)
        self.members.check_frames(where, first, second, contact.frames)
        added = replace(contact, name=self.members.naming.give_one("contact", contact.name, between(*names)))
        self.rows.append(ContactRow.of(added))
        self.given.append(added)
        self.paired.add(frozenset((self.members.number(where, body), _WITHOUT_SHAPE) for body in (first, second)))
        return added

    def add_all(
        self,
        laws: ContactLaws | Materials,
        of: Mapping[str, Sequence[Body]] | None,
        bodies: Sequence[Body] | None,
        exclude: Iterable[tuple[Body, Body]],
        joined: Iterable[tuple[Body, Body]],
    ) -> Contacts:
        """Add contacts between all bodies, as ``System.contact_all``, but none for the pairs ``joined`` by a joint."""
        where, members = "System.contact_all", self.members
        materials = Materials(default=laws) if isinstance(laws, ContactLaws) else laws
        remedy = "Write nonsmooth.ContactLaws(normal, friction, impact), or nonsmooth.Materials({...})."
        check_kind(f"{where}: laws", materials, Materials, remedy)
        check_kind(f"{where}: of", of or {}, Mapping, 'Write {"steel": [ball]}.')
        check_kind(f"{where}: bodies", () if bodies is None else bodies, Collection, "Write [ball, plate].")
        chosen = [body for body in members.bodies if any(body.frames)] if bodies is None else list(bodies)
        names = self._material_names(materials, of or {})
        check_kind(f"{where}: exclude", exclude, Iterable, "Write [(one, other)].")
        apart = list(exclude)
        for pair in apart:
            check_pair(f"{where}: exclude", pair)
        out = {members.pair(f"{where}: exclude", *pair) for pair in (*joined, *self.excluded, *apart)}
        out |= {frozenset(body for body, _ in pair) for pair in self.paired}
        for body in chosen:
            members.number(f"{where}: bodies", body)
        n_before = len(self.rows)
        for one, other in itertools.combinations(chosen, 2):
            if members.pair(where, one, other) not in out and one.n_u + other.n_u > 0:
                self.add(one, other, materials.laws(names.get(id(one)), names.get(id(other))))
        self.left_out += apart
        return Contacts(self.rows[n_before:])

    def _checked(self, where: str, first: Body, second: Body, impact: ImpactLaw | None) -> tuple[str, str]:
        """Names of two bodies, after a check that they may have a contact with this impact law.

        Raises
        ------
        InvalidInput
            If a body is not of the system, both are the same, or another contact has an impact law of another kind.
        """
        names = self.members.names(where, first, second)
        present = next((row.laws.impact for row in self.rows if row.laws.impact is not None), impact)
        if impact is not None and present is not None and not _is_same_kind(impact, present):
            raise InvalidInput(
                where,
                f"needs an impact law of the kind of {type(present).__name__}",
                type(impact).__name__,
                "An impact owns the whole colliding set: give all contacts laws of one kind.",
            )
        return names

    def _material_names(self, materials: Materials, of: Mapping[str, Sequence[Body]]) -> dict[int, str]:
        """Name of the material of each body, by the identity of the body."""
        names: dict[int, str] = {}
        for name, made in of.items():
            materials.require(name)
            for body in made:
                called = self.members.name(f"System.contact_all: of[{name!r}]", body)
                if names.setdefault(id(body), name) != name:
                    raise InvalidInput(
                        "System.contact_all: of",
                        "must name one material for a body",
                        f"{called} of {names[id(body)]!r} and {name!r}",
                        "Take it out of one of the two.",
                    )
        return names

    def _facing(self, first: Side, second: Side) -> _Facing:
        geometries, in_order = self._geometries.between(first.shape, second.shape)
        one, two = (first, second) if in_order else (second, first)
        return one, two, geometries

    def _row(self, name: tuple[str, int], facing: _Facing, laws: ContactLaws) -> ContactRow:
        one, two, geometries = facing
        bodies, frames, shapes = (one.body, two.body), (one.frame, two.frame), (one.shape, two.shape)
        (extent_1, lever_1), (extent_2, lever_2) = map(self._geometries.reach, shapes)
        return ContactRow(bodies, frames, shapes, geometries, laws, *name, (extent_1, extent_2), (lever_1, lever_2))

    def _key(self, side: Side) -> tuple[int, int]:
        return self.members.number("System.contact", side.body), side.number


def _is_same_kind(one: ImpactLaw, other: ImpactLaw) -> bool:
    """True if two impact laws can act in the same impact: both are impact processes, or both are of the same class."""
    if isinstance(one, ImpactProcess):
        return isinstance(other, ImpactProcess)
    return type(one) is type(other)
