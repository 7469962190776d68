"""Look: what is seen of a body in pictures; it touches nothing."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field
from typing import final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nonsmooth.interfaces.solid import SolidRegion, Vector

Integers = NDArray[np.int64]
_DIRECTIONS = 300


def _none(width: int) -> Integers:
    return np.zeros((0, width), dtype=np.int64)


@final
@dataclass(frozen=True, eq=False)
class Look:
    """Triangles, lines and marks in the axes of a frame.

    Attributes
    ----------
    vertices : array
        Places [m], shape [n, 3]; one that neither a triangle nor a line uses is drawn as a mark.
    triangles : array
        Numbers of three vertices, counter-clockwise seen from outside, shape [m, 3].
    lines : array
        Numbers of the two vertices that a line joins, shape [k, 2].
    sheet : bool
        Whether it is a plane without end, through its vertex and normal to the third axis of the frame.
    """

    vertices: Vector
    triangles: Integers = field(default_factory=lambda: _none(3))
    lines: Integers = field(default_factory=lambda: _none(2))
    sheet: bool = False

    @classmethod
    def solid(cls, vertices: ArrayLike, triangles: ArrayLike) -> Look:
        """Return that of a surface of triangles."""
        return cls(np.asarray(vertices, dtype=float), np.asarray(triangles, dtype=np.int64))

    @classmethod
    def polyline(cls, *points: ArrayLike) -> Look:
        """Return that of a line from point to point [m], shape [3] each."""
        numbers = np.arange(len(points))
        return cls(np.array(points, dtype=float), lines=np.column_stack([numbers[:-1], numbers[1:]]))

    @classmethod
    def mark(cls, *points: ArrayLike) -> Look:
        """Return marks at points [m], shape [3] each."""
        return cls(np.array(points, dtype=float).reshape(-1, 3))

    @classmethod
    def hull(cls, points: ArrayLike) -> Look:
        """Return that of what points [m], shape [n, 3], span: a solid, a flat piece, a line or a mark."""
        # whoever draws nothing starts faster without it
        from scipy.spatial import ConvexHull, QhullError

        given = np.unique(np.asarray(points, dtype=float).reshape(-1, 3), axis=0)
        middle = given.mean(axis=0)
        spread, axes = np.linalg.svd(given - middle, full_matrices=True)[1:]
        flat = int(np.count_nonzero(spread > 1e-9 * np.max(np.abs(given), initial=0.0)))
        if flat == 0:
            return cls.mark(middle)
        along = (given - middle) @ axes.T
        if flat == 1:
            return cls.polyline(given[np.argmin(along[:, 0])], given[np.argmax(along[:, 0])])
        try:
            found = ConvexHull(along[:, :flat])
        except QhullError:
            return cls.mark(*given)
        if flat == 2:
            # a triangle fan, seen from both sides
            fan = np.array([(found.vertices[0], i, j) for i, j in itertools.pairwise(found.vertices[1:])])
            return cls.solid(given, np.concatenate([fan, fan[:, ::-1]]))
        corners = given[found.simplices]
        outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        inside = np.einsum("ij,ij->i", outward, corners[:, 0] - middle) < 0.0
        return cls.solid(given, np.where(inside[:, None], found.simplices[:, ::-1], found.simplices))

    @classmethod
    def spanned(cls, solid: SolidRegion) -> Look:
        """Return that of the points of a solid that lie farthest along directions all round."""
        number = np.arange(_DIRECTIONS) + 0.5
        up, turn = 1.0 - 2.0 * number / _DIRECTIONS, np.pi * (1.0 + 5.0**0.5) * number
        ring = np.sqrt(1.0 - up**2)
        directions = np.column_stack([ring * np.cos(turn), ring * np.sin(turn), up])
        return cls.hull([solid.support(direction) for direction in directions])
