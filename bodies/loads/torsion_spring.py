"""Torsion spring and damper about an axis."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import final

from nonsmooth.engine.memory.blocks import LOAD_MOMENT, LOAD_POINT, ROTATION, SPIN
from nonsmooth.interfaces import Load
from nonsmooth.parameters import Value, parameter
from nonsmooth.types import Floats
from nonsmooth.vectors import perpendiculars, unit_vector


def _evaluate(
    t: float,
    a: Floats,
    b: Floats,
    out: Floats,
    axis: Floats,
    side: Floats,
    other_side: Floats,
    stiffness: float,
    damping: float,
    angle: float,
) -> None:
    along = across = rate = 0.0
    for i in range(3):
        r = ROTATION + 3 * i
        out[i] = 0.0
        out[LOAD_POINT + i] = b[i]
        side_a = a[r] * side[0] + a[r + 1] * side[1] + a[r + 2] * side[2]
        other_a = a[r] * other_side[0] + a[r + 1] * other_side[1] + a[r + 2] * other_side[2]
        side_b = b[r] * side[0] + b[r + 1] * side[1] + b[r + 2] * side[2]
        out[LOAD_MOMENT + i] = a[r] * axis[0] + a[r + 1] * axis[1] + a[r + 2] * axis[2]
        along += side_a * side_b
        across += other_a * side_b
        rate += (b[SPIN + i] - a[SPIN + i]) * out[LOAD_MOMENT + i]
    moment = -stiffness * (math.atan2(across, along) - angle) - damping * rate
    for i in range(3):
        out[LOAD_MOMENT + i] *= moment


@final
@dataclass(frozen=True)
class TorsionSpring(Load):
    """M = -k (phi - phi0) - c phi' about an axis that both bodies share, phi within half a turn.

    Attributes
    ----------
    axis : tuple of float
        Unit vector of the axis in the frame of either body, shape [3].
    """

    stiffness: float = parameter(doc="stiffness k", unit="N m/rad", minimum=0.0)
    damping: float = parameter(0.0, doc="damping c", unit="N m s/rad", minimum=0.0)
    angle: float = parameter(0.0, doc="angle phi0 without moment", unit="rad", minimum=-math.pi, maximum=math.pi)
    axis: tuple[float, float, float] = (0.0, 1.0, 0.0)

    def _check(self) -> None:
        self.parameters()

    def parameters(self) -> Mapping[str, Value]:
        """Return constants and axes."""
        axis = unit_vector("TorsionSpring.axis", self.axis)
        side, other_side = perpendiculars(axis)
        return {**self.numbers(), "axis": axis, "side": side, "other_side": other_side}

    @property
    def depends_on_time(self) -> bool:
        """No."""
        return False

    @property
    def evaluator(self) -> Callable[..., None]:
        """Force, point and moment."""
        return _evaluate
