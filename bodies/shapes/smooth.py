"""Shapes with a smooth support function: what their contact pairs, mass properties and drawings are made of."""

from __future__ import annotations

import math

import numpy as np

from bodies.shapes.placement import turned
from bodies.shapes.support_function import support_of
from nonsmooth.interfaces.body import Vector

_NODES = 40
"""Of Gauss's rule over an angle."""


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
        p and q, not below 2.
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
    """Return the distance of the farthest point from the origin of the body frame [m], a bound if it is not known.

    Of a shape about the origin it is an axis's, powers p >= q of 2 and more, as the core lies in the ellipsoid.
    """
    return math.hypot(*core[6:9]) + max(core[:3]) + core[5]


def drawn(core: tuple[float, ...], fineness: int) -> tuple[Vector, Vector]:
    """Return vertices [m], shape [n, 3], and triangles, shape [m, 3], of a closed mesh.

    The vertices are the support points of directions that are even on the sphere of (x / a, y / b, z / c).
    """
    n_round, n_high = max(fineness, 3), max((fineness + 1) // 2, 2)
    around = 2.0 * math.pi / n_round * np.arange(n_round)
    heights = math.pi / n_high * np.arange(1, n_high)
    sphere = [(0.0, 0.0, 1.0)]
    sphere += [(math.sin(t) * math.cos(f), math.sin(t) * math.sin(f), math.cos(t)) for t in heights for f in around]
    sphere += [(0.0, 0.0, -1.0)]
    axes, semi = np.array(core[9:18]).reshape(3, 3), np.array(core[:3])
    vertices = np.array([support_point(core, axes @ (np.array(n) / semi)) for n in sphere])
    last = len(sphere) - 1

    def ring(row: int, step: int) -> int:
        return 1 + row * n_round + step % n_round

    triangles = []
    for i in range(n_round):
        triangles.append((0, ring(0, i), ring(0, i + 1)))
        for row in range(n_high - 2):
            low, high = ring(row + 1, i), ring(row + 1, i + 1)
            triangles += [(ring(row, i), low, high), (ring(row, i), high, ring(row, i + 1))]
        triangles.append((last, ring(n_high - 2, i + 1), ring(n_high - 2, i)))
    return vertices, np.array(triangles)


def moments_in_body(core: tuple[float, ...], second: tuple[float, float, float]) -> Vector:
    """Return the inertia tensor in body axes, shape [3, 3], of integrals of x^2, y^2, z^2 in the core's own axes."""
    axes = np.array(core[9:18]).reshape(3, 3)
    return np.asarray(axes @ np.diag(sum(second) - np.array(second)) @ axes.T)


def integrals_over_normals(core: tuple[float, ...]) -> tuple[float, float, float, float]:
    """Return the integrals of 1, x^2, y^2 and z^2 over a core with its radius, in its own axes [m^3], [m^5].

    The cones from the centre to the elements dA of the surface have the volume h dA / 3 and the integral h x^2 dA / 5,
    and dA is the determinant of the radii of curvature times the solid angle of the normals.  By Gauss's rule over the
    normals of an eighth, with nodes closer where a radius of curvature may be 0.
    """
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    s = 0.5 * (nodes + 1.0)
    # from 0 to a right angle, with three derivatives 0 at either end
    angles = 0.5 * math.pi * s**4 * (35.0 + s * (-84.0 + s * (70.0 - 20.0 * s)))
    weights = 0.5 * weights * 0.5 * math.pi * 140.0 * (s * (1.0 - s)) ** 3
    semi, radius = np.array(core[:3]), core[5]
    sums = np.zeros(4)
    for t, w in zip(angles, weights, strict=True):
        for f, v in zip(angles, weights, strict=True):
            n = np.array([math.sin(t) * math.cos(f), math.sin(t) * math.sin(f), math.cos(t)]) / semi
            length = float(np.linalg.norm(n))
            n /= length
            h, *p, xx, yy, zz, yz, xz, xy = support_of(core, *n.tolist())
            second = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) + radius * np.eye(3)
            second += (1.0 - radius) * np.outer(n, n)
            area = w * v * math.sin(t) / (length**3 * float(np.prod(semi))) * float(np.linalg.det(second))
            point = np.array(p) + radius * n
            sums += area * (h + radius) * np.array([1.0 / 3.0, *point**2 / 5.0])
    volume, x, y, z = (8.0 * sums).tolist()
    return volume, x, y, z
