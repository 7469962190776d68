"""A cylinder, a cone or a disc and a capsule: the ends as spheres, and the segment between across side and rims."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.flank_edge import FlankEdge
from bodies.contacts.frustum import part_names
from bodies.contacts.frustum_edge import segment_row
from bodies.contacts.frustum_sphere import evaluate_frustum_ball
from bodies.contacts.polytope_tables import Numbers
from bodies.contacts.rim_edge import RimEdge
from bodies.shapes.capsule import Capsule
from bodies.shapes.frustum import SIDE, Frustum
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value


@final
@dataclass(frozen=True)
class FrustumCapsule(ContactKinematics):
    """An end of a capsule against a cap, a rim or the side of a cylinder, a cone or a disc; it does not see the feet.

    The others are those of the segment between its ends, across the side and the rims.  Both ends hold a capsule that
    lies on a cap; one that lies along the side, or over a rim, is held by ends and crossings.

    Attributes
    ----------
    first : tuple of float
        The first body (:func:`bodies.shapes.frustum.frustum_numbers`).
    radius : float
        Radius of the capsule [m].
    end : tuple of float
        Centre of its end in the body frame [m].
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, Capsule)

    first: Numbers
    radius: float
    end: tuple[float, float, float]

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contacts of both ends, of the segment with the side, and of the segment with the rims."""
        assert isinstance(first, Frustum)
        assert isinstance(second, Capsule)
        numbers, radius = first.frustum, second.radius
        row, size = segment_row(second), 2.0 * max(first.extent, second.extent)
        ends = (cls(numbers, radius, end) for end in second.ends)
        flanks = [FlankEdge(numbers, row, radius, (), size, "segment")] if numbers[SIDE] > 0.0 else []
        return tuple(itertools.chain(ends, flanks, RimEdge.of_rims(numbers, row, radius, (), size, "segment")))

    def parameters(self) -> dict[str, Value]:
        """Return the numbers of both."""
        x, y, z = self.end
        return {"first": self.first, "radius": self.radius, "x": x, "y": y, "z": z}

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return evaluate_frustum_ball

    @property
    def features(self) -> tuple[str, ...]:
        """From the cap against the axis to the one along it."""
        return tuple(f"{part} and end" for part in part_names(self.first))
