"""Frustum: base class of cylinders, cones and discs, with three small feet on their flat faces."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Sequence
from typing import final

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import ConvexPart, ConvexShape
from nonsmooth.interfaces.body import Vector
from nonsmooth.vectors import perpendiculars

from .placement import turned

Point = tuple[float, float, float]
LOW_RADIUS, HIGH_RADIUS, LOW, HIGH, FEET, SIDE, CENTER, AXIS, COS, SIN, SWEEP = 0, 1, 2, 3, 4, 5, 6, 11, 18, 19, 20
"""Indices in the numbers of a frustum (:func:`frustum_numbers`).

In this order: radii of the lower and the upper rim, heights of both rims, height of the feet, length of the side,
centre, axis (its components are three apart), radial and axial component of the side's normal, rounding radius.
"""
_THINNEST = 1e-5
"""Least inscribed radius of a rounded body's core, relative to the largest size of the body.

The inscribed radius is the radius of the largest ball inside of the core.  A body with a thinner core is refused
(:func:`check_rounding`).
"""


class Frustum(ConvexShape):
    """Convex solid between two circles about one axis; one radius may be 0 (cone), or the height (disc).

    Its rims and its apex are sharp, or rounded by the radius ``rounding``.  A rounded solid is the set of all points
    within this radius of a smaller frustum, the core.  All properties here belong to the core.
    """

    foot_height: float
    rounding: float

    @property
    @abstractmethod
    def frustum(self) -> tuple[float, ...]:
        """Numbers of the frustum for compiled functions (:func:`frustum_numbers`)."""

    @property
    @abstractmethod
    def feet(self) -> tuple[Point, ...]:
        """Tips of the feet on the core's flat faces in the body frame [m]."""

    @property
    @final
    def standing_rims(self) -> tuple[tuple[float, Point], ...]:
        """Radius and centre of each rim that touches planes, in the body frame [m].

        The rims are moved inwards by the height of the feet, so that a body on a face rests on its feet only.
        """
        return self._rims(self.frustum[FEET])

    @final
    def _rims(self, height: float) -> tuple[tuple[float, Point], ...]:
        """Return radius and centre of each rim, set back for feet of a height [m]; a disc has one, at its centre."""
        low, high, below, above = self.frustum[:FEET]
        (x, y, z), axis = self.frustum[CENTER : CENTER + 3], self.frustum[AXIS : AXIS + 7 : 3]
        if above == below:
            return ((low, (x, y, z)),)
        return rims_over_faces((low, high), (below, above), (x, y, z), (axis[0], axis[1], axis[2]), height)

    @property
    @final
    def set_back(self) -> float:
        """Distance by which rims are set back along the side because of feet [m]; for a disc, height of the feet."""
        return self._along_side(self.frustum[FEET])

    @final
    def _along_side(self, height: float) -> float:
        """Return the length along the side over a height along the axis [m]; for a disc, the height."""
        numbers = self.frustum
        full = numbers[HIGH] - numbers[LOW]
        return height * (numbers[SIDE] / full if full > 0.0 else 1.0)

    @property
    @final
    def parts(self) -> tuple[ConvexPart, ...]:
        """The hull of the rims, set back by ``foot_height``.

        Feet are no parts: they may stand next to those of another body, or under its side.  Without a ``foot_height``
        the part is the whole body, and the tips of its feet lie in the faces; those of a disc protrude.
        """
        numbers = self.frustum
        place, sweep = np.array(numbers[CENTER : CENTER + 3]), numbers[SWEEP]
        axes = np.array(numbers[AXIS - 2 : AXIS + 7]).reshape(3, 3)
        rings = np.array([(*((np.array(c) - place) @ axes), r) for r, c in self._rims(self.foot_height)])
        height = self.foot_height if numbers[SIDE] > 0.0 else numbers[FEET]
        return (ConvexPart(rings, ball=sweep, place=place, axes=axes, protrusion=self._along_side(height)),)

    @final
    def _rounded(self, direction: Vector) -> Vector:
        if self.rounding == 0.0:
            return np.zeros(3)
        return np.asarray(self.rounding * direction / np.linalg.norm(direction))


def check_rounding(name: str, inner: float, sizes: Sequence[float], rounding: float) -> None:
    """Raise InvalidInput if the rounding is not below ``inner``, the radius of the largest ball inside of the body."""
    most = inner - _THINNEST * max(sizes)
    if rounding > 0.0 and rounding > most:
        raise InvalidInput(
            f"{name}.rounding",
            f"must be less than the radius of the largest ball within, at most {most:g} [m]",
            rounding,
            "The sizes are those of the whole. Round all over is a Capsule or a Sphere.",
        )


def frustum_numbers(
    radii: Sequence[float],
    heights: Sequence[float],
    center: Point,
    axis: Point,
    foot_height: float,
    sweep: float = 0.0,
) -> tuple[float, ...]:
    """Return the numbers that describe a frustum to compiled functions.

    In this order (feet are small support points on each flat face):

    - radii of the lower and the upper rim [m] (2);
    - heights of both rims over the centre, along the axis [m] (2);
    - height of the feet [m];
    - length of the side from rim to rim [m];
    - centre in the body frame [m] (3);
    - rotation from the frustum's axes to the body's axes, row by row; the axis is the third column (9);
    - radial and axial component of the side's outward normal (2);
    - rounding radius [m].

    Parameters
    ----------
    radii : sequence of float
        Radii of the lower and the upper rim [m]; the upper radius is not larger.
    heights : sequence of float
        Heights of the lower and the upper rim over the centre [m].
    center, axis : tuple of float
        Centre [m] and axis, of any length, in the body frame.
    foot_height : float
        Height of the feet on flat faces [m].
    sweep : float
        Rounding radius about the core [m]; all other numbers describe the core.
    """
    (low, high), (below, above) = radii, heights
    side = math.hypot(low - high, above - below)
    normal = ((above - below) / side, (low - high) / side) if side > 0.0 else (1.0, 0.0)
    norm = math.hypot(*axis)
    unit = tuple(x / norm for x in axis)
    rows = (value for row in zip(*perpendiculars(unit), unit, strict=True) for value in row)
    return (low, high, below, above, foot_height, side, *center, *rows, *normal, sweep)


def without_feet(numbers: tuple[float, ...]) -> tuple[float, ...]:
    """Return the numbers of the frustum with feet of height 0, for contacts that ignore the feet."""
    return (*numbers[:FEET], 0.0, *numbers[FEET + 1 :])


def rims_over_faces(
    radii: Sequence[float], heights: Sequence[float], center: Point, axis: Point, foot_height: float
) -> tuple[tuple[float, Point], ...]:
    """Return radius and centre of either rim [m] for contacts with faces.

    Each rim is moved along the side towards the other one.  The way along the axis is the height of the feet, so that a
    face touches the feet on the cap before the rim.  The moved rims lie on the side: a body that lies on its side has
    the same gap as without feet.  The apex of a cone, a rim of radius 0, is not moved.
    """
    (low, high), (below, above) = radii, heights
    part = foot_height / (above - below)
    rims = (
        (low + part * (high - low), below + foot_height),
        (high + part * (low - high), above - foot_height) if high > 0.0 else (high, above),
    )
    return tuple((radius, on_axis(center, axis, height)) for radius, height in rims)


def on_axis(center: Point, axis: Point, height: float) -> Point:
    """Return the point of the axis at a height over the centre [m]."""
    x, y, z = (c + height * a for c, a in zip(center, axis, strict=True))
    return x, y, z


FEET_OF_FACE = 3
"""Number of feet of a flat face, small tips on which a body with this face down rests on a plane.

Fewer feet would not support it; the normal forces of more feet would not be unique.
"""
CIRCLE = 2.0 / 3.0
"""Radius of the circle on which the three feet of a flat face lie, relative to the radius R of the face.

With this radius, friction at the feet resists a spin about the axis by the moment 2 mu m g R / 3.  A face without feet
and with uniform pressure has the same moment.
"""
USUAL = 1e-4
"""Default height of the feet, relative to the radius of the face."""
LEAST = 1e-8
"""Least height of the feet, relative to the size of the body: ten times the default tolerance of its gaps.

On a lower foot a rim that lies flat would touch, too, and its contact has no definite point.
"""
LEAST_OF_DISC = 1e-6
"""Least height of the feet of a sharp disc, relative to its radius.

Sharp discs nearer than 1e-7 of their size count as in one plane, and touch edge to edge.
"""
HIGHEST = 0.1
"""Largest height of the feet, relative to the radius of the face: feet must not change the shape."""


def check_feet(name: str, foot_height: float, radius: float, half_length: float = math.inf) -> None:
    """Raise InvalidInput if feet are higher than a tenth of the radius, or not lower than half of the body's length."""
    if foot_height > HIGHEST * radius:
        raise InvalidInput(
            f"{name}.foot_height",
            f"must be at most a tenth of the radius, {HIGHEST * radius:g} [m]",
            foot_height,
            "Feet are to hold a flat body, not to change its shape: a ten-thousandth of the radius is usual.",
        )
    if foot_height >= half_length:
        raise InvalidInput(
            f"{name}.foot_height",
            f"must be less than half the length, {half_length:g} [m]",
            foot_height,
            "The rims are set back by it; a disc has no thickness.",
        )


def standing_height(foot_height: float, radius: float, length: float) -> float:
    """Return the height of the feet on faces with a radius [m]: the given one, but not less than the least one.

    ``length`` is half the distance of the faces, or the height of a cone [m].  The feet of a very thin body stay lower
    than a tenth of it.
    """
    least = min(LEAST * max(radius, length), 0.1 * length) if length > 0.0 else LEAST_OF_DISC * radius
    return max(foot_height, least)


def feet_on(center: Point, axis: Point, radius: float, reach: float) -> tuple[Point, ...]:
    """Return the tips of the feet of both faces [m], first of the face at the negative end of the axis.

    Parameters
    ----------
    center, axis : tuple of float
        Centre [m] and unit axis of the disc or cylinder, in the body frame.
    radius : float
        Radius of the faces [m].
    reach : float
        Distance of the tips from the centre along the axis [m].
    """
    first, length = _across(axis), CIRCLE * radius
    tips: list[Point] = []
    for along in (-reach, reach):
        for foot in range(FEET_OF_FACE):
            half = math.pi * foot / FEET_OF_FACE
            w, s = math.cos(half), math.sin(half)
            x, y, z = turned(w, s * axis[0], s * axis[1], s * axis[2], *first)
            tips.append(
                (
                    center[0] + along * axis[0] + length * x,
                    center[1] + along * axis[1] + length * y,
                    center[2] + along * axis[2] + length * z,
                )
            )
    return tuple(tips)


def _across(axis: Point) -> Point:
    """Return a unit vector perpendicular to the axis; for the third body axis it is the first one."""
    x, y, z = axis
    if abs(y) <= max(abs(x), abs(z)):
        size = math.hypot(x, z)
        return z / size, 0.0, -x / size
    size = math.hypot(y, z)
    return 0.0, -z / size, y / size
