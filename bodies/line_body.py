"""LineBody: slides along a line without turning."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from bodies.blocks import put
from bodies.carried import check_carried
from bodies.motions.pose import pose_parameters
from bodies.values import Word, read_start, unit_quaternion, unit_vector, vector
from nonsmooth.engine.memory.blocks import FRAME, JACOBIAN, POSITION, ROTATION, VELOCITY
from nonsmooth.interfaces import Body, Shape
from nonsmooth.interfaces.body import NamesAndUnits, Vector
from nonsmooth.parameters import parameter
from nonsmooth.types import Floats

_WORDS: dict[str, Word] = {"position": (0, 0.0, "m"), "velocity": (0, 0.0, "m/s")}
_RATES = FRAME + 6 * 1
"""Where the coordinate rates stand in the output block,"""
_FORCE = _RATES + 1
"""the forces,"""
_INVERSE = _FORCE + 1
"""the inverse mass matrix,"""
_ENERGY = _INVERSE + 1
"""and the energies."""


def _evaluate(
    t: float,
    q: Floats,
    u: Floats,
    out: Floats,
    mass: float,
    direction_x: float,
    direction_y: float,
    direction_z: float,
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
    gravity_x: float,
    gravity_y: float,
    gravity_z: float,
) -> None:
    put(out, POSITION, x + direction_x * q[0], y + direction_y * q[0], z + direction_z * q[0])
    put(out, ROTATION, xx, xy, xz)
    put(out, ROTATION + 3, yx, yy, yz)
    put(out, ROTATION + 6, zx, zy, zz)
    put(out, VELOCITY, direction_x * u[0], direction_y * u[0], direction_z * u[0])
    put(out, JACOBIAN, direction_x, direction_y, direction_z)
    out[_RATES] = u[0]
    out[_FORCE] = mass * (gravity_x * direction_x + gravity_y * direction_y + gravity_z * direction_z)
    out[_INVERSE] = 1.0 / mass
    out[_ENERGY] = 0.5 * mass * u[0] * u[0]
    out[_ENERGY + 1] = -mass * (
        gravity_x * out[POSITION] + gravity_y * out[POSITION + 1] + gravity_z * out[POSITION + 2]
    )


@final
@dataclass(frozen=True)
class LineBody(Body):
    """A rigid body that slides along a fixed line, as in a frictionless guide, and does not turn.

    Its coordinate is the distance along the line [m], its velocity the rate of it.

    Attributes
    ----------
    mass : float
        Mass [kg].
    direction : tuple of float
        Unit vector of the line, in world axes.
    carried : tuple of Shape
        Its shapes, in axes with the origin on the line.
    origin : tuple of float
        Where on the line the coordinate is zero [m, shape (3)].
    orientation : tuple of float
        Unit quaternion (scalar first) from its axes to the world's.
    """

    mass: float = parameter(doc="mass", unit="kg", above=0.0)
    direction: tuple[float, float, float] = (0.0, 0.0, 1.0)
    carried: tuple[Shape, ...] = ()
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    orientation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)

    def _check(self) -> None:
        values = {
            "direction": unit_vector("LineBody.direction", self.direction),
            "origin": vector("LineBody.origin", self.origin, 3, "m"),
            "orientation": unit_quaternion("LineBody.orientation", self.orientation),
        }
        for name, value in values.items():
            object.__setattr__(self, name, tuple(value.tolist()))
        object.__setattr__(self, "carried", check_carried("LineBody.carried", self.carried))

    def parameters(self) -> dict[str, float]:
        """Return mass, direction and the pose at the origin."""
        direction = {f"direction_{letter}": x for letter, x in zip("xyz", self.direction, strict=True)}
        return {"mass": float(self.mass)} | direction | pose_parameters(self.origin, self.orientation)

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        """One frame with the shapes as given."""
        return (self.carried,)

    @property
    def q_labels(self) -> NamesAndUnits:
        """The distance along the line."""
        return (("s", "m"),)

    @property
    def u_labels(self) -> NamesAndUnits:
        """Its rate."""
        return (("v", "m/s"),)

    @property
    def quaternion(self) -> int:
        """None."""
        return -1

    @property
    def evaluator(self) -> Callable[..., None]:
        """Newton's equation along the line."""
        return _evaluate

    @property
    def time_scale(self) -> float:
        """Infinite [s]: nothing is prescribed."""
        return math.inf

    @property
    def scales(self) -> tuple[Vector, Vector]:
        """The length of the body, 1 m without shapes, and the speed of a fall through it."""
        length = max((shape.length for shape in self.carried), default=0.0) or 1.0
        return np.array([length]), np.array([math.sqrt(9.81 * length)])

    def state(self, **start: Any) -> tuple[Vector, Vector]:
        """Return q and u from position [m] and velocity [m/s], both along the line."""
        values = read_start("LineBody", _WORDS, start)
        return np.array([values["position"]]), np.array([values["velocity"]])
