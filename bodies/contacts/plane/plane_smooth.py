"""A smooth body over a plane, in closed form."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.engine.memory.blocks import ROTATION, SIDE_B
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.ground import Ground
from ...shapes.smooth import SmoothShape
from ...shapes.support_function import support_of
from ...vectors import vector_at
from ..features.frames import point_in_world
from ..smooth.smooth_core import RADIUS, axes_in_world, back, forth
from ..smooth.smooth_newton import write_surface
from .plane_point import place_over_plane


def _evaluate(a: Floats, b: Floats, out: Floats, height: float, second: Floats) -> None:
    axes = axes_in_world(b, second)
    x, y, z = point_in_world(b, vector_at(second, 6))
    mx, my, mz = back(axes, (-a[ROTATION + 2], -a[ROTATION + 5], -a[ROTATION + 8]))
    _, point, _ = support_of(second, (mx, my, mz))
    px, py, pz = forth(axes, point)
    r = second[RADIUS]
    place_over_plane(
        a, out, x + px - r * a[ROTATION + 2], y + py - r * a[ROTATION + 5], z + pz - r * a[ROTATION + 8], height
    )
    write_surface(out, SIDE_B, second, axes, (mx, my, mz), point)


@final
@dataclass(frozen=True)
class PlaneSmooth(ContactKinematics):
    """The point of a smooth body that a plane supports.

    Attributes
    ----------
    first : Ground
        The plane.
    second : SmoothShape
        The smooth body.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Ground, SmoothShape)

    first: Ground
    second: SmoothShape

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[PlaneSmooth, ...]:
        """Return the single contact of a plane and a smooth shape."""
        assert isinstance(first, Ground)
        assert isinstance(second, SmoothShape)
        return (cls(first, second),)

    def parameters(self) -> Mapping[str, Value]:
        """Return the height of the plane and the numbers of the support function."""
        return {"height": self.first.height, "second": self.second.core}

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features."""
        return ("plane-smooth",)
