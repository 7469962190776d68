"""What a closed surface of triangles encloses."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from nonsmooth.interfaces import ConvexPart
from nonsmooth.interfaces.body import Vector
from nonsmooth.interfaces.solid import SolidRegion, Surface

from .integrals import areas_of, winding_number
from .topology import Integers, shells

_LOOKED_AT = 32
"""Triangles under which points inside are sought: the largest of every shell, so many of all, but one of each."""


@final
@dataclass(frozen=True, eq=False)
class MeshSolid(SolidRegion, Surface):
    """The triangles are its pieces.

    Attributes
    ----------
    vertices : Vector
        Corners in the body frame [m], shape [n, 3].
    faces : Integers
        Triangles, counter-clockwise seen from outside, shape [m, 3].
    touched : callable
        Returns the corners of the surface that contacts see [m], shape [n, 3]: its nearly flat faces are made flat.
    """

    vertices: Vector
    faces: Integers
    touched: Callable[[], Vector]

    @functools.cached_property
    def set_back(self) -> float:
        """How far a corner is moved to make faces flat that the digits of a file have bent [m]."""
        return float(np.max(np.linalg.norm(self.touched() - self.vertices, axis=1)))

    @property
    def surface(self) -> MeshSolid:
        """The triangles, with nothing between them."""
        return self

    @functools.cached_property
    def _corners(self) -> Vector:
        return self.vertices[self.faces]

    @functools.cached_property
    def _triangles(self) -> Vector:
        """Corners of the triangles that contacts see [m], shape [m, 3, 3]."""
        return self.touched()[self.faces]

    @functools.cached_property
    def boxes(self) -> tuple[Vector, Vector]:
        """Lowest and highest coordinates of every triangle [m]."""
        return np.min(self._triangles, axis=1), np.max(self._triangles, axis=1)

    @functools.cached_property
    def _tree(self) -> tuple[Any, float]:
        """Return the middles of the boxes in a tree, and half the widest box with what rounding may take of it [m]."""
        from scipy.spatial import cKDTree

        low, high = self.boxes
        size = float(np.max(np.abs(self.vertices)))
        return cKDTree(0.5 * (low + high)), 0.5 * float(np.max(high - low)) + 1e-12 * size

    @functools.cached_property
    def _normals(self) -> Vector:
        a, b, c = self._corners[:, 0], self._corners[:, 1], self._corners[:, 2]
        across = np.cross(b - a, c - a)
        return np.asarray(across / np.linalg.norm(across, axis=1)[:, None])

    @functools.cached_property
    def bounds(self) -> tuple[Vector, Vector]:
        """Those of its corners [m]."""
        return np.min(self.vertices, axis=0), np.max(self.vertices, axis=0)

    def support(self, direction: Vector) -> Vector:
        """Return the corner that lies farthest along a direction [m]."""
        return np.asarray(self.vertices[int(np.argmax(self.vertices @ direction))])

    def near(self, low: Vector, high: Vector) -> Integers:
        """Return the numbers of the triangles whose boxes meet the box."""
        tree, widest = self._tree
        bounds = np.min(self.boxes[0], axis=0), np.max(self.boxes[1], axis=0)
        low, high = np.maximum(low, bounds[0]), np.minimum(high, bounds[1])
        around = tree.query_ball_point(0.5 * (low + high), 0.5 * np.max(high - low) + widest, p=np.inf)
        near = np.sort(np.array(around, dtype=np.int64))
        meets = np.all((self.boxes[0][near] <= high) & (self.boxes[1][near] >= low), axis=1)
        return np.asarray(near[meets])

    def piece(self, number: int) -> ConvexPart:
        """Return a triangle."""
        return ConvexPart.of_points(self._triangles[number])

    @property
    def hull(self) -> ConvexPart:
        """The hull of the corners that contacts see."""
        from scipy.spatial import ConvexHull

        corners = self._triangles.reshape(-1, 3)
        return ConvexPart.of_points(corners[ConvexHull(corners).vertices])

    @functools.cached_property
    def inner(self) -> Vector:
        """For the largest triangles of every shell the point half-way from its middle inwards to the next one [m]."""
        shell = shells(self.faces)
        order = np.lexsort((-areas_of(self.vertices, self.faces), shell))
        _, first, which = np.unique(shell[order], return_index=True, return_inverse=True)
        largest = np.arange(len(order)) - first[which] < max(1, _LOOKED_AT // len(first))
        return np.array([self._under(int(i)) for i in order[largest]])

    def _under(self, number: int) -> Vector:
        """Return the point half-way along the ray inwards (T. Moeller, B. Trumbore, J. Graphics Tools 2 (1997) 21)."""
        middle, way = np.mean(self._corners[number], axis=0), -self._normals[number]
        a, u, v = self._corners[:, 0], *np.moveaxis(self._corners[:, 1:] - self._corners[:, :1], 1, 0)
        across = np.cross(way, v)
        sixfold = np.einsum("ni,ni->n", u, across)
        faced = np.abs(sixfold) > 0.0
        faced[number] = False
        a, u, v, across, sixfold = a[faced], u[faced], v[faced], across[faced], sixfold[faced]
        first = np.einsum("ni,ni->n", middle - a, across) / sixfold
        turned = np.cross(middle - a, u)
        second = turned @ way / sixfold
        ahead = np.einsum("ni,ni->n", v, turned) / sixfold
        met = (first >= 0.0) & (second >= 0.0) & (first + second <= 1.0) & (ahead > 0.0)
        # a ray through an edge may meet nothing: a point on the surface is inside of nothing either
        return np.asarray(middle + (0.5 * np.min(ahead[met]) if np.any(met) else 0.0) * way)

    def holds(self, point: Vector, margin: float) -> bool:
        """Tell whether the surface goes round the point and those beside it."""
        places = point + margin * np.array([*np.zeros((1, 3)), *np.eye(3), *-np.eye(3)])
        return all(winding_number(self.vertices, self.faces, place) > 0.5 for place in places)
