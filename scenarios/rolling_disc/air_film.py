"""Load of the air between a disc and the table: a moment against the relative angular velocity."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.engine.memory.blocks import FORCE, LOAD_MOMENT, LOAD_POINT, ROTATION, SPIN
from nonsmooth.interfaces import Load
from nonsmooth.parameters import parameter
from nonsmooth.types import Floats

_NORMAL = ROTATION + 2
"""Index of the x component of a body's third axis in its block; y and z follow in steps of 3."""


def _evaluate(t: float, a: Floats, b: Floats, out: Floats, viscosity: float, radius: float) -> None:
    ax, ay, az = a[_NORMAL], a[_NORMAL + 3], a[_NORMAL + 6]
    bx, by, bz = b[_NORMAL], b[_NORMAL + 3], b[_NORMAL + 6]
    x, y, z = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    sine = math.sqrt(x * x + y * y + z * z)
    drag = 0.25 * math.pi * viscosity * (radius / sine) ** 3
    for i in range(3):
        out[FORCE + i] = 0.0
        out[LOAD_POINT + i] = b[i]
        out[LOAD_MOMENT + i] = -drag * (b[SPIN + i] - a[SPIN + i])


@final
@dataclass(frozen=True)
class AirFilm(Load):
    """Moment -c omega of the air layer between a rolling disc and the table [N m].

    The coefficient is c = (pi / 4) viscosity (radius / sin alpha)^3 [N m s].  alpha is the angle between disc and
    table, omega the angular velocity of the disc relative to the table.  In steady rolling with small alpha, the moment
    dissipates the power of Moffatt's theory, pi viscosity g radius^2 / alpha^2.  The formula is valid for this motion
    only.  c is infinite for a disc that lies flat.

    References
    ----------
    H. K. Moffatt, "Euler's disk and its finite-time singularity", Nature 404 (2000) 833-834.
    """

    viscosity: float = parameter(doc="viscosity of the air", unit="Pa s", minimum=0.0)
    radius: float = parameter(doc="radius of the disc", unit="m", above=0.0)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The moment, at the centre of the disc."""
        return _evaluate
