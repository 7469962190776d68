"""OpenBox: a floor and four walls at rest."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.interfaces import Shape
from nonsmooth.parameters import Value, parameter
from nonsmooth.rotations import rotation
from nonsmooth.types import Floats

from .blocks import POSE
from .prescribed import Prescribed
from .shapes.plane import Plane
from .values import check_fields

_PLANES = 5


def _evaluate(t: float, q: Floats, u: Floats, out: Floats, poses: Floats) -> None:
    for plane in range(_PLANES):
        for i in range(POSE):
            out[FRAME * plane + i] = poses[POSE * plane + i]


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
    evaluator: ClassVar[Callable[..., None]] = staticmethod(_evaluate)

    def _check(self) -> None:
        check_fields(self, "position", "orientation")

    def parameters(self) -> Mapping[str, Value]:
        """Return the poses of floor and walls; the third axis of a wall is the normal to the inside."""
        place, (a, b, c) = np.array(self.position), rotation(self.orientation).T
        planes = (
            (place, a, b, c),
            (place - self.half_x * a, b, c, a),
            (place + self.half_x * a, c, b, -a),
            (place - self.half_y * b, c, a, b),
            (place + self.half_y * b, a, c, -b),
        )
        return {"poses": tuple(x for middle, *axes in planes for x in (*middle.tolist(), *np.transpose(axes).flat))}

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        """Five frames, each with the plane through its origin."""
        return ((Plane(),),) * _PLANES
