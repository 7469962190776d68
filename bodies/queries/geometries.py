"""What libraries are told of shapes: kinds of geometries, where they stand, and by what they are swept."""

from __future__ import annotations

import functools
from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import DistanceBackend, Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.vectors import perpendiculars

from ..meshes.checks import flat_triangles
from ..meshes.topology import Integers
from ..shapes.box import Box
from ..shapes.capsule import Capsule
from ..shapes.cone import Cone
from ..shapes.cylinder import Cylinder
from ..shapes.ellipsoid import Ellipsoid
from ..shapes.hull import ConvexHull
from ..shapes.placement import with_axes
from ..shapes.sphere import Sphere
from ..shapes.triangle_mesh import TriangleMesh


@final
@dataclass(frozen=True, eq=False)
class Made:
    """A shape as a library has it.

    Attributes
    ----------
    shape : Shape
        The shape, kept alive.
    geometry : object
        The library's geometry of its core.
    place, axes : Vector
        Where that stands in the body [m], shape [3], and its axes as columns, shape [3, 3].
    sweep : float
        Radius by which the core is rounded [m].
    point : Vector
        A point of the core in the body [m], shape [3].
    """

    shape: Shape
    geometry: Any
    place: Vector
    axes: Vector
    sweep: float
    point: Vector

    @functools.cached_property
    def extent(self) -> float:
        """That of the shape [m]."""
        return self.shape.extent

    @functools.cached_property
    def box(self) -> tuple[Vector, Vector]:
        """Corners of a box in the body round the solid [m], shape [3] each."""
        assert self.shape.solid is not None
        return self.shape.solid.bounds


class GeometryMaker(DistanceBackend):
    """Base of distance libraries: makes geometries, each centred in its own axes, from sizes in [m]."""

    @abstractmethod
    def ball(self, radius: float) -> Any:
        """Return a ball."""

    @abstractmethod
    def box(self, sides: tuple[float, float, float]) -> Any:
        """Return a box with these sides."""

    @abstractmethod
    def capsule(self, radius: float, length: float) -> Any:
        """Return a capsule about the third axis; the length is that between the centres of its ends."""

    @abstractmethod
    def cylinder(self, radius: float, length: float) -> Any:
        """Return a cylinder about the third axis."""

    @abstractmethod
    def cone(self, radius: float, height: float) -> Any:
        """Return a cone whose apex is half of the height up the third axis."""

    @abstractmethod
    def ellipsoid(self, semi_axes: tuple[float, float, float]) -> Any:
        """Return an ellipsoid."""

    @abstractmethod
    def hull(self, vertices: Vector, faces: Integers) -> Any:
        """Return a convex polyhedron."""

    @abstractmethod
    def mesh(self, vertices: Vector, faces: Integers) -> Any:
        """Return a surface of triangles."""


_HERE = np.zeros(3), np.eye(3)


def _about(shape: Shape, geometry: Any, middle: Vector, axes: Vector, sweep: float = 0.0) -> Made:
    return Made(shape, geometry, middle, axes, sweep, middle)


def _sphere(library: GeometryMaker, shape: Sphere) -> Made:
    return _about(shape, library.ball(shape.radius), _centre(shape), np.eye(3))


def _box(library: GeometryMaker, shape: Box) -> Made:
    x, y, z = shape.core_sizes
    return _about(shape, library.box((2.0 * x, 2.0 * y, 2.0 * z)), _centre(shape), _turn(shape), shape.rounding)


def _capsule(library: GeometryMaker, shape: Capsule) -> Made:
    geometry = library.capsule(shape.radius, 2.0 * shape.half_length)
    return _about(shape, geometry, _centre(shape), _along(shape))


def _cylinder(library: GeometryMaker, shape: Cylinder) -> Made:
    radius, half = shape.core_sizes
    return _about(shape, library.cylinder(radius, 2.0 * half), _centre(shape), _along(shape), shape.rounding)


def _cone(library: GeometryMaker, shape: Cone) -> Made:
    (radius, height), axes = shape.core_sizes, _along(shape)
    middle = _centre(shape) + (shape.rounding + 0.5 * height) * axes[:, 2]
    return _about(shape, library.cone(radius, height), middle, axes, shape.rounding)


def _ellipsoid(library: GeometryMaker, shape: Ellipsoid) -> Made:
    geometry = library.ellipsoid((shape.semi_x, shape.semi_y, shape.semi_z))
    return _about(shape, geometry, _centre(shape), _turn(shape))


def _hull(library: GeometryMaker, shape: ConvexHull) -> Made:
    vertices, faces = _checked(library, np.array(shape.core.vertices), np.array(shape.core.triangles))
    return Made(shape, library.hull(vertices, faces), *_HERE, shape.rounding, vertices[0])


def _mesh(library: GeometryMaker, shape: TriangleMesh) -> Made:
    vertices, faces = _checked(library, *shape.drawing())
    return Made(shape, library.mesh(vertices, faces), *_HERE, 0.0, vertices[0])


MAKERS: Mapping[type[Shape], Callable[[GeometryMaker, Any], Made]] = {
    Sphere: _sphere,
    Box: _box,
    Capsule: _capsule,
    Cylinder: _cylinder,
    Cone: _cone,
    Ellipsoid: _ellipsoid,
    ConvexHull: _hull,
    TriangleMesh: _mesh,
}
"""What libraries have kinds for.  A new kind needs the tests of every pair with the others.

Half-spaces and planes end the process in most functions of FCL, and points are wrong there; other smooth shapes would
be replaced by polyhedra.
"""


def _checked(library: GeometryMaker, vertices: Vector, faces: Integers) -> tuple[Vector, Integers]:
    """Return vertices and triangles; InvalidInput if a library would read out of bounds, or build a tree of nothing."""
    name = type(library).__name__
    if len(faces) == 0 or not np.all(np.isfinite(vertices)) or np.any((faces < 0) | (faces >= len(vertices))):
        raise InvalidInput(
            name,
            "must be given triangles of finite vertices that exist",
            f"{len(faces)} triangles, {len(vertices)} vertices",
            "Check the mesh.",
        )
    flat = int(np.sum(flat_triangles(vertices, faces)))
    if flat:
        raise InvalidInput(name, "must be given no triangle of zero area", flat, "Repair the mesh with 'zero_area'.")
    return vertices, faces


def _centre(shape: Any) -> Vector:
    return np.array([shape.x, shape.y, shape.z])


def _turn(shape: Any) -> Vector:
    return with_axes(shape.orientation_w, shape.orientation_x, shape.orientation_y, shape.orientation_z)


def _along(shape: Any) -> Vector:
    """Return axes as columns of which the third is that of the shape."""
    axis = shape.axis_x, shape.axis_y, shape.axis_z
    return np.array([*perpendiculars(axis), axis]).T
