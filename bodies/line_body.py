"""LineBody: slides along a line without turning."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np

from nonsmooth.engine.memory.blocks import JACOBIAN, POSITION, VELOCITY
from nonsmooth.interfaces import Body, Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import Value, parameter
from nonsmooth.types import Floats

from .blocks import places_behind_frame, pose_of, write_pose
from .values import Word, check_fields, keep_carried, read_start

_WORDS: dict[str, Word] = {"position": (0, 0.0, "m"), "velocity": (0, 0.0, "m/s")}
_RATES, _FORCE, _INVERSE, _ENERGY = places_behind_frame(n_q=1, n_u=1)
"""Indices of coordinate rates, force, inverse mass matrix and energies in the output block, in this order."""


def _evaluate(
    t: float,
    q: Floats,
    u: Floats,
    out: Floats,
    mass: float,
    direction: Floats,
    pose: Floats,
    gravity_x: float,
    gravity_y: float,
    gravity_z: float,
) -> None:
    write_pose(out, pose)
    for i in range(3):
        out[POSITION + i] += direction[i] * q[0]
        out[VELOCITY + i] = direction[i] * u[0]
        out[JACOBIAN + i] = direction[i]
    out[_RATES] = u[0]
    out[_FORCE] = mass * (gravity_x * direction[0] + gravity_y * direction[1] + gravity_z * direction[2])
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
    q_labels, u_labels = (("s", "m"),), (("v", "m/s"),)
    evaluator: ClassVar[Callable[..., None]] = staticmethod(_evaluate)

    def _check(self) -> None:
        check_fields(self, "direction", "origin", "orientation")
        keep_carried(self)

    def parameters(self) -> Mapping[str, Value]:
        """Return mass, direction and the pose at the origin."""
        pose = pose_of(self.origin, self.orientation)
        return {"mass": float(self.mass), "direction": self.direction, "pose": pose}

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        """One frame with the shapes as given."""
        return (self.carried,)

    def state(self, **start: Any) -> tuple[Vector, Vector]:
        """Return q and u from position [m] and velocity [m/s], both along the line."""
        values = read_start("LineBody", _WORDS, start)
        return np.array([values["position"]]), np.array([values["velocity"]])
