"""A sphere against a mesh of many patches, of which those near it are contacts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.features.apart import write_apart
from bodies.contacts.surface.patch_near import PatchNear
from bodies.contacts.surface.surface_ball import write_ball
from bodies.meshes.patches import patches_for_ball
from bodies.shapes.sphere import Sphere
from bodies.shapes.triangle_mesh import TriangleMesh
from nonsmooth.interfaces import Shape
from nonsmooth.types import Floats


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
class MeshSphereNear(PatchNear):
    """The contact of a sphere with one of the patches of a mesh that are near it."""

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
        return _evaluate
