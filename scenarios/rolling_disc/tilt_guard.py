"""Ends a run when the disc has come down to a given tilt."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.interfaces import Guard
from nonsmooth.parameters import parameter
from nonsmooth.types import Floats


def _value(t: float, q: Floats, u: Floats, tilt: float) -> float:
    # the horizontal part of the third body axis, out of the unit quaternion
    x, y = 2.0 * (q[4] * q[6] + q[3] * q[5]), 2.0 * (q[5] * q[6] - q[3] * q[4])
    return math.sqrt(x * x + y * y) - math.sin(tilt)


@final
@dataclass(frozen=True)
class TiltGuard(Guard):
    """Falls through zero where the only free body of a system is tilted by no more than ``tilt``."""

    tilt: float = parameter(doc="tilt that ends the run", unit="rad", above=0.0, maximum=math.pi / 2)

    @property
    def value(self) -> Callable[..., float]:
        """Sine of the tilt over that of the end."""
        return _value

    @property
    def ends_run(self) -> bool:
        """Always."""
        return True
