"""Shape: a piece of a body's surface, fixed in the body frame."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod

from nonsmooth.interfaces.convex_part import ConvexPart
from nonsmooth.interfaces.look import Look
from nonsmooth.interfaces.solid import SolidRegion
from nonsmooth.parameters import Component


class Shape(Component, ABC):
    """What a contact pair sees of a body.

    A shape

    1. is a frozen dataclass of floats, in the frame of its body;
    2. knows no body and no contact: pairs of shapes are the business of ContactKinematics;
    3. may say by ``advice`` what to do where no kinematics is known for a pair with it;
    4. should give the ``solid`` that it bounds, if it has one, for pictures and checks of its support points;
    5. should give the convex ``parts`` of which it consists. Distances, placing and checks of overlap measure them. A
       shape without parts, and without the surface of a solid, has only the gaps of its contacts;
    6. may say by ``look`` how it is drawn.
    """

    def parameters(self) -> dict[str, float]:
        """Return the declared numbers by name."""
        return self.numbers()

    @property
    @abstractmethod
    def length(self) -> float:
        """Distance of the farthest point from the origin of the body frame [m]; 0 for an unbounded shape."""

    @property
    def extent(self) -> float:
        """Radius of a ball about the origin of the body frame that holds the shape [m]; infinite if unbounded."""
        return self.length

    @property
    def lever(self) -> float:
        """Largest arm with which a turn about the origin of the body frame moves the surface along its normal [m].

        It bounds how fast a gap can close; the extent always does, and a ball about the origin has none.
        """
        return self.extent

    @property
    def revolution(self) -> tuple[float, float, float]:
        """Direction in the body frame about which a turn about the origin moves no surface along its normal.

        Spin about it brings no gap nearer.  No direction, zero, by default.
        """
        return 0.0, 0.0, 0.0

    @property
    def ceiling(self) -> float:
        """Height over the origin along the third axis of the body frame, above which it has no point [m].

        It tells what is far from an unbounded shape; infinite, by default, where no such height is known.
        """
        return math.inf

    @property
    def advice(self) -> str:
        """What to do where no kinematics is known for a pair with this shape; part of the message, may be empty."""
        return ""

    @property
    def solid(self) -> SolidRegion | None:
        """What it encloses; None, if it is not bounded or not known, by default."""
        return None

    @property
    def parts(self) -> tuple[ConvexPart, ...]:
        """Convex parts within the surface that contacts see; none by default."""
        return ()

    @property
    def look(self) -> Look:
        """What is seen of it; by default the convex hull of what it encloses, or else a mark at the origin."""
        return Look.mark((0.0, 0.0, 0.0)) if self.solid is None else Look.spanned(self.solid)
