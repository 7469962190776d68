"""Harmonic vibration along an axis."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.engine.memory.blocks import ACCELERATION, POSITION, ROTATION, VELOCITY
from nonsmooth.interfaces import Motion
from nonsmooth.parameters import Value, parameter
from nonsmooth.types import Floats
from nonsmooth.vectors import UNIT_PART, unit_vector


def _evaluate(
    t: float, q: Floats, u: Floats, out: Floats, amplitude: float, frequency: float, phase: float, axis: Floats
) -> None:
    omega = 2.0 * math.pi * frequency
    angle = omega * t + phase
    displacement = amplitude * math.sin(angle)
    velocity = amplitude * omega * math.cos(angle)
    acceleration = -omega * omega * displacement
    for i in range(3):
        out[POSITION + i], out[ROTATION + 4 * i] = displacement * axis[i], 1.0
        out[VELOCITY + i], out[ACCELERATION + i] = velocity * axis[i], acceleration * axis[i]


@final
@dataclass(frozen=True)
class Harmonic(Motion):
    """z_p = A_z sin(2 pi f t + phi_0) along a fixed unit axis, Eq. (1)."""

    amplitude: float = parameter(doc="amplitude A_z", unit="m", minimum=0.0, usual=(1e-7, 1.0))
    frequency: float = parameter(doc="frequency f", unit="Hz", above=0.0, usual=(1e-2, 1e4))
    phase: float = parameter(0.0, doc="initial phase phi_0", unit="rad", usual=(0.0, 2.0 * math.pi))
    axis_x: float = parameter(0.0, doc="axis of the vibration, first component", **UNIT_PART)
    axis_y: float = parameter(0.0, doc="axis of the vibration, second component", **UNIT_PART)
    axis_z: float = parameter(1.0, doc="axis of the vibration, third component", **UNIT_PART)
    evaluator: ClassVar[Callable[..., None]] = staticmethod(_evaluate)

    def _check(self) -> None:
        self.parameters()

    def parameters(self) -> Mapping[str, Value]:
        """Return amplitude [m], frequency [Hz], phase [rad], and the axis, normalised to unit length."""
        axis = unit_vector("Harmonic axis", (self.axis_x, self.axis_y, self.axis_z))
        return {"amplitude": self.amplitude, "frequency": self.frequency, "phase": self.phase, "axis": axis}

    @property
    def time_scale(self) -> float:
        """The period [s]."""
        return self.period

    @property
    def period(self) -> float:
        """The period [s]."""
        return 1.0 / self.frequency
