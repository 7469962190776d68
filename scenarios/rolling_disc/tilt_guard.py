"""Guard that ends a run when a disc has come down to a given tilt."""

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
    """A guard that ends the run when the tilt of the only free body of a system falls to ``tilt``."""

    tilt: float = parameter(doc="tilt that ends the run", unit="rad", above=0.0, maximum=math.pi / 2)

    @property
    def value(self) -> Callable[..., float]:
        """Sine of the tilt minus the sine of the tilt that ends the run."""
        return _value

    @property
    def ends_run(self) -> bool:
        """Always."""
        return True
