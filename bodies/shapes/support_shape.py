"""SupportShape: a convex shape given by its farthest points; checks of its curvature, and its volume integrals."""

from __future__ import annotations

import contextlib
import functools
import itertools
import math
from abc import abstractmethod
from collections.abc import Callable
from typing import Any, final

import numpy as np

from nonsmooth.binding.methods import bind_support
from nonsmooth.binding.source import described, line_of
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.body import Vector

from .drawing import arc, revolved, solid_of
from .smooth import SmoothShape
from .support_function import FUNCTION, OF_FUNCTION

_SHARPEST, _FLATTEST = 1e-3, 1e3
"""Least of the larger principal radii of curvature, and largest radius, that a shape may have, relative to its size."""
_LOOKS = 400
"""Number of directions, evenly over the sphere, along which a shape is checked before its first use."""
_ROUND_OFF = 1e-9
_DERIVED = ("core", "length", "_integrals", "_checked")


@final
class _Address(float):
    """Address of the compiled support function of a shape. In another process it is pickled as that of the shape there.

    Attributes
    ----------
    shape : SupportShape
        The shape.
    """

    shape: SupportShape

    @classmethod
    def of(cls, address: int, shape: SupportShape) -> _Address:
        """Return an address that belongs to a shape."""
        made = cls(address)
        made.shape = shape
        return made

    def __reduce__(self) -> Any:
        """Pickle the shape, whose function has another address in another process."""
        return _address_of, (self.shape,)


def _address_of(shape: SupportShape) -> float:
    return shape.core[FUNCTION]


class SupportShape(SmoothShape):
    """A convex shape that a user gives by its farthest points; the engine derives all other properties.

    A subclass is a final, frozen dataclass whose parameters are declared with :func:`nonsmooth.parameters.parameter`,
    and has one method, ``support``.  Its contract:

    1. It returns the point of the shape that lies farthest along a direction of any length, in the frame of the body.
    2. The surface has no corner, no straight edge and no flat place.  An edge that is curved may be sharp, as the rim
       of a lens.  Round a shape by a ball that rolls over it: add ``radius * direction / |direction|`` to the point.
    3. It is compiled if it uses only declared parameters of ``self``, numbers, :mod:`math`, numpy and functions at
       module level.  Otherwise it runs in Python, with a warning.

    Raises
    ------
    InvalidInput
        At the first use: a point is not the farthest one, both radii of curvature are below a thousandth of the size,
        or one is above a thousand times the size.  At any call before a run: ``support`` raises, or does not return
        three finite numbers.
    """

    @abstractmethod
    def support(self, direction: Vector) -> Vector:
        """Return the farthest point along ``direction`` (shape [3], not zero) [m], shape [3]."""

    @final
    def farthest(self, direction: Vector) -> Vector:
        """Return the point of ``support`` [m], shape [3]; raise InvalidInput if it is not three finite numbers."""
        found: object
        where, cause = "", None
        try:
            point = np.asarray(self.support(direction), dtype=float)
            if point.shape == (3,) and np.all(np.isfinite(point)):
                return point
            found = point.tolist()
        except Exception as error:
            found, where, cause = error, line_of(self.support, error), error
        raise InvalidInput(
            f"{type(self).__name__}: {described(self.support)},",
            "must return three finite numbers",
            found,
            f"It is asked along {direction.tolist()}{where}: a direction of any length has a farthest point.",
        ) from cause

    @final
    def farthest_of(self, directions: Vector) -> Vector:
        """Return the points of ``support`` along directions [m], shape [n, 3]; InvalidInput if one is not finite."""
        with contextlib.suppress(Exception):
            points = np.array([self.support(n) for n in directions], dtype=float)
            if points.shape == directions.shape and np.all(np.isfinite(points)):
                return points
        return np.array([self.farthest(n) for n in directions])

    @functools.cached_property
    def core(self) -> tuple[float, ...]:
        """Numbers for compiled functions: half the extents [m], middle [m], address of ``support``, its parameters."""
        assert self._checked
        low, high = self.bounds
        half, (x, y, z) = (0.5 * (high - low)).tolist(), (0.5 * (low + high)).tolist()
        address, heap = bind_support(self, (x, y, z))
        axes = np.eye(3).ravel().tolist()
        return (*half, OF_FUNCTION, OF_FUNCTION, 0.0, x, y, z, *axes, _Address.of(address, self), *heap)

    @functools.cached_property
    def length(self) -> float:
        """Upper bound of the distance of the farthest point from the origin [m].

        It is the largest distance of the farthest points along ``_LOOKS`` directions, divided by the cosine of the
        largest angle from any direction to the nearest of these.
        """
        directions, reach = spiral(_LOOKS)
        return max(float(np.linalg.norm(p)) for p in self.farthest_of(directions)) / math.cos(reach)

    @functools.cached_property
    def _integrals(self) -> tuple[float, Vector, Vector]:
        assert self._checked
        return integrals_over(self.drawing)

    @functools.cached_property
    def _checked(self) -> bool:
        _check(self)
        return True

    def __getstate__(self) -> dict[str, Any]:
        # derived attributes hold addresses of compiled functions, which are valid in this process only: leave them out
        return {name: value for name, value in vars(self).items() if name not in _DERIVED}

    @property
    def volume(self) -> float:
        """Volume, extrapolated from ever finer meshes [m^3]."""
        return self._integrals[0]

    @property
    def centroid(self) -> Vector:
        """Centroid, extrapolated from ever finer meshes [m]."""
        return self._integrals[1]

    @property
    def inertia(self) -> Vector:
        """Inertia tensor about the centroid at density 1, extrapolated from ever finer meshes [m^5]."""
        return self._integrals[2]

    def drawing(self, fineness: int = 24) -> tuple[Vector, Vector]:
        """Return vertices [m], shape [n, 3], and triangles, shape [m, 3], of a mesh of the surface.

        The vertices are the farthest points along directions on a grid of ``fineness`` meridians of the sphere.
        """
        sphere, triangles = revolved(arc(fineness, math.pi, 0.0), fineness, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0))
        return self.farthest_of(sphere), triangles


def _check(shape: SupportShape) -> None:
    """Check a shape by its farthest points along many directions.

    Raises
    ------
    InvalidInput
        The shape is not convex, too sharp or too flat, or depends on the length of the direction.
    """
    name = f"{type(shape).__name__}.support"
    directions, _ = spiral(_LOOKS)
    points = shape.farthest_of(directions)
    reach, heights = directions @ points.T, np.sum(directions * points, axis=1)
    size = float(np.max(heights + np.max(reach, axis=1)))
    beyond = np.max(reach, axis=1) - heights
    worst = int(np.argmax(beyond))
    if not size > 0.0 or beyond[worst] > _ROUND_OFF * size:
        raise InvalidInput(
            name,
            "must return the farthest of the points that it returns along any direction",
            points[worst].tolist(),
            f"Along {directions[worst].tolist()} another one is {beyond[worst]:.3g} m farther. Is the shape convex?",
        )
    twice = float(np.max(np.abs(shape.farthest_of(2.0 * directions[:9]) - points[:9])))
    if twice > _ROUND_OFF * size:
        raise InvalidInput(
            name, "must not depend on the length of the direction", twice, "Divide by np.linalg.norm(direction)."
        )
    least = sharpest_corner(shape.farthest_of, directions) / size
    most = largest_radius(shape.farthest_of, directions, points) / size
    if not least >= _SHARPEST:
        raise InvalidInput(
            name,
            f"must have a radius of curvature of {_SHARPEST:g} of its size or more at each point",
            least * size,
            f"It has a corner: roll a ball over it by adding radius * direction / np.linalg.norm(direction), with a "
            f"radius of {_SHARPEST * size:.2g} m or more.",
        )
    if not most <= _FLATTEST:
        raise InvalidInput(
            name,
            f"must have radii of curvature of {_FLATTEST:g} times its size at most",
            most * size,
            "A flat place has no single farthest point: give it a large radius, or take a box, a hull or a cylinder.",
        )


Support = Callable[[Vector], Vector]
"""A function that returns the farthest points [m] along directions, shape [n, 3] both."""
_TURN = 1e-3
_WAYS, _FIRST, _LAST, _CLOSER = 4, 0.15, 1e-4, 0.8
"""Limits of the searches for a flat place in :func:`largest_radius`.

``_WAYS``: number of searches, each from another direction.  ``_FIRST`` and ``_LAST``: first and last angle by which a
search turns its direction [rad].  ``_CLOSER``: ratio of this angle to the angle before.
"""
_ROUND = [(math.cos(0.25 * math.pi * i), math.sin(0.25 * math.pi * i)) for i in range(8)]
_COARSEST, _TIMES = 24, 4
"""Meshes of the surface from which :func:`integrals_over` computes volume, centroid and inertia of a shape.

``_COARSEST``: number of meridians of the coarsest mesh.  ``_TIMES``: number of meshes.  Each mesh has twice as many
meridians as the one before.
"""


def spiral(count: int) -> tuple[Vector, float]:
    """Return ``count`` unit vectors spread over the sphere, shape [count, 3], and the mesh width of this set [rad].

    The mesh width is an upper bound of the angle from any direction to the nearest of the vectors.
    """
    i = np.arange(count) + 0.5
    z, angle = 1.0 - 2.0 * i / count, math.pi * (1.0 + math.sqrt(5.0)) * i
    r = np.sqrt(1.0 - z * z)
    return np.column_stack([r * np.cos(angle), r * np.sin(angle), z]), 3.0 / math.sqrt(count)


def sharpest_corner(support: Support, directions: Vector) -> float:
    """Return the least of the larger principal radii of curvature at the points with given normals [m].

    It is 0 at a corner, but not at a curved edge.  Principal radii are the eigenvalues of the derivative dP/dn, with
    the shape's farthest point P(n) along n.
    """
    rates = _rates(support, directions)
    middle, half = 0.5 * (rates[:, 0] + rates[:, 2]), 0.5 * (rates[:, 0] - rates[:, 2])
    return float(np.min(middle + np.hypot(half, rates[:, 1])))


def largest_radius(support: Support, directions: Vector, points: Vector) -> float:
    """Return the largest radius of curvature found by searches for flat places [m].

    A flat place has a single normal, in general not one of the given ``directions``.  If two neighbouring directions
    lie on either side of this normal, their farthest points are far apart.  A search therefore starts from a given
    direction whose point has the largest distances from its neighbours.  It goes, in ever smaller steps, to the
    direction at which points for two directions on either side are farthest apart.
    """
    beside = points[np.argsort(directions @ directions.T, axis=1)[:, -5:]]
    apart = np.max(np.linalg.norm(beside - points[:, None], axis=2), axis=1)
    largest = 0.0
    for n in directions[np.argsort(apart)[-_WAYS:]]:
        step = _FIRST
        while step > _LAST:
            looks = np.vstack([n, math.cos(step) * n + _ways(n[None], step)[:, 0]])
            n, step = looks[int(np.argmax(_chords(support, looks, step)))], _CLOSER * step
        largest = max(largest, float(_chords(support, n[None], step)[0]) / (2.0 * step))
    return largest


def _ways(directions: Vector, step: float, count: int = len(_ROUND)) -> Vector:
    """Return the vectors that, added to cos(step) times a direction, tilt it by ``step`` [rad]; shape [count, n, 3].

    The n directions are tilted to ``count`` sides, 45 degrees from side to side.
    """
    t, u = _across(directions)
    return np.array([math.sin(step) * (c * t + s * u) for c, s in _ROUND[:count]])


def _chords(support: Support, directions: Vector, step: float) -> Vector:
    """Return the largest chord of the shape near the farthest point along each direction [m], shape [n].

    A chord joins the farthest points along two directions: the given one, tilted by ``step`` [rad] to opposite sides.
    A long chord shows a flat place.
    """
    along, ways = math.cos(step) * directions, _ways(directions, step, len(_ROUND) // 2)
    one, other = (support(sides.reshape(-1, 3)) for sides in (along + ways, along - ways))
    return np.asarray(np.max(np.linalg.norm(one - other, axis=1).reshape(len(ways), -1), axis=0))


def integrals_over(drawing: Callable[[int], tuple[Vector, Vector]]) -> tuple[float, Vector, Vector]:
    """Return volume [m^3], centroid [m], and inertia at density 1 about the centroid [m^5].

    They are extrapolated from meshes with vertices on the surface, each twice as fine as the one before (L. F.
    Richardson): the errors are a series in the squares of the edges.  The relative error is 1e-8 if the curvature does
    not jump, else about 1e-4.

    Parameters
    ----------
    drawing : callable
        Returns vertices and triangles of the mesh of a given fineness.
    """
    rows = []
    for time in range(_TIMES):
        volume, first, about = solid_of(*drawing(_COARSEST * 2**time))
        rows.append(np.concatenate([[volume], first, about.ravel()]))
    for order in range(1, _TIMES):
        rows = [(4.0**order * fine - coarse) / (4.0**order - 1.0) for coarse, fine in itertools.pairwise(rows)]
    return float(rows[0][0]), rows[0][1:4], rows[0][4:].reshape(3, 3)


def _across(directions: Vector) -> tuple[Vector, Vector]:
    """Return two perpendicular unit vectors t and u across each direction, shape [n, 3] each."""
    other = np.eye(3)[np.argmin(np.abs(directions), axis=1)]
    t = np.cross(directions, other)
    t /= np.linalg.norm(t, axis=1)[:, None]
    return t, np.cross(directions, t)


def _rates(support: Support, directions: Vector) -> Vector:
    """Return three elements of the derivative dP/dn of a shape's farthest point P(n) along n [m], shape [n, 3].

    They are t . dP/dn t, t . dP/dn u and u . dP/dn u, with the vectors t and u of :func:`_across`.
    """
    t, u = _across(directions)
    slopes = [np.zeros_like(t), np.zeros_like(t)]
    for slope, across in zip(slopes, (t, u), strict=True):
        for i, weight in ((-2, 1.0), (-1, -8.0), (1, 8.0), (2, -1.0)):
            turned = math.cos(i * _TURN) * directions + math.sin(i * _TURN) * across
            slope += weight / (12.0 * _TURN) * support(turned)
    (by_t, by_u) = slopes
    mixed = 0.5 * (np.sum(by_t * u, axis=1) + np.sum(by_u * t, axis=1))
    return np.column_stack([np.sum(by_t * t, axis=1), mixed, np.sum(by_u * u, axis=1)])
