"""The null object of motion: a fixed pose."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.engine.memory.blocks import ROTATION
from nonsmooth.interfaces import Motion
from nonsmooth.parameters import Value, parameter

from ..blocks import pose_of, stand_still
from ..values import check_fields


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
    time_scale = math.inf
    evaluator: ClassVar[Callable[..., None]] = staticmethod(stand_still)

    def _check(self) -> None:
        check_fields(self, "position", "orientation")

    def parameters(self) -> Mapping[str, Value]:
        """Return the pose on the slope: position [m] and rotation matrix."""
        c, s = math.cos(self.slope), math.sin(self.slope)
        pose = list(pose_of(self.position, self.orientation))
        for i in (ROTATION, ROTATION + 3, ROTATION + 6):
            pose[i], pose[i + 2] = pose[i] * c - pose[i + 2] * s, pose[i] * s + pose[i + 2] * c
        return {"pose": tuple(pose)}
