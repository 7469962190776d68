"""A cylinder, a cone or a disc over a plane, in closed form."""

from __future__ import annotations

import math
from typing import ClassVar, final

from nonsmooth.engine.memory.blocks import SIDE_B
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.frustum import AXIS, FEET, Frustum, Point
from ...shapes.ground import Ground
from ...vectors import cross, opposite, plus_scaled, vector_at
from ..features.frames import across, point_in_world, vector_in_world
from ..features.writing import write_principal, write_sweep
from .plane_ball import ball_over_plane
from .plane_point import axis_of, place_over_plane


def evaluate_rim_over_plane(
    a: Floats,
    b: Floats,
    out: Floats,
    radius: float,
    center: Floats,
    axis: Floats,
    height: float,
    rounding: float,
    crown: float,
) -> None:
    """Write the geometry block of a rim over a plane, at the lowest point of the rim or of the torus about it.

    Near flat, where the feet touch, the face is a crown: a cap of a sphere that protrudes from the rim by half the
    height of the feet.  So the contact point moves from one side of the rim to the other without a jump.

    Parameters
    ----------
    a, b, out : Floats
        Frame blocks of the bodies, and the geometry block.
    radius, center, axis : float, Floats
        Radius of the rim [m], its centre [m] and unit axis in its body frame.
    height : float
        Height of the plane in its body frame [m].
    rounding : float
        Radius of the torus about a rounded rim [m].
    crown : float
        Sine of the tilt of the crown at the rim.
    """
    n, along_axis = axis_of(a, 2), vector_in_world(b, vector_at(axis, 0))
    along, sine, radial = across(opposite(n), along_axis)
    distance, protrusion, is_crown = radius, 0.0, sine < crown
    # the crown is a cap of a sphere of radius R = radius / crown: its lowest point is at R sine from the axis; it
    # protrudes by the difference of the cosines times R, here without cancellation
    if is_crown:
        distance *= sine / crown
        sum_of_cosines = math.sqrt(1.0 - crown * crown) + math.sqrt(1.0 - sine * sine)
        protrusion = math.copysign(radius / crown * (crown * crown - sine * sine) / sum_of_cosines, along)
    point = plus_scaled(point_in_world(b, vector_at(center, 0)), distance, radial)
    place_over_plane(a, out, plus_scaled(plus_scaled(point, protrusion, along_axis), -rounding, n), height)
    slide, turn = (crown, radius) if is_crown else (1.0, 0.0)
    write_principal(out, SIDE_B, cross(along_axis, radial), max(sine, crown), radius, slide, turn)
    write_sweep(out, SIDE_B, rounding)


@final
class PlaneFrustum(ContactKinematics):
    """A cylinder, a cone or a disc over a plane: contacts of the lowest point of each rim, of the apex and of the feet.

    Two rims, or a rim and the apex, hold a body that lies on its side.  A rim that lies flat has no lowest point: its
    feet hold the body, each a contact of its own.  A rounded body has a torus about every rim, and spheres about its
    apex and the tips of its feet.

    Springs press the feet into the plane, so that the face touches the plane, too.  The lowest point of its rim would
    jump from one side to the other.  So the face has a crown, half as high as the feet; rigid feet keep it off the
    plane.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Ground, Frustum)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the contacts of the rims, first the one against the axis, of the apex, and of the feet."""
        assert isinstance(first, Ground)
        assert isinstance(second, Frustum)
        sweep, numbers = second.rounding, second.frustum
        axis = numbers[AXIS], numbers[AXIS + 3], numbers[AXIS + 6]

        def rim(radius: float, center: Point) -> FeaturePair:
            """Return the contact of a rim, or of the apex, which is a rim of radius 0."""
            if radius == 0.0:
                return ball(center)
            values: dict[str, Value] = {"radius": radius, "center": center, "axis": axis, "height": first.height}
            values |= {"rounding": sweep, "crown": numbers[FEET] / radius}
            return FeaturePair(evaluate_rim_over_plane, values, ("plane-rim",))

        def ball(center: Point) -> FeaturePair:
            """Return the contact of the apex or of the tip of a foot, with the radius of the rounding."""
            return ball_over_plane(first, sweep, center, "sphere" if sweep > 0.0 else "vertex")

        return *(rim(*rim_numbers) for rim_numbers in second.standing_rims), *(ball(foot) for foot in second.feet)
