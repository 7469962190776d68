"""A sphere against a triangle mesh, convex or not, in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.curvature import SIDE_A, SIDE_B, write_round
from bodies.contacts.frames import point_in_world, vector_in_body
from bodies.contacts.offset import place_sphere
from bodies.contacts.surface_feature import out_of_surface, write_feature
from bodies.contacts.surface_search import nearest_in_patch
from bodies.contacts.surface_tables import N_PATCHES, Numbers, surface_numbers
from bodies.contacts.swept_vertex import END, NEAR, past_star
from bodies.meshes.features import Features
from bodies.meshes.patches import patches_for_ball
from bodies.shapes.sphere import Sphere
from bodies.shapes.triangle_mesh import TriangleMesh
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Table, Value
from nonsmooth.types import Floats


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    surface: Floats,
    patch: float,
    radius: float,
    x_b: float,
    y_b: float,
    z_b: float,
    n_star: float,
    star: Floats,
    size: float,
) -> None:
    center_x, center_y, center_z = point_in_world(b, x_b, y_b, z_b)
    x, y, z = vector_in_body(a, center_x - a[0], center_y - a[1], center_z - a[2])
    found = nearest_in_patch(surface, patch, x, y, z)
    distance, kind, number = found[0], found[2], found[3]
    # the patch of a surface that has one only does not end
    past = found[1] if surface[N_PATCHES] > 1.0 else 0.0
    nx, ny, nz = out_of_surface(a, surface, found, past, x, y, z)
    if n_star > 0.0:
        beyond = past_star(b, star, n_star, distance, nx, ny, nz, size)
        past = max(past, min(beyond, -END * size) if distance - radius > NEAR * size else beyond)
    out[1], out[2], out[3] = nx, ny, nz
    if past > 0.0:
        apart = max(distance - radius, 0.0)
        distance = math.sqrt(apart * apart + past * past) + radius
    place_sphere(a, out, center_x, center_y, center_z, distance, radius)
    out[30] = past
    write_feature(a, out, SIDE_A, surface, kind, number)
    write_round(out, SIDE_B, radius)


@final
@dataclass(frozen=True)
class MeshSphere(ContactKinematics):
    """The contact of a sphere with the nearest face, convex edge or corner of one patch of a mesh.

    The surface is divided into patches of which a sphere of this size touches one feature at a time
    (:mod:`bodies.meshes.patches`): one of a convex mesh, two or more where it has inner corners.

    Attributes
    ----------
    surface : Table
        The surface (:mod:`bodies.contacts.surface_tables`).
    patch : int
        Number of the patch.
    center : tuple of float
        Centre of the sphere in its body frame [m].
    radius : float
        Its radius [m].
    star : tuple of float
        Unit vectors along the edges that leave its centre, if that is a vertex of a body with a radius about it.
    size : float
        Size of the larger body [m].
    counts : tuple of int
        Numbers of faces, convex edges and corners.
    name : str
        What the sphere is called.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (TriangleMesh, Sphere)
    surface: Table
    patch: int
    center: tuple[float, float, float]
    radius: float
    star: Numbers
    size: float
    counts: tuple[int, int, int]
    name: str

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[MeshSphere, ...]:
        """Return one contact for each patch."""
        assert isinstance(first, TriangleMesh)
        assert isinstance(second, Sphere)
        own = first.features
        return cls.of_balls(own, [((second.x, second.y, second.z), (), "sphere")], second.radius, own.size)

    @classmethod
    def of_balls(
        cls,
        first: Features,
        vertices: Iterable[tuple[tuple[float, float, float], Numbers, str]],
        radius: float,
        size: float,
    ) -> tuple[MeshSphere, ...]:
        """Return the contacts of balls of one radius [m], each a place, a star and a name, with all patches."""
        patches = patches_for_ball(first, radius)
        surface = surface_numbers(first, patches)
        counts = len(first.planes), len(first.edges), len(first.corners)
        return tuple(
            cls(surface, patch, place, radius, star, size, counts, name)
            for place, star, name in vertices
            for patch in range(patches.count)
        )

    def parameters(self) -> dict[str, Value]:
        """Return the surface, the patch and the sphere."""
        x, y, z = self.center
        return {
            "surface": self.surface,
            "patch": float(self.patch),
            "radius": self.radius,
            "x_b": x,
            "y_b": y,
            "z_b": z,
            "n_star": float(len(self.star) // 3),
            "star": self.star,
            "size": self.size,
        }

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """The faces, convex edges and corners by number."""
        kinds = zip(("face", "edge", "corner"), self.counts, strict=True)
        return tuple(f"{part} {i} and {self.name}" for part, n in kinds for i in range(n))
