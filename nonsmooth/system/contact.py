"""Contact: kinematics, normal law, friction law, impact law, composed."""

from __future__ import annotations

from dataclasses import dataclass

from nonsmooth.interfaces import Body, ContactKinematics, FrictionLaw, ImpactLaw, NormalLaw


@dataclass(frozen=True)
class Contact:
    """One potential contact of a system.

    Attributes
    ----------
    name : str
        Number in the system and bodies, for messages.
    first, second : Body
        The bodies; the normal points from the first to the second.
    kinematics : ContactKinematics
        Geometry of the pair of shapes.
    normal, friction, impact : NormalLaw, FrictionLaw, ImpactLaw
        The laws.
    """

    name: str
    first: Body
    second: Body
    kinematics: ContactKinematics
    normal: NormalLaw
    friction: FrictionLaw
    impact: ImpactLaw
