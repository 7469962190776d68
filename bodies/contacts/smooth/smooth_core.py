"""Cores of smooth bodies and their axes, for contacts.

A smooth body is a core with a smooth support function, rounded by a radius.  The numbers of a core are those of
:func:`bodies.shapes.smooth.core_numbers`.  A search that takes two cores (:class:`Cores`) computes in the axes of the
first core, from its centre.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...rotations import Axes, by_columns, rotated, rotated_back
from ...shapes.support_function import Bends, Core, support_of
from ...vectors import Vector3, divided, minus, norm, opposite, plus
from ..features.frames import vector_in_world

SemiAxes: TypeAlias = tuple[float, float, float, float, float]
"""Three semi-axes [m] and two powers of a core; a core whose semi-axes are 0 is a point."""
NearestPoint: TypeAlias = tuple[float, Vector3, Vector3]
"""Gap [m], point [m] and unit normal, the result of a search; the gap is nan if the search failed."""


class Cores(NamedTuple):
    """Two cores, in the axes of the first and from its centre; their radii are not used.

    Attributes
    ----------
    first, second : Floats
        Numbers of the cores.
    turn : tuple of float
        Rotation from the axes of the second core to those of the first.
    center : tuple of float
        Centre of the second core [m].
    """

    first: Core
    second: Core
    turn: Axes
    center: Vector3


POWERS, RADIUS, CENTER, CORE_AXES = 3, 5, 6, 9
"""Indices in the numbers of a core, after its semi-axes: powers, radius, centre, rotation to the axes of the body."""
POINT = 0.0, 0.0, 0.0, 2.0, 2.0, 0.0
"""Core numbers of a point."""


@compiled
def at_place(cores: Cores, place: Vector3) -> Cores:
    """Return two cores, the first of which was moved to a place, in its axes and from its centre [m]."""
    return Cores(cores.first, cores.second, cores.turn, minus(cores.center, place))


@compiled
def size_of(cores: Cores) -> float:
    """Return the size of both bodies together [m], to which tolerances are relative."""
    return float(spread(cores.center) + largest_semi_axis(cores.first) + largest_semi_axis(cores.second))


@compiled
def unit(v: Vector3) -> Vector3:
    """Return a vector divided by its length."""
    return divided(v, norm(v))


@compiled
def spread(v: Vector3) -> float:
    """Return the sum of the absolute components of a vector, a measure of its size that is cheap."""
    return abs(v[0]) + abs(v[1]) + abs(v[2])


@compiled
def largest_semi_axis(core: Core) -> float:
    """Return the largest semi-axis of a core [m], 0 for a point."""
    return max(core[0], core[1], core[2])


@compiled
def semi_axes_of(core: Core) -> SemiAxes:
    """Return the semi-axes [m] and powers of a core."""
    return core[0], core[1], core[2], core[POWERS], core[POWERS + 1]


@compiled
def bend(h: Bends, u: Vector3, v: Vector3) -> float:
    """Return u . H v with the second derivative H of a support function [m]; ``h`` holds the six elements of H."""
    return (
        u[0] * (h[0] * v[0] + h[5] * v[1] + h[4] * v[2])
        + u[1] * (h[5] * v[0] + h[1] * v[1] + h[3] * v[2])
        + u[2] * (h[4] * v[0] + h[3] * v[1] + h[2] * v[2])
    )


@compiled
def axes_in_world(frame: Floats, core: Core) -> Axes:
    """Return the axes of a core in the world, as columns; or of a frustum, whose numbers have the same indices."""
    x = vector_in_world(frame, (core[CORE_AXES], core[CORE_AXES + 3], core[CORE_AXES + 6]))
    y = vector_in_world(frame, (core[CORE_AXES + 1], core[CORE_AXES + 4], core[CORE_AXES + 7]))
    z = vector_in_world(frame, (core[CORE_AXES + 2], core[CORE_AXES + 5], core[CORE_AXES + 8]))
    return by_columns(x, y, z)


@compiled
def unit_axes_in_world(frame: Floats, core: Core) -> Axes:
    """Return the axes of a smooth body's core in the world, as columns of length 1.

    Within a time step, a body's quaternion is not normalised.  If its length is L, its matrix is L^2 times a rotation:
    all rows and columns have the length L^2.
    """
    x, y, z, u, v, w, r, s, t = axes_in_world(frame, core)
    factor = 1.0 / norm((x, y, z))
    return factor * x, factor * y, factor * z, factor * u, factor * v, factor * w, factor * r, factor * s, factor * t


@compiled
def facing_point(cores: Cores, n: Vector3) -> tuple[Vector3, Bends]:
    """Return the point of the second core that faces the first along n [m], and the second derivative of its support.

    It is the farthest point in the direction -n.  Point and n are in the axes of the first core, the point from its
    centre.  The second derivative is in the axes of the second core [m].
    """
    _, p, h = support_of(cores.second, rotated_back(cores.turn, opposite(n)))
    return plus(cores.center, rotated(cores.turn, p)), h
