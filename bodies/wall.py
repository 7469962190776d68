"""Wall: a plane at rest, by its normal."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from bodies.motions.pose import put_pose
from bodies.prescribed import Prescribed
from bodies.shapes.plane import Plane
from bodies.values import unit_vector, vector
from nonsmooth.interfaces import Shape
from nonsmooth.types import Floats
from nonsmooth.vectors import perpendiculars


def _evaluate(
    t: float,
    q: Floats,
    u: Floats,
    out: Floats,
    x: float,
    y: float,
    z: float,
    xx: float,
    xy: float,
    xz: float,
    yx: float,
    yy: float,
    yz: float,
    zx: float,
    zy: float,
    zz: float,
) -> None:
    put_pose(out, 0, (x, y, z), (xx, yx, zx), (xy, yy, zy), (xz, yz, zz))


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

    def _check(self) -> None:
        object.__setattr__(self, "normal", tuple(unit_vector("Wall.normal", self.normal).tolist()))
        object.__setattr__(self, "point", tuple(vector("Wall.point", self.point, 3, "m").tolist()))

    def parameters(self) -> dict[str, float]:
        """Return the point and the rotation matrix whose third column is the normal."""
        columns = (*perpendiculars(self.normal), self.normal)
        turn = {row + column: columns[j][i] for i, row in enumerate("xyz") for j, column in enumerate("xyz")}
        return dict(zip("xyz", self.point, strict=True)) | turn

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        """One frame with the plane through its origin."""
        return ((Plane(),),)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The fixed pose."""
        return _evaluate

    @property
    def time_scale(self) -> float:
        """Infinite [s]."""
        return math.inf
