"""Parts of a system: contacts, joints and loads, each between frames of two bodies, and guards."""

from __future__ import annotations

from dataclasses import dataclass

from nonsmooth.interfaces import (
    Body,
    FeaturePair,
    Guard,
    ImpactLaw,
    Joint,
    Load,
    NormalLaw,
    Shape,
    TangentialLaw,
)
from nonsmooth.system.materials import ContactLaws


@dataclass(frozen=True)
class Contact:
    """One potential contact of a system.

    Attributes
    ----------
    name : str
        Name of the contact, unique among the contacts of the system.
    first, second : Body
        The bodies; the normal points from the first to the second.
    frames : tuple of int
        Number of the frame of each body.
    shapes : tuple of Shape
        Shape of each body.
    kinematics : FeaturePair
        Geometry of the contact.
    extents : tuple of float
        Radius of the sphere about the frame's origin that contains each shape [m].
    levers : tuple of float
        For each shape, an upper bound of the distance between the origin of its frame and the line of a surface normal
        [m].  Its product with the angular velocity bounds the speed of the surface along its normal.
    normal, friction : NormalLaw, TangentialLaw
        The laws of sustained contact.
    impact : ImpactLaw or None
        The law of impacts; None for a compliant contact, which has none.
    """

    name: str
    first: Body
    second: Body
    frames: tuple[int, int]
    shapes: tuple[Shape, Shape]
    kinematics: FeaturePair
    extents: tuple[float, float]
    levers: tuple[float, float]
    normal: NormalLaw
    friction: TangentialLaw
    impact: ImpactLaw | None

    @classmethod
    def of_shapes(
        cls,
        bodies: tuple[Body, Body],
        shapes: tuple[Shape, Shape],
        kinematics: FeaturePair,
        laws: ContactLaws,
        *,
        frames: tuple[int, int] = (0, 0),
        name: str = "",
    ) -> Contact:
        """Return a contact of two shapes; its ``extents`` and ``levers`` [m] are the ``extent`` and ``lever`` of each.

        Parameters
        ----------
        bodies, shapes, kinematics, laws, frames
            Attributes of the contact; ``laws`` has the normal, the friction and the impact law.
        name : str, optional
            Name of the contact; if empty, :meth:`System.add_contact` makes it from the names of the bodies.
        """
        (one, two), (first, second) = bodies, shapes
        extents, levers = (first.extent, second.extent), (first.lever, second.lever)
        return cls(name, one, two, frames, shapes, kinematics, extents, levers, laws.normal, laws.friction, laws.impact)

    def __str__(self) -> str:
        """Name of this part of the system, as messages print it."""
        return f"contact {self.name!r}"

    def __repr__(self) -> str:
        """Name, features and laws of the contact."""
        laws = ", ".join(type(law).__name__ for law in (self.normal, self.friction, self.impact) if law is not None)
        return f"Contact({self.name!r}: {self.kinematics.features[0]}; {laws})"

    @property
    def size(self) -> float:
        """The smaller of the extents [m]."""
        return min(self.extents)


@dataclass(frozen=True)
class ContactDeclaration:
    """Arguments of a call of ``System.contact``.

    Attributes
    ----------
    first, second : Body
        The bodies.
    shapes : tuple
        For each body the numbers of its shapes, or None for all shapes.
    laws : ContactLaws
        Laws of the contacts.
    name : str
        Name that the user chose for the contacts; empty if their names were made from those of the bodies.
    """

    first: Body
    second: Body
    shapes: tuple[tuple[int, ...] | None, tuple[int, ...] | None]
    laws: ContactLaws
    name: str


@dataclass(frozen=True)
class Watched:
    """A guard that a user declared, with its name in the system.

    Attributes
    ----------
    name : str
        Name of the guard, unique among the guards of the system.
    chosen : bool
        True if the user chose the name; otherwise it was made from the kind of the guard.
    guard : Guard
        The guard: an event occurs when its value falls to zero.
    """

    name: str
    chosen: bool
    guard: Guard

    def __str__(self) -> str:
        """Name of this part of the system, as messages print it."""
        return f"guard {self.name!r}"


@dataclass(frozen=True)
class Tie:
    """A joint or a load between two bodies of a system.

    Attributes
    ----------
    name : str
        Name of the joint or load, unique among the joints or loads of the system.
    chosen : bool
        True if the user chose the name.
    kind : str
        "joint" or "load".
    first, second : Body
        The bodies.
    frames : tuple of int
        Number of the frame of each body.
    component : Joint or Load
        The joint or load itself.
    """

    name: str
    chosen: bool
    kind: str
    first: Body
    second: Body
    frames: tuple[int, int]
    component: Joint | Load

    def __str__(self) -> str:
        """Name of this part of the system, as messages print it."""
        return f"{self.kind} {self.name!r}"
