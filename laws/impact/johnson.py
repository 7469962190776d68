"""Restitution of elastic-plastic spheres, which falls with the fourth root of the approach speed."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.parameters import parameter

from .power import PowerProcess, duration_parameter, exponent_parameter, stiffness_parameter


def johnson_restitution(speed: float, elastic_speed: float) -> float:
    """Return e = (v_1 / v)^(1/4) at the approach speed v [m/s], 1 up to v_1 [m/s]."""
    return 1.0 if speed <= elastic_speed else math.sqrt(math.sqrt(elastic_speed / speed))


def johnson_speed(mass: float, radius: float, modulus: float, pressure: float) -> float:
    """Return the speed v_1 [m/s] at which e^2 = 3 pi^(5/4) 4^(3/4) / 10 (p_d / E*) (m* v^2 / (2 p_d R*^3))^(-1/4) is 1.

    Parameters
    ----------
    mass : float
        Effective mass m* [kg].
    radius : float
        Effective radius R* [m].
    modulus : float
        Effective modulus E* [Pa].
    pressure : float
        Dynamic pressure p_d of plastic flow [Pa], about 3 times the yield stress.

    References
    ----------
    K. L. Johnson, *Contact Mechanics*, Cambridge University Press (1985), section 11.5.
    """
    factor = 0.3 * math.pi**1.25 * 4.0**0.75 * pressure / modulus
    return float(factor**2 * math.sqrt(2.0 * pressure * radius**3 / mass))


def _efficiency(rate: float, elastic_speed: float) -> float:
    # e d(v e)/dv at the speed v whose rebound v e is the rate
    return 1.0 if rate <= elastic_speed else 0.75 * (elastic_speed / rate) ** (2.0 / 3.0)


@final
@dataclass(frozen=True)
class JohnsonImpact(PowerProcess):
    """Plastic flow: e = (v_1 / v)^(1/4) above the speed v_1, elastic below; v_1 is :func:`johnson_speed`.

    The efficiency of the expansion depends on its own rate such that a contact by itself, without coupling of normal
    and slip, leaves with just e v.  With coupling, or among other contacts, the same efficiency holds all along the
    expansion; energy is never gained.  The real law bends smoothly to the fourth root, from 1 at the speed of first
    yield, far below v_1.

    References
    ----------
    K. L. Johnson, *Contact Mechanics*, Cambridge University Press (1985), section 11.5.
    """

    elastic_speed: float = parameter(
        0.02, doc="approach speed v_1 up to which e = 1", unit="m/s", above=0.0, usual=(1e-7, 1e3)
    )
    stiffness: float = stiffness_parameter()
    exponent: float = exponent_parameter()
    duration: float = duration_parameter()

    @property
    def efficiency(self) -> Callable[..., float]:
        """1 for slow expansion, 3/4 (v_1 / rate)^(2/3) above v_1."""
        return _efficiency

    def is_fulfilled(self, stored: float, returned: float, tolerance: float) -> bool:
        """Tell whether no more energy [J] came back than went in."""
        return -tolerance <= returned <= stored + tolerance
