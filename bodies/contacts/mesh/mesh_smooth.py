"""A smooth body against a triangle mesh, convex or not; of many patches, only near ones are contacts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import SharedNumbers, Value
from nonsmooth.types import Floats

from ...meshes.patches import patches_for_body
from ...shapes.smooth import SmoothShape, extent
from ...shapes.triangle_mesh import TriangleMesh
from ..features.writing import write_apart
from ..surface.patch_near import PatchNear, are_many
from ..surface.surface_search import FAR
from ..surface.surface_smooth import write_surface_smooth
from ..surface.surface_tables import surface_numbers

POINT = 0.0, 0.0, 0.0, 2.0, 2.0, 0.0
"""A point as a core: three semi-axes 0, both powers 2, radius 0 (:func:`bodies.shapes.smooth.core_numbers`)."""


def _evaluate_near(
    a: Floats,
    b: Floats,
    out: Floats,
    candidate: Floats,
    surface: Floats,
    second: Floats,
    point: Floats,
    size: float,
) -> None:
    if candidate[0] == 0.0:
        write_apart(a, out, size)
    else:
        write_surface_smooth(a, b, out, surface, candidate[1], second, point, candidate[3])


@final
@dataclass(frozen=True)
class MeshSmoothNear(PatchNear):
    """Contact of a smooth body with one patch of a mesh, which a search assigns: a patch that is near at present."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (TriangleMesh, SmoothShape)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[MeshSmoothNear, ...]:
        """Return as many contacts as there are patches."""
        assert isinstance(first, TriangleMesh)
        assert isinstance(second, SmoothShape)
        core = second.core
        ball = core[6], core[7], core[8], extent(core)
        patches = patches_for_body(first.features, 2.0 * ball[3])
        return cls._of_patches(first.features, patches, ball, {"second": core, "point": POINT})

    @property
    def evaluator(self) -> Callable[..., None]:
        """A search over the features, with Newton's method on the support function."""
        return _evaluate_near


def _evaluate(a: Floats, b: Floats, out: Floats, surface: Floats, patch: float, second: Floats, point: Floats) -> None:
    write_surface_smooth(a, b, out, surface, patch, second, point, FAR)


@final
@dataclass(frozen=True)
class MeshSmooth(ContactKinematics):
    """The contact of a smooth body with the nearest face, convex edge or corner of one patch of a mesh.

    Attributes
    ----------
    surface : SharedNumbers
        The surface (:mod:`bodies.contacts.surface.surface_tables`), in patches for a body of this size.
    patch : int
        Number of the patch.
    second : SmoothShape
        The smooth body.
    counts : tuple of int
        Numbers of faces, convex edges and corners.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (TriangleMesh, SmoothShape)
    surface: SharedNumbers
    patch: int
    second: SmoothShape
    counts: tuple[int, int, int]

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return one contact for each patch of the mesh.

        If there are many patches, a search assigns near patches to the contacts (:class:`MeshSmoothNear`).
        """
        assert isinstance(first, TriangleMesh)
        assert isinstance(second, SmoothShape)
        own = first.features
        patches = patches_for_body(own, 2.0 * extent(second.core))
        if are_many(patches):
            return MeshSmoothNear.between(first, second)
        surface = surface_numbers(own, patches)
        counts = len(own.planes), len(own.edges), len(own.corners)
        return tuple(cls(surface, patch, second, counts) for patch in range(patches.count))

    def parameters(self) -> dict[str, Value]:
        """Return the surface, the patch and the numbers of the support function."""
        return {"surface": self.surface, "patch": float(self.patch), "second": self.second.core, "point": POINT}

    @property
    def evaluator(self) -> Callable[..., None]:
        """A search over the features, with Newton's method on the support function."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """The faces, convex edges and corners by number."""
        kinds = zip(("face", "edge", "corner"), self.counts, strict=True)
        return tuple(f"{name} {i} and smooth" for name, n in kinds for i in range(n))
