"""System: what the user wrote, in objects, completely validated."""

from __future__ import annotations

import copy
import itertools
import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np

from nonsmooth.checks import check_kind, check_pair
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import (
    Body,
    ContactKinematics,
    Guard,
    ImpactLaw,
    ImpactProcess,
    Joint,
    Load,
    NormalLaw,
    TangentialLaw,
)
from nonsmooth.interfaces.body import Vector
from nonsmooth.system.contact import Contact, ContactDeclaration, Tie, Watched
from nonsmooth.system.input_checks import check_bodies, gravity_of, start_of, stranger
from nonsmooth.system.materials import ContactLaws, Materials, check_laws, check_sharing
from nonsmooth.system.names import Names, Naming, between, kind_word
from nonsmooth.system.pairing import ContactGeometries
from nonsmooth.system.selection import Side, select

_Pair: TypeAlias = frozenset[int]
_ShapePair: TypeAlias = frozenset[tuple[int, int]]
_Facing: TypeAlias = tuple[Side, Side, ContactKinematics]


class System:
    """Bodies, contacts with their laws, and where everything starts.

    Parameters
    ----------
    bodies : sequence of Body
        The bodies; each object once.
    gravity : float or sequence of float
        Gravity [m/s^2]: a number counts along -z, a vector of shape [3] has any direction.

    Raises
    ------
    InvalidInput
        If there is no body, one is listed twice or is not a Body, or gravity is not finite or a number below 0.
    """

    def __init__(self, bodies: Sequence[Body], gravity: float | Sequence[float] = 9.81) -> None:
        check_bodies(bodies)
        self._bodies = tuple(bodies)
        self._gravity = gravity_of(gravity)
        self._contacts: list[Contact] = []
        self._declared: list[ContactDeclaration] = []
        self._given: list[Contact] = []
        self._paired: set[_ShapePair] = set()
        self._excluded: list[tuple[Body, Body]] = []
        self._left_out: list[tuple[Body, Body]] = []
        self._joints: list[Tie] = []
        self._loads: list[Tie] = []
        self._watched: list[Watched] = []
        self._naming = Naming(self._bodies)
        self._starts: list[tuple[Vector, Vector]] = [body.state() for body in bodies]
        self._count_bodies()

    def _count_bodies(self) -> None:
        # bodies are told apart as objects, however equal they are: copies have identities of their own
        self._numbers = {id(body): number for number, body in enumerate(self._bodies)}
        self._geometries = ContactGeometries()

    def __repr__(self) -> str:
        """Return how many there are of its parts."""
        counts = {"bodies": self._bodies, "contacts": self._contacts, "joints": self._joints, "loads": self._loads}
        return f"System({', '.join(f'{name} {len(parts)}' for name, parts in counts.items() if parts)})"

    def __getstate__(self) -> dict[str, Any]:
        """Return what a copy starts from: lists of its own, that it may be changed apart from this system."""
        kept = {name: value for name, value in vars(self).items() if name not in ("_numbers", "_geometries")}
        own = (list, set, Naming)
        return {name: copy.copy(value) if isinstance(value, own) else value for name, value in kept.items()}

    def __setstate__(self, state: Mapping[str, Any]) -> None:
        vars(self).update(state)
        self._count_bodies()

    @property
    def bodies(self) -> tuple[Body, ...]:
        """The bodies, in the order given."""
        return self._bodies

    def name(self, body: Body, name: str) -> None:
        """Choose the name of a body: words with single blanks, before anything is declared between bodies.

        Those without are called after their kind, with numbers from 1 where they are several: "ball 2".

        Raises
        ------
        InvalidInput
            If the body is not of this system, the name has another form or is taken, or it comes too late.
        """
        self._require(body, "System.name")
        self._naming.choose("System.name", self._numbers[id(body)], name)

    @property
    def names(self) -> Names:
        """The names of all bodies, contacts, joints, loads and guards, in their orders."""
        declared = self._contacts, self._joints, self._loads, self._watched
        return Names(self._naming.bodies, *(tuple(one.name for one in parts) for parts in declared))

    def name_of(self, body: Body) -> str:
        """Return the name of a body; InvalidInput if it is not of this system."""
        self._require(body, "System.name_of")
        return self._naming.bodies[self._numbers[id(body)]]

    @property
    def gravity(self) -> tuple[float, float, float]:
        """Gravity vector [m/s^2]."""
        return self._gravity

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """The potential contacts, in the order declared."""
        return tuple(self._contacts)

    @property
    def declarations(self) -> tuple[ContactDeclaration, ...]:
        """What was said of contacts, one entry for every two bodies or choice of their shapes, in that order."""
        return tuple(self._declared)

    @property
    def given_contacts(self) -> tuple[Contact, ...]:
        """The contacts of :meth:`add_contact`, in the order added."""
        return tuple(self._given)

    @property
    def excluded(self) -> tuple[tuple[Body, Body], ...]:
        """The pairs of bodies that were said not to touch, and those that :meth:`contact_all` was to leave out."""
        return (*self._excluded, *self._left_out)

    @property
    def guards(self) -> tuple[Guard, ...]:
        """The guards of the scenario's own, in the order declared."""
        return tuple(one.guard for one in self._watched)

    @property
    def watched(self) -> tuple[Watched, ...]:
        """The guards with their names, in the order declared."""
        return tuple(self._watched)

    def about(self, body: Body) -> System:
        """Return the same system with no contacts but those of a body, in the order declared."""
        made = copy.copy(self)
        made._contacts = [contact for contact in self._contacts if contact.first is body or contact.second is body]
        return made

    def without_contacts(self) -> System:
        """Return the same system with no contacts, of which others may then be declared."""
        made = copy.copy(self)
        made._contacts, made._declared, made._given, made._paired = [], [], [], set()
        made._naming.forget("contact")
        return made

    def guard(self, guard: Guard, *, name: str = "") -> None:
        """Watch a condition of the scenario's own; its events carry its number, in the order declared.

        Raises
        ------
        InvalidInput
            If it is not a Guard, or the name is taken.
        """
        if not isinstance(guard, Guard):
            raise InvalidInput("System.guard", "needs a Guard", guard, "Subclass nonsmooth.interfaces.Guard.")
        (given,) = self._naming.give("guard", name, [kind_word(guard)])
        self._watched.append(Watched(given, bool(name), guard))

    @property
    def joints(self) -> tuple[Tie, ...]:
        """The joints, in the order declared."""
        return tuple(self._joints)

    @property
    def loads(self) -> tuple[Tie, ...]:
        """The loads, in the order declared."""
        return tuple(self._loads)

    def joint(
        self, joint: Joint, first: Body, second: Body, *, frames: tuple[int, int] = (0, 0), name: str = ""
    ) -> None:
        """Tie two bodies by a joint; ``frames`` says which frame of either.

        Raises
        ------
        InvalidInput
            If it is not a Joint, a body is not of this system, they are the same or both driven, a frame is unknown or
            the name taken.
        """
        if not isinstance(joint, Joint):
            raise InvalidInput("System.joint", "needs a Joint", joint, "See `nonsmooth list joints`.")
        self._check_tie("System.joint", first, second, frames)
        if first.n_u == 0 and second.n_u == 0:
            raise InvalidInput("System.joint", "needs a body that can move", "both are driven", "Take the joint out.")
        self._joints.append(self._tie("joint", joint, first, second, frames, name))

    def load(self, load: Load, first: Body, second: Body, *, frames: tuple[int, int] = (0, 0), name: str = "") -> None:
        """Let a load act on the second body, and its opposite on the first; ``frames`` says which frame of either.

        Raises
        ------
        InvalidInput
            If it is not a Load, a body is not of this system, they are the same, a frame is unknown or the name taken.
        """
        if not isinstance(load, Load):
            raise InvalidInput("System.load", "needs a Load", load, "See `nonsmooth list loads`.")
        self._check_tie("System.load", first, second, frames)
        self._loads.append(self._tie("load", load, first, second, frames, name))

    def _check_tie(self, where: str, first: Body, second: Body, frames: tuple[int, int]) -> None:
        self._require(first, where)
        self._require(second, where)
        check_pair(f"{where}: frames", frames)
        if first is second:
            raise InvalidInput(where, "needs two different bodies", self.name_of(first), "Name the other body.")
        for body, frame in zip((first, second), frames, strict=True):
            if frame not in range(len(body.frames)):
                raise InvalidInput(
                    f"{where}: frames",
                    f"must be below {len(body.frames)} for {self.name_of(body)}",
                    frame,
                    "Count from 0.",
                )

    def _tie(
        self, kind: str, component: Joint | Load, first: Body, second: Body, frames: tuple[int, int], name: str
    ) -> Tie:
        made = between(self.name_of(first), self.name_of(second), kind_word(component))
        (given,) = self._naming.give(kind, name, [made])
        return Tie(given, bool(name), kind, first, second, frames, component)

    def start(self, body: Body) -> tuple[Vector, Vector]:
        """Return q and u of a body at t = 0; InvalidInput if it is not of this system."""
        self._require(body, "System.start")
        return self._starts[self._numbers[id(body)]]

    def starts(self) -> tuple[Vector, Vector]:
        """Return q and u of all bodies at t = 0, in the order of the bodies."""
        return np.concatenate([q for q, _ in self._starts]), np.concatenate([u for _, u in self._starts])

    def place(self, body: Body, **start: Any) -> None:
        """Say where a body starts; the words are those of its ``state``."""
        self._require(body, "System.place")
        self._starts[self._numbers[id(body)]] = body.state(**start)

    def set_start(self, body: Body, q: Vector, u: Vector) -> None:
        """Say where a body starts by its coordinates and velocities, shapes [n_q] and [n_u].

        Raises
        ------
        InvalidInput
            If the body is not of this system, or a shape is wrong, or a number is not finite, or a quaternion is not
            unit.
        """
        self._require(body, "System.set_start")
        self._starts[self._numbers[id(body)]] = start_of(body, self.name_of(body), q, u)

    def contact(
        self,
        first: Body,
        second: Body,
        *,
        normal: NormalLaw,
        friction: TangentialLaw,
        impact: ImpactLaw | None = None,
        shapes: tuple[Sequence[int] | None, Sequence[int] | None] = (None, None),
        name: str = "",
    ) -> tuple[Contact, ...]:
        """Let two bodies touch: one contact per pair of their shapes, all with the same laws.

        Parameters
        ----------
        first, second : Body
            The bodies.
        normal, friction : NormalLaw, TangentialLaw
            The laws of sustained contact.
        impact : ImpactLaw, optional
            The law of impacts; a compliant normal law does without one, a rigid one needs it.
        shapes : tuple of two sequences of int, optional
            Which shapes of either body may touch, None for all.  The shapes of a body are numbered from 0 through all
            of its frames, in the order of ``Body.frames``.  Shapes of the same two bodies may so get laws of their own
            by further calls.
        name : str, optional
            What the contacts are called, with numbers from 1 if they are several; by default after the bodies.

        Returns
        -------
        tuple of Contact
            The contacts added.

        Raises
        ------
        InvalidInput
            If a body is not of this system, a law is missing or of the wrong kind, no kinematics is known
            for a pair of shapes, a body carries none or not the one named, two shapes have their contacts already,
            the impact law is of another kind than that of the other contacts, or the name is taken.
        """
        check_laws("System.contact", normal, friction, impact)
        return self._let_touch(first, second, ContactLaws(normal, friction, impact), shapes, name)

    def _let_touch(
        self,
        first: Body,
        second: Body,
        laws: ContactLaws,
        shapes: tuple[Sequence[int] | None, Sequence[int] | None] = (None, None),
        name: str = "",
    ) -> tuple[Contact, ...]:
        self._check_touch("System.contact", first, second, laws.impact)
        sides = select("System.contact", (first, second), shapes, self._geometries.shapes)
        pairs = {frozenset((self._key(one), self._key(other))) for one, other in itertools.product(*sides)}
        if pairs & self._paired:
            raise InvalidInput(
                "System.contact",
                "needs two bodies, or shapes of them, that have no contact with each other yet",
                (self.name_of(first), self.name_of(second)),
                "One call adds the contacts of all their shapes, or of those named by `shapes`.",
            )
        facing = [found for one, other in itertools.product(*sides) for found in self._facing(one, other)]
        made = [between(self.name_of(one.body), self.name_of(two.body)) for one, two, _ in facing]
        check_sharing("System.contact", laws, len(facing))
        names = self._naming.give("contact", name, made)
        added = [_contact(*named, laws) for named in zip(names, facing, strict=True)]
        self._contacts += added
        chosen = tuple(None if numbers is None else tuple(numbers) for numbers in shapes)
        self._declared.append(ContactDeclaration(first, second, (chosen[0], chosen[1]), laws, name))
        self._paired |= pairs
        return tuple(added)

    def _check_touch(self, where: str, first: Body, second: Body, impact: ImpactLaw | None) -> None:
        """Raise InvalidInput unless two bodies may touch with an impact law."""
        self._require(first, where)
        self._require(second, where)
        present = next((contact.impact for contact in self._contacts if contact.impact is not None), impact)
        if impact is not None and present is not None and not _same_kind(impact, present):
            raise InvalidInput(
                where,
                f"needs an impact law of the kind of {type(present).__name__}",
                type(impact).__name__,
                "An impact owns the whole colliding set: give all contacts laws of one kind.",
            )
        if first is second:
            raise InvalidInput(where, "needs two different bodies", self.name_of(first), "Name the other body.")

    def add_contact(self, contact: Contact) -> Contact:
        """Add a contact with given kinematics.

        :meth:`contact` finds the kinematics of two shapes among those that are installed. This method takes any, such
        as kinematics that are being written, of shapes that no body has to carry. A scenario file cannot hold such a
        contact.

        Parameters
        ----------
        contact : Contact
            The contact (:meth:`nonsmooth.system.contact.Contact.of_shapes`).

        Returns
        -------
        Contact
            The contact with its name, which is made from those of the bodies if it has none.

        Raises
        ------
        InvalidInput
            If it is not a Contact, a body is not of this system, the bodies are the same, a frame is unknown, the
            kinematics are no ContactKinematics, a law is of the wrong kind or does not go with the others, or the name
            is taken.
        """
        where = "System.add_contact"
        check_kind(where, contact, Contact, "Make it by nonsmooth.system.contact.Contact.of_shapes(...).")
        kinematics = contact.kinematics
        check_kind(f"{where}: kinematics", kinematics, ContactKinematics, "See `nonsmooth list kinematics`.")
        check_laws(where, contact.normal, contact.friction, contact.impact)
        self._check_touch(where, contact.first, contact.second, contact.impact)
        self._check_tie(where, contact.first, contact.second, contact.frames)
        made = between(self.name_of(contact.first), self.name_of(contact.second))
        (name,) = self._naming.give("contact", contact.name, [made])
        added = replace(contact, name=name)
        self._contacts.append(added)
        self._given.append(added)
        # the two bodies have said how they touch, though no shape of theirs need have
        self._paired.add(frozenset((self._numbers[id(body)], -1) for body in (contact.first, contact.second)))
        return added

    def contact_all(
        self,
        laws: ContactLaws | Materials,
        of: Mapping[str, Sequence[Body]] | None = None,
        *,
        bodies: Sequence[Body] | None = None,
        exclude: Iterable[tuple[Body, Body]] = (),
    ) -> tuple[Contact, ...]:
        """Let all bodies touch each other, with the same laws, or with those that belong to the materials of every two.

        Left out are pairs of driven bodies, pairs tied by a joint so far (a joint usually makes its bodies overlap)
        and the pairs of ``exclude``.  Pairs that have contacts already, be it of some of their shapes, keep them and
        get no more: declare a pair with laws of its own, or one tied by a joint, by :meth:`contact` first.

        Parameters
        ----------
        laws : ContactLaws or Materials
            The laws of all pairs, or laws by pair of materials.
        of : mapping, optional
            Material -> bodies made of it.  Bodies are told apart as objects, however equal they are.
        bodies : sequence of Body, optional
            Which bodies touch each other; by default all of the system that carry shapes.
        exclude : iterable of pairs of Body
            Pairs that do not touch, beside those of :meth:`exclude`.

        Returns
        -------
        tuple of Contact
            The contacts added; none if anything is wrong.

        Raises
        ------
        InvalidInput
            If a body is not of this system or has two materials, a pair has no laws, or :meth:`contact` refuses one.
        UnknownName
            If a material is not in the table.
        """
        materials = Materials(default=laws) if isinstance(laws, ContactLaws) else laws
        remedy = "Write nonsmooth.ContactLaws(normal, friction, impact), or nonsmooth.Materials({...})."
        check_kind("System.contact_all: laws", materials, Materials, remedy)
        check_kind("System.contact_all: of", of or {}, Mapping, 'Write {"steel": [ball]}.')
        check_kind("System.contact_all: bodies", () if bodies is None else bodies, Collection, "Write [ball, plate].")
        chosen = [body for body in self._bodies if any(body.frames)] if bodies is None else list(bodies)
        names = self._material_names(materials, of or {})
        out = {self._pair_of(tie.first, tie.second) for tie in self._joints}
        out |= {frozenset(body for body, _ in pair) for pair in self._paired}
        check_kind("System.contact_all: exclude", exclude, Iterable, "Write [(one, other)].")
        apart = list(exclude)
        for pair in apart:
            check_pair("System.contact_all: exclude", pair)
        for one, other in apart:
            self._require(one, "System.contact_all: exclude")
            self._require(other, "System.contact_all: exclude")
        out |= {self._pair_of(one, other) for one, other in (*self._excluded, *apart)}
        for body in chosen:
            self._require(body, "System.contact_all: bodies")
        kept, added = self.__getstate__(), len(self._contacts)
        try:
            for one, other in itertools.combinations(chosen, 2):
                if self._pair_of(one, other) not in out and one.n_u + other.n_u > 0:
                    self._let_touch(one, other, materials.laws(names.get(id(one)), names.get(id(other))))
        except InvalidInput:
            vars(self).update(kept)
            raise
        self._left_out += apart
        return tuple(self._contacts[added:])

    def exclude(self, first: Body, second: Body) -> None:
        """Say that two bodies do not touch: :meth:`contact_all` will leave them out, and nothing warns of an overlap.

        Raises
        ------
        InvalidInput
            If a body is not of this system, or they are the same.
        """
        self._require(first, "System.exclude")
        self._require(second, "System.exclude")
        if first is second:
            raise InvalidInput(
                "System.exclude", "needs two different bodies", self.name_of(first), "Name the other body."
            )
        self._excluded.append((first, second))

    def _material_names(self, materials: Materials, of: Mapping[str, Sequence[Body]]) -> dict[int, str]:
        names: dict[int, str] = {}
        for name, made in of.items():
            materials.require(name)
            for body in made:
                self._require(body, f"System.contact_all: of[{name!r}]")
                if names.setdefault(id(body), name) != name:
                    raise InvalidInput(
                        "System.contact_all: of",
                        "must name one material for a body",
                        f"{self.name_of(body)} of {names[id(body)]!r} and {name!r}",
                        "Take it out of one of the two.",
                    )
        return names

    def _facing(self, first: Side, second: Side) -> list[_Facing]:
        geometries, in_order = self._geometries.between(first.shape, second.shape)
        one, two = (first, second) if in_order else (second, first)
        return [(one, two, geometry) for geometry in geometries]

    def _require(self, body: Body, where: str) -> None:
        if id(body) not in self._numbers:
            raise stranger(where, body)

    def _pair_of(self, one: Body, other: Body) -> _Pair:
        return frozenset((self._numbers[id(one)], self._numbers[id(other)]))

    def _key(self, side: Side) -> tuple[int, int]:
        return self._numbers[id(side.body)], side.number

    @property
    def time_scale(self) -> float:
        """Shortest time over which prescribed motion changes [s]."""
        return min((body.time_scale for body in self._bodies), default=math.inf)

    @property
    def n_degrees(self) -> int:
        """Number of velocities of all bodies."""
        return int(np.sum([body.n_u for body in self._bodies]))


def _contact(name: str, facing: _Facing, laws: ContactLaws) -> Contact:
    one, two, geometry = facing
    bodies, frames, shapes = (one.body, two.body), (one.frame, two.frame), (one.shape, two.shape)
    return Contact.of_shapes(bodies, shapes, geometry, laws, frames=frames, name=name)


def _same_kind(one: ImpactLaw, other: ImpactLaw) -> bool:
    if isinstance(one, ImpactProcess):
        return isinstance(other, ImpactProcess)
    return type(one) is type(other)
