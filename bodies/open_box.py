"""OpenBox: a floor and four walls at rest."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from bodies.motions.pose import pose_parameters, put_pose
from bodies.prescribed import Prescribed
from bodies.shapes.plane import Plane
from bodies.values import unit_quaternion, vector
from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter
from nonsmooth.types import Floats

_PLANES = 5


def _evaluate(
    t: float,
    q: Floats,
    u: Floats,
    out: Floats,
    half_x: float,
    half_y: float,
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
    a, b, c = (xx, yx, zx), (xy, yy, zy), (xz, yz, zz)
    back_a, back_b = (-xx, -yx, -zx), (-xy, -yy, -zy)
    put_pose(out, 0, (x, y, z), a, b, c)
    # the third axis of each wall is the normal to the inside
    put_pose(out, FRAME, (x - half_x * xx, y - half_x * yx, z - half_x * zx), b, c, a)
    put_pose(out, 2 * FRAME, (x + half_x * xx, y + half_x * yx, z + half_x * zx), c, b, back_a)
    put_pose(out, 3 * FRAME, (x - half_y * xy, y - half_y * yy, z - half_y * zy), c, a, b)
    put_pose(out, 4 * FRAME, (x + half_y * xy, y + half_y * yy, z + half_y * zy), a, c, back_b)


@final
@dataclass(frozen=True)
class OpenBox(Prescribed):
    """A box at rest, open at the top, for what is inside: an unbounded floor, and walls that are as high as needed.

    Its shapes are the floor, the walls across its first axis, at -half_x and half_x, and those across the second.

    Attributes
    ----------
    half_x : float
        Half of the inner length along its first axis [m].
    half_y : float
        Half of the inner length along its second axis [m].
    position : tuple of float
        The middle of the floor [m, shape (3)].
    orientation : tuple of float
        Unit quaternion (scalar first) from its axes to the world's; the third one is the normal of the floor.

    Raises
    ------
    InvalidInput
        If a length is not positive, the position not three numbers or the quaternion not unit.
    """

    half_x: float = parameter(doc="half of the inner length along the first axis", unit="m", above=0.0)
    half_y: float = parameter(doc="half of the inner length along the second axis", unit="m", above=0.0)
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    orientation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)

    def _check(self) -> None:
        object.__setattr__(self, "position", tuple(vector("OpenBox.position", self.position, 3, "m").tolist()))
        turn = unit_quaternion("OpenBox.orientation", self.orientation)
        object.__setattr__(self, "orientation", tuple(turn.tolist()))

    def parameters(self) -> dict[str, float]:
        """Return the half-lengths, the position and the rotation matrix of the orientation."""
        return self.numbers() | pose_parameters(self.position, self.orientation)

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        """Five frames, each with the plane through its origin."""
        return ((Plane(),),) * _PLANES

    @property
    def evaluator(self) -> Callable[..., None]:
        """The fixed poses of floor and walls."""
        return _evaluate

    @property
    def time_scale(self) -> float:
        """Infinite [s]."""
        return math.inf
