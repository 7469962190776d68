"""Contact of two bodies with smooth support functions."""

from __future__ import annotations

from typing import ClassVar, final

from nonsmooth.engine.memory.blocks import GAP, NORMAL, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.types import Floats

from ...rotations import relative_rotation, rotated, rotated_back
from ...shapes.smooth import SmoothShape
from ...shapes.support_function import OF_FUNCTION
from ...vectors import minus, opposite, plus, plus_scaled, vector_at, write_vector
from ..features.frames import point_in_world, write_tangent
from .smooth_core import CENTER, POWERS, RADIUS, Cores, unit_axes_in_world
from .smooth_newton import largest_gap, write_surface


def evaluate_smooth_smooth(a: Floats, b: Floats, out: Floats, first: Floats, second: Floats) -> None:
    """Write the geometry block of two smooth bodies, given as cores; at most one of them is a point.

    The search computes in the axes of the first core, from its centre: there q and p are the points of both cores, and
    n is the normal.  The gap is nan if no solution was found.
    """
    axes_a, axes_b = unit_axes_in_world(a, first), unit_axes_in_world(b, second)
    center_a = point_in_world(a, vector_at(first, CENTER))
    center = rotated_back(axes_a, minus(point_in_world(b, vector_at(second, CENTER)), center_a))
    turn = relative_rotation(axes_a, axes_b)
    g, q, n = largest_gap(Cores(first, second, turn, center))
    p, normal = plus_scaled(q, -g, n), rotated(axes_a, n)
    out[GAP] = g - first[RADIUS] - second[RADIUS]
    write_vector(out, NORMAL, normal)
    write_vector(out, POINT_A, plus_scaled(plus(center_a, rotated(axes_a, p)), first[RADIUS], normal))
    write_vector(out, POINT_B, plus_scaled(plus(center_a, rotated(axes_a, q)), -second[RADIUS], normal))
    write_tangent(a, out)
    write_surface(out, SIDE_A, first, axes_a, n, p)
    write_surface(out, SIDE_B, second, axes_b, rotated_back(turn, opposite(n)), rotated_back(turn, minus(q, center)))


@final
class SmoothSmooth(ContactKinematics):
    """Two smooth bodies: one contact; its normal is the one that separates them most."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (SmoothShape, SmoothShape)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the single contact of two smooth shapes.

        Raises
        ------
        InvalidInput
            One shape is given by its farthest points only, and the other has both flat and sharp places.
        """
        assert isinstance(first, SmoothShape)
        assert isinstance(second, SmoothShape)
        for shape, partner in ((first, second), (second, first)):
            if shape.mixed and partner.core[POWERS] == OF_FUNCTION:
                raise InvalidInput(
                    f"contact of {type(shape).__name__} and {type(partner).__name__}",
                    "needs exponents both up to 1, or both from 1 on",
                    # the exponent e belongs to the power 2 / (2 - e)
                    [2.0 - 2.0 / power for power in shape.core[POWERS : POWERS + 2]],
                    "Next to flat and sharp places at once the search needs the powers of both bodies.",
                )
        values = {"first": first.core, "second": second.core}
        return (FeaturePair(evaluate_smooth_smooth, values, ("smooth-smooth",)),)
