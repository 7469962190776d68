"""The null object of motion: a fixed pose."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.interfaces import Motion
from nonsmooth.parameters import parameter
from nonsmooth.types import Floats


def _evaluate(
    t: float,
    q: Floats,
    u: Floats,
    out: Floats,
    slope: float,
) -> None:
    c, s = math.cos(slope), math.sin(slope)
    out[3], out[4], out[5] = c, 0.0, s
    out[6], out[7], out[8] = 0.0, 1.0, 0.0
    out[9], out[10], out[11] = -s, 0.0, c


@final
@dataclass(frozen=True)
class Rest(Motion):
    """No motion: the frame stays at the origin, turned about the second axis so that its first axis points downhill."""

    slope: float = parameter(0.0, doc="angle of the slope", unit="rad", minimum=-math.pi / 2, maximum=math.pi / 2)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The fixed pose."""
        return _evaluate

    @property
    def time_scale(self) -> float:
        """Infinite [s]."""
        return math.inf
