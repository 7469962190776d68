"""The null object of motion: a fixed pose."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from bodies.blocks import put
from bodies.motions.pose import pose_parameters
from bodies.values import unit_quaternion, vector
from nonsmooth.engine.memory.blocks import POSITION, ROTATION
from nonsmooth.interfaces import Motion
from nonsmooth.parameters import parameter
from nonsmooth.types import Floats


def _evaluate(
    t: float,
    q: Floats,
    u: Floats,
    out: Floats,
    slope: float,
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
    c, s = math.cos(slope), math.sin(slope)
    put(out, POSITION, x, y, z)
    put(out, ROTATION, xx * c - xz * s, xy, xx * s + xz * c)
    put(out, ROTATION + 3, yx * c - yz * s, yy, yx * s + yz * c)
    put(out, ROTATION + 6, zx * c - zz * s, zy, zx * s + zz * c)


@final
@dataclass(frozen=True)
class Rest(Motion):
    """No motion: the frame stays where it is put.

    Attributes
    ----------
    slope : float
        Turns the frame about its second axis so that its first axis points downhill [rad].
    position : tuple of float
        Where the origin of the frame is [m, shape (3)].
    orientation : tuple of float
        Unit quaternion (scalar first) that turns the frame, its slope included, to the world.

    Raises
    ------
    InvalidInput
        If the slope is steeper than a right angle, the position not three numbers or the quaternion not unit.
    """

    slope: float = parameter(0.0, doc="angle of the slope", unit="rad", minimum=-math.pi / 2, maximum=math.pi / 2)
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    orientation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)

    def _check(self) -> None:
        position = vector("Rest.position", self.position, 3, "m")
        orientation = unit_quaternion("Rest.orientation", self.orientation)
        object.__setattr__(self, "position", tuple(position.tolist()))
        object.__setattr__(self, "orientation", tuple(orientation.tolist()))

    def parameters(self) -> dict[str, float]:
        """Return the slope, the position and the rotation matrix of the orientation."""
        return {"slope": self.slope, **pose_parameters(self.position, self.orientation)}

    @property
    def evaluator(self) -> Callable[..., None]:
        """The fixed pose."""
        return _evaluate

    @property
    def time_scale(self) -> float:
        """Infinite [s]."""
        return math.inf
