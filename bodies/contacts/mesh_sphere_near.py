"""A sphere against a mesh of many patches, of which those near it are contacts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.apart import NO_CANDIDATE, write_apart
from bodies.contacts.frames import point_in_world, vector_in_body
from bodies.contacts.surface_ball import write_ball
from bodies.contacts.surface_near import patches_of_leaves
from bodies.contacts.surface_tables import surface_numbers
from bodies.meshes.features import Features
from bodies.meshes.patches import patches_for_ball
from bodies.shapes.sphere import Sphere
from bodies.shapes.triangle_mesh import TriangleMesh
from nonsmooth.interfaces import CandidateSearch, ContactKinematics, Shape
from nonsmooth.parameters import Table, Value
from nonsmooth.types import Floats

Place = tuple[float, float, float]


def _find(
    a: Floats, b: Floats, out: Floats, surface: Floats, radius: float, x_b: float, y_b: float, z_b: float
) -> None:
    """Find the patches with a feature near the sphere."""
    x, y, z = point_in_world(b, x_b, y_b, z_b)
    x, y, z = vector_in_body(a, x - a[0], y - a[1], z - a[2])
    bits = patches_of_leaves(surface, x, y, z, radius + out[0])
    patch, n = 0, 0
    while bits:
        if bits & 1:
            out[1 + 3 * n], out[2 + 3 * n], out[3 + 3 * n] = 1.0, float(patch), 0.0
            n += 1
        bits >>= 1
        patch += 1
    out[0] = float(n)


def _evaluate(
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
        write_ball(a, b, out, surface, candidate[1], radius, x_b, y_b, z_b, 0.0, surface, size, reach)


@final
@dataclass(frozen=True)
class MeshSphereNear(ContactKinematics):
    """The contact of a sphere with one of the patches that are near it (:class:`bodies.MeshSphere`).

    Attributes
    ----------
    search : CandidateSearch
        What finds them.
    surface : Table
        The surface (:mod:`bodies.contacts.surface_tables`).
    center : tuple of float
        Centre of the sphere in its body frame [m].
    radius : float
        Its radius [m].
    size : float
        Size of the mesh [m].
    n_features : int
        How many features the mesh has.
    number : int
        Which of the contacts of mesh and sphere it is.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (TriangleMesh, Sphere)
    search: CandidateSearch
    surface: Table
    center: Place
    radius: float
    size: float
    n_features: int
    number: int

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return as many contacts as the mesh has patches."""
        assert isinstance(first, TriangleMesh)
        assert isinstance(second, Sphere)
        return cls.of_ball(first.features, (second.x, second.y, second.z), second.radius)

    @classmethod
    def of_ball(cls, own: Features, center: Place, radius: float) -> tuple[MeshSphereNear, ...]:
        """Return the contacts of a surface and a ball with this centre and radius [m]."""
        patches = patches_for_ball(own, radius)
        surface = surface_numbers(own, patches)
        x, y, z = center
        values: dict[str, Value] = {"surface": surface, "radius": radius, "x_b": x, "y_b": y, "z_b": z}
        search, n = CandidateSearch(_find, values), len(own.planes) + len(own.edges) + len(own.corners)
        return tuple(cls(search, surface, center, radius, own.size, n, number) for number in range(patches.count))

    @property
    def candidates(self) -> CandidateSearch:
        """What finds the patches."""
        return self.search

    def parameters(self) -> dict[str, Value]:
        """Return the surface, the sphere, and no patch."""
        return {**self.search.values, "candidate": NO_CANDIDATE, "size": self.size}

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """The features of the mesh, by number."""
        return tuple(f"feature {i} and sphere" for i in range(self.n_features))
