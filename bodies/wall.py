"""Wall: a plane at rest, by its normal."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.interfaces import Shape
from nonsmooth.parameters import Value
from nonsmooth.vectors import perpendiculars

from .blocks import stand_still
from .prescribed import Prescribed
from .shapes.plane import Plane
from .values import check_fields


@final
@dataclass(frozen=True)
class Wall(Prescribed):
    """An unbounded plane at rest: a wall, a slope, a ceiling.

    Attributes
    ----------
    normal : tuple of float
        Unit vector in world axes to the side on which bodies are.
    point : tuple of float
        A point of the plane [m, shape (3)].

    Raises
    ------
    InvalidInput
        If the normal is no unit vector or the point not three numbers.
    """

    normal: tuple[float, float, float] = (0.0, 0.0, 1.0)
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    evaluator: ClassVar[Callable[..., None]] = staticmethod(stand_still)

    def _check(self) -> None:
        check_fields(self, "normal", "point")

    def parameters(self) -> Mapping[str, Value]:
        """Return the pose: the point [m], and the rotation matrix whose third column is the normal."""
        rows = zip(*perpendiculars(self.normal), self.normal, strict=True)
        return {"pose": (*self.point, *itertools.chain(*rows))}

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        """One frame with the plane through its origin."""
        return ((Plane(),),)
