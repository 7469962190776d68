"""Translation and rotation at constant rates: a conveyor belt, a turntable, a slope that tilts."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.engine.memory.blocks import ACCELERATION, POSITION, ROTATION, SPIN, VELOCITY
from nonsmooth.interfaces import Motion
from nonsmooth.parameters import Value, parameter
from nonsmooth.types import Floats

from ..blocks import pose_of
from ..values import check_fields
from ..vectors import write_vector


def _evaluate(
    t: float,
    q: Floats,
    u: Floats,
    out: Floats,
    rate: float,
    velocity: Floats,
    axis: Floats,
    centre: Floats,
    pose: Floats,
) -> None:
    angle, (x, y, z) = rate * t, (axis[0], axis[1], axis[2])
    c, s, half = math.cos(angle), math.sin(angle), math.sin(0.5 * angle)
    d = 2.0 * half * half
    # rotation by the angle about the axis, row by row
    r00, r01, r02 = c + d * x * x, d * x * y - s * z, d * x * z + s * y
    r10, r11, r12 = d * x * y + s * z, c + d * y * y, d * y * z - s * x
    r20, r21, r22 = d * x * z - s * y, d * y * z + s * x, c + d * z * z
    for i in range(ROTATION, ROTATION + 3):
        e, f, g = pose[i], pose[i + 3], pose[i + 6]
        out[i] = r00 * e + r01 * f + r02 * g
        out[i + 3] = r10 * e + r11 * f + r12 * g
        out[i + 6] = r20 * e + r21 * f + r22 * g
    ax, ay, az = pose[0] - centre[0], pose[1] - centre[1], pose[2] - centre[2]
    bx, by, bz = r00 * ax + r01 * ay + r02 * az, r10 * ax + r11 * ay + r12 * az, r20 * ax + r21 * ay + r22 * az
    ox, oy, oz = rate * x, rate * y, rate * z
    # velocity omega x offset and acceleration omega x (omega x offset) about the moving centre
    wx, wy, wz = oy * bz - oz * by, oz * bx - ox * bz, ox * by - oy * bx
    write_vector(out, POSITION, (bx, by, bz))
    write_vector(out, VELOCITY, (wx, wy, wz))
    # add the motion of the centre
    for i in range(3):
        out[POSITION + i] += centre[i] + velocity[i] * t
        out[VELOCITY + i] += velocity[i]
    write_vector(out, SPIN, (ox, oy, oz))
    write_vector(out, ACCELERATION, (oy * wz - oz * wy, oz * wx - ox * wz, ox * wy - oy * wx))


@final
@dataclass(frozen=True)
class ConstantVelocity(Motion):
    """The frame moves with a constant velocity and turns at a constant rate about a fixed direction.

    Attributes
    ----------
    velocity : tuple of float
        Velocity of the centre of the turn [m/s, shape (3)].
    rate : float
        Rate of the turn [rad/s].
    axis : tuple of float
        Unit vector about which it turns, in world axes.
    position : tuple of float
        Origin of the frame at t = 0 [m, shape (3)].
    orientation : tuple of float
        Unit quaternion (scalar first) of the frame at t = 0.
    centre : tuple of float, optional
        Point at t = 0 that the axis passes through [m, shape (3)]; by default the origin of the frame.

    Raises
    ------
    InvalidInput
        If a vector has not three numbers, or the axis or the quaternion not unit length.
    """

    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rate: float = parameter(0.0, doc="rate of the turn", unit="rad/s")
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    orientation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    centre: tuple[float, float, float] | None = None
    evaluator: ClassVar[Callable[..., None]] = staticmethod(_evaluate)

    def _check(self) -> None:
        if self.centre is None:
            object.__setattr__(self, "centre", self.position)
        check_fields(self, "velocity", "axis", "position", "orientation", "centre")

    def parameters(self) -> Mapping[str, Value]:
        """Return rate, velocity, axis, centre, and the pose at t = 0."""
        return {
            "rate": float(self.rate),
            "velocity": self.velocity,
            "axis": self.axis,
            "centre": self.centre or self.position,
            "pose": pose_of(self.position, self.orientation),
        }

    @property
    def time_scale(self) -> float:
        """The time of one turn [s]; infinite without a turn."""
        return 2.0 * math.pi / abs(self.rate) if self.rate != 0.0 else math.inf
