"""A smooth body against a mesh of many patches, of which those near it are contacts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.features.apart import write_apart
from bodies.contacts.surface.patch_near import PatchNear
from bodies.contacts.surface.surface_smooth import write_surface_smooth
from bodies.meshes.patches import patches_for_body
from bodies.shapes.smooth import extent
from bodies.shapes.smooth_shape import SmoothShape
from bodies.shapes.triangle_mesh import TriangleMesh
from nonsmooth.interfaces import Shape
from nonsmooth.types import Floats

POINT = 0.0, 0.0, 0.0, 2.0, 2.0, 0.0
"""The core of a point (:func:`bodies.shapes.smooth.core_numbers`)."""


def _evaluate(
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
    """The contact of a smooth body with one of the patches of a mesh that are near it."""

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
        return _evaluate
