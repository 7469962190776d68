"""System: bodies, contacts, joints, loads and guards that the user declared, all of them checked."""

from __future__ import annotations

import copy
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import (
    Body,
    Guard,
    ImpactLaw,
    Joint,
    Load,
    NormalLaw,
    TangentialLaw,
)
from nonsmooth.interfaces.body import Vector
from nonsmooth.readable import Readable
from nonsmooth.system.contact import Contact, ContactDeclaration, Tie, Watched
from nonsmooth.system.contacts import Contacts
from nonsmooth.system.declarations import ContactDeclarations
from nonsmooth.system.input_checks import check_bodies, gravity_of, start_of
from nonsmooth.system.materials import ContactLaws, Materials, check_laws
from nonsmooth.system.members import Members
from nonsmooth.system.names import Names, between, kind_word


class System(metaclass=Readable):
    """A mechanical system: bodies, contacts with laws, joints, loads, guards and starts.

    Parameters
    ----------
    bodies : sequence of Body
        The bodies; each object once.
    gravity : float or sequence of float
        Gravity [m/s^2]: a number g acts along -z, a vector of shape [3] acts in its own direction.

    Raises
    ------
    InvalidInput
        If no body is given, a body is listed twice, or an object is not a Body.  Also if gravity is not finite, is
        larger than 1e4 m/s^2, or is given as a negative number.
    """

    def __init__(self, bodies: Sequence[Body], gravity: float | Sequence[float] = 9.81) -> None:
        check_bodies(bodies)
        self._members = Members(bodies)
        self._gravity = gravity_of(gravity)
        self._declared = ContactDeclarations(self._members)
        self._joints: list[Tie] = []
        self._loads: list[Tie] = []
        self._watched: list[Watched] = []
        self._starts: list[tuple[Vector, Vector]] = [body.state() for body in bodies]

    def __repr__(self) -> str:
        """Numbers of bodies, contacts, joints and loads."""
        counts = {"bodies": self.bodies, "contacts": self.contacts, "joints": self._joints, "loads": self._loads}
        return f"System({', '.join(f'{name} {len(parts)}' for name, parts in counts.items() if parts)})"

    def __getstate__(self) -> dict[str, Any]:
        """State for a copy, with copies of the lists, so that a change of the copy does not change this system."""
        members = copy.copy(self._members)
        lists = {name: [*value] for name, value in vars(self).items() if isinstance(value, list)}
        return {**vars(self), **lists, "_members": members, "_declared": self._declared.copied(members)}

    @property
    def bodies(self) -> tuple[Body, ...]:
        """The bodies, in the order given."""
        return self._members.bodies

    def name(self, body: Body, name: str) -> None:
        """Choose the name of a body, words with single blanks, before contacts, joints, loads or guards are declared.

        A body without a chosen name is named after its kind, with a number from 1 if there are several: "ball 2".

        Raises
        ------
        InvalidInput
            If the body is not of this system, the name is malformed or taken, or a contact, joint, load or guard is
            declared already.
        """
        self._members.naming.choose("System.name", self._members.number("System.name", body), name)

    @property
    def names(self) -> Names:
        """The names of all bodies, contacts, joints, loads and guards, in the order declared."""
        others = (tuple(one.name for one in parts) for parts in (self._joints, self._loads, self._watched))
        labels = tuple((row.label, row.first_number, len(row)) for row in self.contacts.rows)
        return Names(self._members.naming.bodies, labels, *others)

    def name_of(self, body: Body) -> str:
        """Name of a body; InvalidInput if it is not of this system."""
        return self._members.name("System.name_of", body)

    @property
    def gravity(self) -> tuple[float, float, float]:
        """Gravity vector [m/s^2]."""
        return self._gravity

    @property
    def contacts(self) -> Contacts:
        """The potential contacts, in the order declared."""
        return self._declared.contacts

    @property
    def declarations(self) -> tuple[ContactDeclaration, ...]:
        """Declarations of contacts, in order: one for each call of `contact`, and for each pair of `contact_all`."""
        return tuple(self._declared.declared)

    @property
    def given_contacts(self) -> tuple[Contact, ...]:
        """The contacts of :meth:`add_contact`, in the order added."""
        return tuple(self._declared.given)

    @property
    def excluded(self) -> tuple[tuple[Body, Body], ...]:
        """The pairs of bodies that :meth:`exclude`, or ``exclude`` of :meth:`contact_all`, has excluded."""
        return (*self._declared.excluded, *self._declared.left_out)

    @property
    def guards(self) -> tuple[Guard, ...]:
        """The guards that the user added, in the order declared."""
        return tuple(one.guard for one in self._watched)

    @property
    def watched(self) -> tuple[Watched, ...]:
        """The guards with their names, in the order declared."""
        return tuple(self._watched)

    def about(self, body: Body) -> System:
        """Copy of the system with all bodies, but only the contacts of ``body``, in the order declared.

        It is used to place the body, where only the gaps of its own contacts are needed.
        """
        made = copy.copy(self)
        made._declared.rows = [row for row in self._declared.rows if any(one is body for one in row.bodies)]
        return made

    def without_contacts(self) -> System:
        """Copy of the system without contacts, so that other contacts can be declared."""
        made = copy.copy(self)
        excluded, left_out = made._declared.excluded, made._declared.left_out
        made._declared = ContactDeclarations(made._members, excluded=excluded, left_out=left_out)
        made._members.naming.forget("contact")
        return made

    def guard(self, guard: Guard, *, name: str = "") -> None:
        """Add a guard, a condition of the user that causes events. Its events carry its number, in the order declared.

        Raises
        ------
        InvalidInput
            If the object is not a Guard, or the name is taken.
        """
        if not isinstance(guard, Guard):
            raise InvalidInput("System.guard", "needs a Guard", guard, "Subclass nonsmooth.interfaces.Guard.")
        given = self._members.naming.give_one("guard", name, kind_word(guard))
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
        """Tie two bodies by a joint; ``frames`` are the numbers of the tied frames of the first and the second body.

        Raises
        ------
        InvalidInput
            If the object is not a Joint, a body is not of this system, both bodies are the same or driven, a frame is
            unknown, or the name is taken.
        """
        if not isinstance(joint, Joint):
            raise InvalidInput("System.joint", "needs a Joint", joint, "See `nonsmooth list joints`.")
        self._members.check_frames("System.joint", first, second, frames)
        if first.n_u == 0 and second.n_u == 0:
            raise InvalidInput("System.joint", "needs a body that can move", "both are driven", "Take the joint out.")
        self._joints.append(self._tie("joint", joint, first, second, frames, name))

    def load(self, load: Load, first: Body, second: Body, *, frames: tuple[int, int] = (0, 0), name: str = "") -> None:
        """Add a load: its force acts on the second body, the opposite force on the first body.

        ``frames`` has the number of the frame of the first and of the second body at which the force acts.

        Raises
        ------
        InvalidInput
            If the object is not a Load, a body is not of this system, both are the same, a frame is unknown, or the
            name is taken.
        """
        if not isinstance(load, Load):
            raise InvalidInput("System.load", "needs a Load", load, "See `nonsmooth list loads`.")
        self._members.check_frames("System.load", first, second, frames)
        self._loads.append(self._tie("load", load, first, second, frames, name))

    def _tie(
        self, kind: str, component: Joint | Load, first: Body, second: Body, frames: tuple[int, int], name: str
    ) -> Tie:
        made = between(self.name_of(first), self.name_of(second), kind_word(component))
        given = self._members.naming.give_one(kind, name, made)
        return Tie(given, bool(name), kind, first, second, frames, component)

    def start(self, body: Body) -> tuple[Vector, Vector]:
        """Coordinates q and velocities u of a body at t = 0; InvalidInput if it is not of this system."""
        return self._starts[self._members.number("System.start", body)]

    def starts(self) -> tuple[Vector, Vector]:
        """Coordinates q and velocities u of all bodies at t = 0, in the order of the bodies."""
        return np.concatenate([q for q, _ in self._starts]), np.concatenate([u for _, u in self._starts])

    def place(
        self,
        body: Body,
        *,
        position: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        angular_velocity: ArrayLike | None = None,
        **start: Any,
    ) -> None:
        """Set position and velocities of a body at t = 0.

        A keyword that is left out has its default: zero, or no rotation.  A second call replaces the first.

        Parameters
        ----------
        body : Body
            A body of the system.
        position : array_like, optional
            Position of the mass centre in world axes [m], shape [3]; a planar body has (x, z), a line body a number.
        orientation : array_like, optional
            Unit quaternion (w, x, y, z) from body axes to world axes, shape [4]; ``nonsmooth.turned_about`` makes one.
        velocity : array_like, optional
            Velocity of the mass centre in world axes [m/s], shaped as the position.
        angular_velocity : array_like, optional
            Angular velocity in body axes [rad/s], shape [3]; a planar body has a number.
        **start
            Other keywords of the body's method ``state``, such as ``angle`` of a planar body.

        Raises
        ------
        InvalidInput
            If the body is not of this system, or cannot be placed; if a keyword is not one of its method ``state``, or
            a value has a wrong shape or is not finite.
        """
        number = self._members.number("System.place", body)
        named = {
            "position": position,
            "orientation": orientation,
            "velocity": velocity,
            "angular_velocity": angular_velocity,
        }
        self._starts[number] = body.state(**{k: v for k, v in named.items() if v is not None}, **start)

    def set_start(self, body: Body, q: Vector, u: Vector) -> None:
        """Set coordinates q and velocities u of a body at t = 0, shapes [n_q] and [n_u].

        Raises
        ------
        InvalidInput
            If the body is not of this system, a shape is wrong, a number is not finite, or the length of a quaternion
            is not 1.
        """
        number = self._members.number("System.set_start", body)
        self._starts[number] = start_of(body, self.name_of(body), q, u)

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
    ) -> Contacts:
        """Declare contacts between two bodies: one for each pair of their shapes, all with the same laws.

        Parameters
        ----------
        first, second : Body
            The bodies.
        normal, friction : NormalLaw, TangentialLaw
            The laws of sustained contact.
        impact : ImpactLaw, optional
            The law of impacts.  A rigid normal law needs an impact law; a compliant normal law takes none.
        shapes : tuple of two sequences of int, optional
            Numbers of the shapes of each body that may touch, or None for all shapes.  The shapes of a body are
            numbered from 0 through all of its frames, in the order of ``Body.frames``.  Further calls can give other
            laws to other shapes of the same two bodies.
        name : str, optional
            Name of the contacts, with numbers from 1 if there are several; by default made from the bodies' names.

        Returns
        -------
        Contacts
            The contacts added, a sequence.

        Raises
        ------
        InvalidInput
            If a body is not of this system, a law is missing or of the wrong kind, no kinematics is installed for a
            pair of shapes, a body carries no shape or not the chosen one, two shapes have contacts already, other
            contacts have an impact law of another kind, or the name is taken.
        """
        check_laws("System.contact", normal, friction, impact)
        return self._declared.add(first, second, ContactLaws(normal, friction, impact), shapes, name)

    def add_contact(self, contact: Contact) -> Contact:
        """Add a contact with given kinematics.

        :meth:`contact` finds the kinematics of two shapes among the installed ones. This method takes any FeaturePair,
        such as one under development. It also takes shapes that belong to no body. A scenario file cannot hold such
        a contact.

        Parameters
        ----------
        contact : Contact
            The contact (:meth:`nonsmooth.system.contact.Contact.of_shapes`).

        Returns
        -------
        Contact
            The contact with its name; if it had none, the name is made from the names of the bodies.

        Raises
        ------
        InvalidInput
            If the object is not a Contact, a body is not of this system, the bodies are the same, a frame is unknown,
            ``contact.kinematics`` is not a FeaturePair, a law is of the wrong kind or cannot be combined with the
            others, or the name is taken.
        """
        return self._declared.add_given(contact)

    def contact_all(
        self,
        laws: ContactLaws | Materials,
        of: Mapping[str, Sequence[Body]] | None = None,
        *,
        bodies: Sequence[Body] | None = None,
        exclude: Iterable[tuple[Body, Body]] = (),
    ) -> Contacts:
        """Declare contacts between all bodies, with the same laws for all, or with laws by pair of materials.

        The method omits pairs of driven bodies, pairs that a joint ties already (a joint usually makes its bodies
        overlap), pairs of ``exclude``, and pairs with a contact, even if it concerns only some of their shapes.  For a
        pair with other laws, or tied by a joint, call :meth:`contact` before.

        Parameters
        ----------
        laws : ContactLaws or Materials
            The laws of all pairs, or laws by pair of materials.
        of : mapping, optional
            Material -> bodies made of it.  Bodies are distinguished as objects, even if their values are equal.
        bodies : sequence of Body, optional
            Bodies that may touch each other; by default all bodies of the system that carry shapes.
        exclude : iterable of pairs of Body
            Pairs that do not touch, in addition to those of :meth:`exclude`.

        Returns
        -------
        Contacts
            The contacts added, a sequence.  If an error is raised, the system is unchanged.

        Raises
        ------
        InvalidInput
            If a body is not of this system or has two materials, a pair has no laws, or :meth:`contact` rejects a pair.
        UnknownName
            If a material is not in the table.
        """
        kept = self.__getstate__()
        try:
            joined = [(tie.first, tie.second) for tie in self._joints]
            return self._declared.add_all(laws, of, bodies, exclude, joined)
        except InvalidInput:
            vars(self).update(kept)
            raise

    def exclude(self, first: Body, second: Body) -> None:
        """Exclude contacts of two bodies: :meth:`contact_all` omits the pair, and no warning names its overlap.

        Raises
        ------
        InvalidInput
            If a body is not of this system, or both are the same.
        """
        self._members.names("System.exclude", first, second)
        self._declared.excluded.append((first, second))

    @property
    def time_scale(self) -> float:
        """Shortest time over which prescribed motion changes [s]."""
        return min((body.time_scale for body in self.bodies), default=math.inf)

    @property
    def n_degrees(self) -> int:
        """Number of velocities of all bodies."""
        return int(np.sum([body.n_u for body in self.bodies]))
