"""Shapes with a smooth support function or gauge: their numbers, mass properties and drawings."""

from __future__ import annotations

import functools
import math
from abc import abstractmethod

import numpy as np

from nonsmooth.interfaces import ConvexPart, ConvexShape
from nonsmooth.interfaces.body import Vector

from .drawing import arc, revolved
from .placement import turned
from .support_function import FUNCTION, OF_FUNCTION, support_of


class SmoothShape(ConvexShape):
    """A convex shape without corners and straight edges, given by the numbers of its support function.

    Its radii of curvature are finite; one of them may be 0, at a sharp edge that is curved.  A boxy shape has finite
    and continuous curvatures instead, which are 0 at its flat points.
    """

    @property
    @abstractmethod
    def core(self) -> tuple[float, ...]:
        """Numbers of its support function (:func:`bodies.shapes.smooth.core_numbers`)."""

    @property
    def boxy(self) -> bool:
        """True if the shape has flat points, so that no evaluator may divide by its curvatures."""
        return self.core[0] > 0.0 and self.core[3] < 2.0 and self.core[4] <= 2.0

    @property
    def mixed(self) -> bool:
        """True if the shape has both flat and sharp places: of its powers p and q, one is below and one above 2."""
        return self.core[0] > 0.0 and (self.core[3] - 2.0) * (self.core[4] - 2.0) < 0.0

    @property
    def parts(self) -> tuple[ConvexPart, ...]:
        """One convex part: all points within the radius of the core."""
        core = self.core
        a, b, c, p, q, radius = core[:6]
        place, axes = np.array(core[6:9]), np.array(core[9:18]).reshape(3, 3)
        if p == OF_FUNCTION:
            reach = self.length + float(np.linalg.norm(place))
            return (ConvexPart(ball=radius, place=place, axes=axes, function=core[FUNCTION:], reach=reach),)
        return (ConvexPart(semi=(a, b, c), powers=(p, q), ball=radius, place=place, axes=axes),)


_STEP, _LAST_NODE = 2.0**-5, 4.75
"""Spacing and largest node of the double exponential quadrature over each angle (:func:`integrals_with_radius`).

Both are values of the transformed variable, which has no unit.  With them, the relative error of the integrals is
below 1e-12 if the semi-axes differ by a factor of at most 100; with twice the spacing it is 3e-8.
"""


def core_numbers(
    semi: tuple[float, float, float],
    powers: tuple[float, float],
    radius: float,
    center: tuple[float, float, float],
    orientation: tuple[float, float, float, float],
) -> tuple[float, ...]:
    """Return the numbers that describe a smooth shape to compiled functions: a core and a radius about it.

    They are three semi-axes a, b, c [m], two powers p, q, the radius about the core [m], the centre in the body frame
    [m], and the rotation from the axes of the core to those of the body, row by row.  The core's support function is

        h(n) = ((|a n_x|^q + |b n_y|^q)^(p/q) + |c n_z|^p)^(1/p),

    with p = q = 2 for an ellipsoid; without semi-axes the core is a point.

    Parameters
    ----------
    semi : tuple of float
        a, b and c [m], all positive or all 0.
    powers : tuple of float
        p and q, above 1; below 2 the core has flat places, as boxes with round edges have.
    radius : float
        All points within this distance of the core belong to the shape [m].
    center : tuple of float
        Centre in the body frame [m].
    orientation : tuple of float
        Unit quaternion from the core's axes to the body's.
    """
    columns = [turned(*orientation, *axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))]
    return (*semi, *powers, radius, *center, *(column[row] for row in range(3) for column in columns))


def support_point(core: tuple[float, ...], direction: Vector) -> Vector:
    """Return the farthest point of a core with its radius, in the body frame [m], for a direction of any length."""
    axes = np.array(core[9:18]).reshape(3, 3)
    unit = np.asarray(direction, dtype=float) / np.linalg.norm(direction)
    point = support_of(core, tuple(axes.T @ unit))[1]
    return np.asarray(np.array(core[6:9]) + axes @ np.array(point) + core[5] * unit)


def farthest(core: tuple[float, ...]) -> float:
    """Return the distance of the farthest point from the origin of the body frame [m], or an upper bound of it."""
    return math.hypot(*core[6:9]) + extent(core)


def extent(core: tuple[float, ...]) -> float:
    """Return the distance of the farthest point from the centre of the core [m].

    For powers of 2 and more it is the largest semi-axis, because the core lies in the ellipsoid with the same
    semi-axes.  If the core is given by a function, it is an upper bound: half of the diagonal of the box round it.  For
    smaller powers, take the squares of the coordinates as new coordinates X, Y, Z.  In these, the core
    is again a body of the same kind, with other powers.  The largest squared distance X + Y + Z is a value of this
    body's support function.
    """
    return (math.hypot(*core[:3]) if core[3] == OF_FUNCTION else _corner(core)) + core[5]


def _corner(core: tuple[float, ...]) -> float:
    """Return the distance of the farthest point of a core from its centre, without the radius [m]."""

    def norm(one: float, two: float, power: float) -> float:
        # the gauge has the power p / (p - 1); in the squares of the coordinates it is half of that, and the support
        # function of the body in these squares has the power p / (2 - p)
        larger, smaller = max(one, two), min(one, two)
        if power >= 2.0:
            return larger
        dual = power / (2.0 - power)
        return float(larger * (1.0 + (smaller / larger) ** dual) ** (1.0 / dual))

    a, b, c = (axis * axis for axis in core[:3])
    return math.sqrt(norm(norm(a, b, core[4]), c, core[3]))


def drawn(core: tuple[float, ...], fineness: int) -> tuple[Vector, Vector]:
    """Return vertices [m], shape [n, 3], and triangles, shape [m, 3], of a closed mesh.

    The vertices lie on meridians and parallels, which are given by the two usual angles of a superellipsoid.  The
    normal, before its scaling to length 1, is the product of such powers as sin^(2/q), divided by the semi-axis.  The
    point on the core is the product of such powers as sin^(2 - 2/q), times the semi-axis.
    """
    sphere, triangles = revolved(arc(fineness, math.pi, 0.0), fineness, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    axes, semi, (p, q) = np.array(core[9:18]).reshape(3, 3), np.array(core[:3]), core[3:5]
    across = np.hypot(sphere[:, 0], sphere[:, 1])
    around = np.abs(sphere[:, :2]) / np.where(across > 0.0, across, 1.0)[:, None]

    def powers(along: float, round_axis: float) -> Vector:
        high = np.abs(sphere[:, 2]) ** along
        return np.copysign(np.column_stack([across[:, None] ** along * around**round_axis, high]), sphere)

    normals = powers(2.0 / p, 2.0 / q) / semi
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    points = semi * powers(2.0 - 2.0 / p, 2.0 - 2.0 / q) + core[5] * normals
    return np.array(core[6:9]) + points @ axes.T, triangles


def moments_in_body(core: tuple[float, ...], second: tuple[float, float, float]) -> Vector:
    """Return the inertia tensor in body axes, shape [3, 3], from the integrals of x^2, y^2, z^2 in axes of the core."""
    axes = np.array(core[9:18]).reshape(3, 3)
    return np.asarray(axes @ np.diag(sum(second) - np.array(second)) @ axes.T)


@functools.lru_cache(maxsize=64)
def integrals_with_radius(core: tuple[float, ...]) -> tuple[float, float, float, float]:
    """Return the integrals of 1, x^2, y^2 and z^2 over a core with its radius, in its own axes [m^3], [m^5].

    The body consists of cones from its centre to the elements dA of its surface at the points P.  Such a cone has the
    volume P . dA / 3, and the integral of x^2 over it is x^2 P . dA / 5.  The surface is parametrised by the two angles
    of :func:`drawn`, over an eighth of it.  Powers of their sines and cosines are singular at the ends of this range.
    Therefore the quadrature is the double exponential rule of Takahasi and Mori.
    """
    t = np.arange(-_LAST_NODE, _LAST_NODE + 0.5 * _STEP, _STEP)
    far = 1.0 / (1.0 + np.exp(math.pi * np.sinh(t)))
    sines, cosines = np.sin(0.5 * math.pi * far[::-1]), np.sin(0.5 * math.pi * far)
    weights = 0.5 * math.pi * _STEP * math.pi * np.cosh(t) * far * far[::-1]
    semi, radius, along, across = np.array(core[:3]), core[5], 2.0 - 2.0 / core[3], 2.0 - 2.0 / core[4]
    point, point_up, point_round = _of_angles(sines, cosines, along, across, semi)
    normal, normal_up, normal_round = _of_angles(sines, cosines, 2.0 - along, 2.0 - across, 1.0 / semi)
    length = np.linalg.norm(normal, axis=-1, keepdims=True)
    normal = normal / length
    normal_up, normal_round = (
        (d - normal * np.sum(normal * d, axis=-1, keepdims=True)) / length for d in (normal_up, normal_round)
    )
    place = point + radius * normal
    area = np.cross(point_round + radius * normal_round, point_up + radius * normal_up)
    parts = 8.0 * np.outer(weights, weights) * np.sum(place * area, axis=-1)
    x, y, z = np.sum(parts[..., None] * place**2, axis=(0, 1)).tolist()
    return float(np.sum(parts)) / 3.0, x / 5.0, y / 5.0, z / 5.0


def _of_angles(
    sines: Vector, cosines: Vector, along: float, across: float, factors: Vector
) -> tuple[Vector, Vector, Vector]:
    """Return factors times (c^e C^f, c^e S^f, s^e) and its derivatives by the two angles, shape [n, n, 3]."""
    (s, c), (high, wide) = (sines[:, None], cosines[:, None]), (sines[None, :], cosines[None, :])
    one, none = np.ones_like(high), np.zeros_like(s * high)
    by_up = -along * c ** (along - 1.0) * s
    rows = (
        (c**along * wide**across, c**along * high**across, s**along * one),
        (by_up * wide**across, by_up * high**across, along * s ** (along - 1.0) * c * one),
        (
            -across * c**along * wide ** (across - 1.0) * high,
            across * c**along * high ** (across - 1.0) * wide,
            none,
        ),
    )
    value, up, around = (factors * np.stack(row, axis=-1) for row in rows)
    return value, up, around
