"""Support functions and insides of convex shapes over many poses at once, apart from all that the contact pairs use."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bodies import Capsule, Ellipsoid, Frustum, Sphere, Superellipsoid
from nonsmooth.interfaces import ConvexShape

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Outline:
    """A core and the radius of the sphere that sweeps it, of a shape in the middle of its body frame.

    The core is ((x/a)^(2/e2) + (y/b)^(2/e2))^(e2/e1) + (z/c)^(2/e1) <= 1, or what lies between two circles about the
    third axis.

    Attributes
    ----------
    radius : float
        Of the sphere [m].
    semi, exponents : tuple of float
        a, b, c [m] and e1, e2; a point has none.
    circles : tuple of float
        Radii of the lower and the upper circle, and their heights [m]; empty for the other kind.
    """

    radius: float
    semi: tuple[float, float, float] = (0.0, 0.0, 0.0)
    exponents: tuple[float, float] = (1.0, 1.0)
    circles: tuple[float, ...] = ()

    @property
    def size(self) -> float:
        """Largest extent from the middle [m]."""
        return self.radius + float(np.linalg.norm(self.semi)) + max(map(abs, self.circles), default=0.0)

    def support(self, n: Array) -> Array:
        """Return the points of the core that are farthest along unit vectors, both of shape [k, 3]."""
        if self.circles:
            low, high, below, above = self.circles
            across = np.hypot(n[:, 0], n[:, 1])
            upper = high * across + above * n[:, 2] > low * across + below * n[:, 2]
            radius, height = np.where(upper, high, low), np.where(upper, above, below)
            share = radius / np.where(across > 0.0, across, 1.0)
            return np.column_stack([share * n[:, 0], share * n[:, 1], height])
        if self.semi[0] == 0.0:
            return np.zeros_like(n)
        p, q = (2.0 / (2.0 - e) for e in self.exponents)
        m = np.abs(n) * self.semi
        wide = _norm(m[:, 0], m[:, 1], q)
        total = _norm(wide, m[:, 2], p)
        safe = np.where(wide > 0.0, wide, 1.0)
        out, up = (wide / total) ** (p - 1.0), (m[:, 2] / total) ** (p - 1.0)
        parts = (out * (m[:, 0] / safe) ** (q - 1.0), out * (m[:, 1] / safe) ** (q - 1.0), up)
        return np.asarray(np.copysign(self.semi * np.column_stack(parts), n))

    def height(self, n: Array) -> Array:
        """Return the support function of core and radius at unit vectors, shape [k]."""
        if self.circles:
            low, high, below, above = self.circles
            across = np.hypot(n[:, 0], n[:, 1])
            found = np.maximum(low * across + below * n[:, 2], high * across + above * n[:, 2])
            return np.asarray(found + self.radius)
        if self.semi[0] == 0.0:
            return np.full(len(n), self.radius)
        p, q = (2.0 / (2.0 - e) for e in self.exponents)
        m = np.abs(n) * self.semi
        return np.asarray(_norm(_norm(m[:, 0], m[:, 1], q), m[:, 2], p) + self.radius)

    def outside(self, points: Array) -> Array:
        """Return bounds of how far points, shape [k, 3], are from the core, 0 inside, shape [k]."""
        if self.circles:
            return self._from_circles(points)
        length = np.linalg.norm(points, axis=1)
        if self.semi[0] == 0.0:
            return np.asarray(length)
        along, across = (2.0 / e for e in self.exponents)
        m = np.abs(points) / self.semi
        gauge = _norm(_norm(m[:, 0], m[:, 1], across), m[:, 2], along)
        # on the line to the middle the surface is so far
        return np.asarray(np.maximum(1.0 - 1.0 / np.maximum(gauge, 1e-300), 0.0) * length)

    def _from_circles(self, points: Array) -> Array:
        low, high, below, above = self.circles
        point = np.column_stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]])
        outline = np.array([(0.0, below), (low, below), (high, above), (0.0, above)])
        nearest, inside = np.full(len(points), np.inf), np.ones(len(points), dtype=bool)
        for one, two in itertools.pairwise(outline):
            way, off = two - one, point - one
            share = np.clip(off @ way / max(float(way @ way), 1e-300), 0.0, 1.0)
            nearest = np.minimum(nearest, np.linalg.norm(off - share[:, None] * way, axis=1))
            inside &= way[0] * off[:, 1] - way[1] * off[:, 0] >= 0.0
        return np.where(inside & (above > below), 0.0, nearest)


def _norm(one: Array, two: Array, power: float) -> Array:
    larger, smaller = np.maximum(one, two), np.minimum(one, two)
    ratio = smaller / np.where(larger > 0.0, larger, 1.0)
    return np.asarray(larger * (1.0 + ratio**power) ** (1.0 / power))


def outline_of(shape: ConvexShape) -> Outline:
    """Return the outline of a shape about the origin of its body frame and along its axes."""
    given: Any = shape
    if isinstance(shape, Sphere):
        return Outline(shape.radius)
    if isinstance(shape, Capsule):
        return Outline(shape.radius, circles=(0.0, 0.0, -shape.half_length, shape.half_length))
    if isinstance(shape, Ellipsoid | Superellipsoid):
        semi = given.semi_x, given.semi_y, given.semi_z
        if isinstance(shape, Ellipsoid):
            return Outline(0.0, semi)
        return Outline(shape.rounding, semi, (shape.exponent_along, shape.exponent_across))
    assert isinstance(shape, Frustum)
    return Outline(shape.rounding, circles=shape.frustum[:4])
