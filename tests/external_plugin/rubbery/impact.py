"""Restitution that falls with the rate of expansion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.interfaces import ImpactProcess
from nonsmooth.parameters import parameter


def _force(indentation: float, stiffness: float) -> float:
    return stiffness * indentation


def _efficiency(rate: float, restitution: float, fall_speed: float) -> float:
    return 1.0 if rate <= 0.0 else restitution * restitution / (1.0 + rate / fall_speed)


@final
@dataclass(frozen=True)
class Softening(ImpactProcess):
    """Slow impacts return the share e^2 of the stored energy, fast ones less."""

    restitution: float = parameter(0.8, doc="restitution of slow impacts", minimum=0.0, maximum=1.0)
    fall_speed: float = parameter(1.0, doc="rate that halves the efficiency", unit="m/s", above=0.0)
    stiffness: float = parameter(1.0, doc="stiffness relative to other contacts", unit="N/m", above=0.0)
    duration: float = parameter(2e-5, doc="contact time of rule (33)", unit="s", minimum=0.0)

    @property
    def force(self) -> Callable[..., float]:
        """A linear spring."""
        return _force

    @property
    def efficiency(self) -> Callable[..., float]:
        """The share of stored energy that comes back."""
        return _efficiency

    @property
    def contact_time(self) -> float:
        """The parameter ``duration`` [s]."""
        return self.duration

    def is_fulfilled(self, stored: float, returned: float, tolerance: float) -> bool:
        """Tell whether no more than e^2 of the energy came back."""
        return -tolerance <= returned <= self.restitution**2 * stored + tolerance
