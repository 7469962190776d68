"""What the impact laws with a force k x^eta have in common, and the contact time of them all."""

from __future__ import annotations

import math
from abc import ABC
from collections.abc import Callable
from typing import Any

from nonsmooth.interfaces import ImpactProcess
from nonsmooth.parameters import parameter


def power_force(indentation: float, stiffness: float, exponent: float) -> float:
    """Return k x^eta [N], Eq. (20)."""
    if exponent == 1.5:
        # Hertz, where a square root is cheaper than a power
        return stiffness * indentation * math.sqrt(indentation)
    return float(stiffness * indentation**exponent)


def stiffness_parameter() -> Any:
    """Return the field ``stiffness`` [N/m^eta] of a law, whose ratios alone matter where all exponents are equal."""
    return parameter(
        1.0, doc="contact stiffness k of F = k x^eta, relative to the other contacts", unit="N/m^eta", above=0.0
    )


def exponent_parameter() -> Any:
    """Return the field ``exponent`` of a law."""
    return parameter(1.5, doc="exponent eta of F = k x^eta (3/2 Hertz, 1 linear)", minimum=1.0, maximum=10.0)


def duration_parameter() -> Any:
    """Return the field ``duration`` [s] of a law."""
    return parameter(
        2e-5, doc="contact time T_c of the accumulation rule (33)", unit="s", minimum=0.0, usual=(1e-12, 1e-2)
    )


class PowerProcess(ImpactProcess, ABC):
    """An impact process with the force k x^eta; its laws have the fields stiffness, exponent and duration."""

    duration: float

    @property
    def force(self) -> Callable[..., float]:
        """K x^eta, Eq. (20), in both phases."""
        return power_force

    @property
    def contact_time(self) -> float:
        """The parameter ``duration`` [s]."""
        return self.duration
