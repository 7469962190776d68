"""Contacts of a sphere and a triangle mesh, in closed form; if the mesh has many patches, only with near patches."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import SharedNumbers, Value
from nonsmooth.types import Floats

from ...meshes.features import Features
from ...meshes.patches import patches_for_ball
from ...shapes.sphere import Sphere
from ...shapes.triangle_mesh import TriangleMesh
from ..features.writing import write_apart
from ..surface.patch_near import PatchNear, are_many
from ..surface.surface_ball import write_ball
from ..surface.surface_search import FAR
from ..surface.surface_tables import Numbers, surface_numbers


def _evaluate_near(
    a: Floats,
    b: Floats,
    out: Floats,
    candidate: Floats,
    surface: Floats,
    radius: float,
    x_b: float,
    y_b: float,
    z_b: float,
    size: float,
) -> None:
    if candidate[0] == 0.0:
        write_apart(a, out, size)
    else:
        reach = radius + candidate[3]
        write_ball(a, b, out, surface, candidate[1], radius, (x_b, y_b, z_b), 0.0, surface, size, reach)


@final
@dataclass(frozen=True)
class MeshSphereNear(PatchNear):
    """Contact of a sphere with one patch of a mesh; a search assigns a patch that is near at present."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (TriangleMesh, Sphere)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[MeshSphereNear, ...]:
        """Return as many contacts as there are patches."""
        assert isinstance(first, TriangleMesh)
        assert isinstance(second, Sphere)
        ball = second.x, second.y, second.z, second.radius
        values = dict(zip(("x_b", "y_b", "z_b", "radius"), ball, strict=True))
        return cls._of_patches(first.features, patches_for_ball(first.features, second.radius), ball, values)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate_near


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
    write_ball(a, b, out, surface, patch, radius, (x_b, y_b, z_b), n_star, star, size, FAR)


@final
@dataclass(frozen=True)
class MeshSphere(ContactKinematics):
    """The contact of a sphere with the nearest face, convex edge or corner of one patch of a mesh.

    The surface is divided into patches, so that a sphere of this size touches one feature of a patch at a time
    (:mod:`bodies.meshes.patches`).  A convex mesh is one patch; a mesh with inner corners has two or more.

    Attributes
    ----------
    surface : SharedNumbers
        The surface (:mod:`bodies.contacts.surface.surface_tables`).
    patch : int
        Number of the patch.
    center : tuple of float
        Centre of the sphere in its body frame [m].
    radius : float
        Radius of the sphere [m].
    star : tuple of float
        Unit vectors along the edges that leave the centre, if it is a vertex of a rounded polyhedron.
    size : float
        Size of the larger body [m].
    counts : tuple of int
        Numbers of faces, convex edges and corners.
    name : str
        Name of the sphere.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (TriangleMesh, Sphere)
    surface: SharedNumbers
    patch: int
    center: tuple[float, float, float]
    radius: float
    star: Numbers
    size: float
    counts: tuple[int, int, int]
    name: str

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return one contact for each patch; of many patches for those near the sphere."""
        assert isinstance(first, TriangleMesh)
        assert isinstance(second, Sphere)
        own = first.features
        if are_many(patches_for_ball(own, second.radius)):
            return MeshSphereNear.between(first, second)
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
