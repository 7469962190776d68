"""Shapes with a smooth support function: what their contact pairs, mass properties and drawings are made of."""

from __future__ import annotations

import functools
import math

import numpy as np

from bodies.shapes.drawing import arc, revolved
from bodies.shapes.placement import turned
from bodies.shapes.support_function import support_of
from nonsmooth.interfaces.body import Vector

_STEP, _LAST_NODE = 0.125, 4.75
"""Of the double exponential rule over an angle."""


def core_numbers(
    semi: tuple[float, float, float],
    powers: tuple[float, float],
    radius: float,
    center: tuple[float, float, float],
    orientation: tuple[float, float, float, float],
) -> tuple[float, ...]:
    """Return the numbers of a core by which evaluators know a shape.

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
    point = support_of(core, *(axes.T @ unit))[1:4]
    return np.asarray(np.array(core[6:9]) + axes @ np.array(point) + core[5] * unit)


def farthest(core: tuple[float, ...]) -> float:
    """Return the distance of the farthest point from the origin of the body frame [m], a bound if it is not known."""
    return math.hypot(*core[6:9]) + extent(core)


def extent(core: tuple[float, ...]) -> float:
    """Return the distance of the farthest point from the centre of the core [m].

    It is an axis's, powers of 2 and more, as the core lies in the ellipsoid.  In the squares of the coordinates a core
    with less is one of the same kind, and their sum the support function of that.
    """
    return _corner(core) + core[5]


def _corner(core: tuple[float, ...]) -> float:
    """Return the distance of the farthest point of a core from its centre, without the radius [m]."""

    def norm(one: float, two: float, power: float) -> float:
        # p of the gauge is p / (p - 1), of the squares' gauge half of it, of its dual p / (2 - p)
        larger, smaller = max(one, two), min(one, two)
        if power >= 2.0:
            return larger
        dual = power / (2.0 - power)
        return float(larger * (1.0 + (smaller / larger) ** dual) ** (1.0 / dual))

    a, b, c = (axis * axis for axis in core[:3])
    return math.sqrt(norm(norm(a, b, core[4]), c, core[3]))


def drawn(core: tuple[float, ...], fineness: int) -> tuple[Vector, Vector]:
    """Return vertices [m], shape [n, 3], and triangles, shape [m, 3], of a closed mesh.

    The vertices are those of meridians and parallels with powers of sines and cosines, sin^(2/q) in a normal over
    the semi-axes and sin^(2 - 2/q) in its point, which are a superellipsoid's usual angles.
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
    """Return the inertia tensor in body axes, shape [3, 3], of integrals of x^2, y^2, z^2 in the core's own axes."""
    axes = np.array(core[9:18]).reshape(3, 3)
    return np.asarray(axes @ np.diag(sum(second) - np.array(second)) @ axes.T)


@functools.lru_cache(maxsize=64)
def integrals_over_normals(core: tuple[float, ...]) -> tuple[float, float, float, float]:
    """Return the integrals of 1, x^2, y^2 and z^2 over a core with its radius, in its own axes [m^3], [m^5].

    The cones from the centre to the elements dA of the surface have the volume h dA / 3 and the integral h x^2 dA / 5,
    and dA is the determinant of the radii of curvature times the solid angle of the normals.  The normals are those of
    :func:`drawn`; powers of sines and cosines at the ends of an eighth ask for the rule of Takahasi and Mori.
    """
    t = np.arange(-_LAST_NODE, _LAST_NODE + 0.5 * _STEP, _STEP)
    far = 1.0 / (1.0 + np.exp(math.pi * np.sinh(t)))
    sines, cosines = np.sin(0.5 * math.pi * far[::-1]), np.sin(0.5 * math.pi * far)
    weights = 0.5 * math.pi * _STEP * math.pi * np.cosh(t) * far * far[::-1]
    semi, radius, (p, q) = np.array(core[:3]), core[5], core[3:5]
    # powers and the Jacobian of the turn that they make
    (low, high), (one, two) = (sines ** (2.0 / p), cosines ** (2.0 / p)), (cosines ** (2.0 / q), sines ** (2.0 / q))
    along = weights * 2.0 / p * (sines * cosines) ** (2.0 / p - 1.0) * low
    around = weights * 2.0 / q * (sines * cosines) ** (2.0 / q - 1.0)
    sums = np.zeros(4)
    for i, first in enumerate(along):
        for j, second in enumerate(around):
            n = np.array([low[i] * one[j], low[i] * two[j], high[i]]) / semi
            length = float(np.linalg.norm(n))
            n /= length
            h, *point, xx, yy, zz, yz, xz, xy = support_of(core, *n.tolist())
            curve = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
            curve += radius * np.eye(3) + (1.0 - radius) * np.outer(n, n)
            area = first * second / (length**3 * float(np.prod(semi))) * float(np.linalg.det(curve))
            sums += area * (h + radius) * np.array([1.0 / 3.0, *(point + radius * n) ** 2 / 5.0])
    volume, x, y, z = (8.0 * sums).tolist()
    return volume, x, y, z
