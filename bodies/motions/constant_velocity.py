"""Translation and rotation at constant rates: a conveyor belt, a turntable, a slope that tilts."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from bodies.blocks import put
from bodies.motions.pose import pose_parameters
from bodies.values import unit_quaternion, unit_vector, vector
from nonsmooth.engine.memory.blocks import ACCELERATION, POSITION, ROTATION, SPIN, VELOCITY
from nonsmooth.interfaces import Motion
from nonsmooth.parameters import parameter
from nonsmooth.types import Floats


def _evaluate(
    t: float,
    q: Floats,
    u: Floats,
    out: Floats,
    rate: float,
    velocity_x: float,
    velocity_y: float,
    velocity_z: float,
    axis_x: float,
    axis_y: float,
    axis_z: float,
    centre_x: float,
    centre_y: float,
    centre_z: float,
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
    angle = rate * t
    c, s, half = math.cos(angle), math.sin(angle), math.sin(0.5 * angle)
    d = 2.0 * half * half
    # rotation by the angle about the axis, row by row
    r00, r01, r02 = c + d * axis_x * axis_x, d * axis_x * axis_y - s * axis_z, d * axis_x * axis_z + s * axis_y
    r10, r11, r12 = d * axis_x * axis_y + s * axis_z, c + d * axis_y * axis_y, d * axis_y * axis_z - s * axis_x
    r20, r21, r22 = d * axis_x * axis_z - s * axis_y, d * axis_y * axis_z + s * axis_x, c + d * axis_z * axis_z
    put(out, ROTATION, r00 * xx + r01 * yx + r02 * zx, r00 * xy + r01 * yy + r02 * zy, r00 * xz + r01 * yz + r02 * zz)
    put(
        out,
        ROTATION + 3,
        r10 * xx + r11 * yx + r12 * zx,
        r10 * xy + r11 * yy + r12 * zy,
        r10 * xz + r11 * yz + r12 * zz,
    )
    put(
        out,
        ROTATION + 6,
        r20 * xx + r21 * yx + r22 * zx,
        r20 * xy + r21 * yy + r22 * zy,
        r20 * xz + r21 * yz + r22 * zz,
    )
    ax, ay, az = x - centre_x, y - centre_y, z - centre_z
    bx, by, bz = r00 * ax + r01 * ay + r02 * az, r10 * ax + r11 * ay + r12 * az, r20 * ax + r21 * ay + r22 * az
    ox, oy, oz = rate * axis_x, rate * axis_y, rate * axis_z
    # velocity omega x arm and acceleration omega x (omega x arm) about the moving centre
    wx, wy, wz = oy * bz - oz * by, oz * bx - ox * bz, ox * by - oy * bx
    put(out, POSITION, centre_x + velocity_x * t + bx, centre_y + velocity_y * t + by, centre_z + velocity_z * t + bz)
    put(out, VELOCITY, velocity_x + wx, velocity_y + wy, velocity_z + wz)
    put(out, SPIN, ox, oy, oz)
    put(out, ACCELERATION, oy * wz - oz * wy, oz * wx - ox * wz, ox * wy - oy * wx)


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

    def _check(self) -> None:
        centre = self.position if self.centre is None else self.centre
        values = {
            "velocity": vector("ConstantVelocity.velocity", self.velocity, 3, "m/s"),
            "axis": unit_vector("ConstantVelocity.axis", self.axis),
            "position": vector("ConstantVelocity.position", self.position, 3, "m"),
            "orientation": unit_quaternion("ConstantVelocity.orientation", self.orientation),
            "centre": vector("ConstantVelocity.centre", centre, 3, "m"),
        }
        for name, value in values.items():
            object.__setattr__(self, name, tuple(value.tolist()))

    def parameters(self) -> dict[str, float]:
        """Return rate, velocity, axis, centre, and the pose at t = 0."""
        numbers = {"rate": float(self.rate)}
        for name, value in (("velocity", self.velocity), ("axis", self.axis), ("centre", self.centre or self.position)):
            numbers |= {f"{name}_{letter}": x for letter, x in zip("xyz", value, strict=True)}
        return numbers | pose_parameters(self.position, self.orientation)

    @property
    def evaluator(self) -> Callable[..., None]:
        """Pose, velocities and accelerations of the frame."""
        return _evaluate

    @property
    def time_scale(self) -> float:
        """The time of one turn [s]; infinite without a turn."""
        return 2.0 * math.pi / abs(self.rate) if self.rate != 0.0 else math.inf
