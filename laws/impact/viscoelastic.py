"""Restitution of viscoelastic spheres, which starts from 1 and falls with the approach speed."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.compiled import compiled
from nonsmooth.parameters import parameter

from .hertz import hertz_stiffness
from .power import PowerProcess, duration_parameter, exponent_parameter, stiffness_parameter

_C1 = 0.501086
_B2, _B3, _B4 = 1.15345, 0.577977, 0.532178
"""Coefficients of the published approximant."""


@compiled
def _restitution(s: float) -> float:
    return (1.0 + _C1 * s) / (1.0 + s * (_C1 + s * (_B2 + s * (_B3 + s * _B4))))


@compiled
def _slope(s: float) -> float:
    """D(ln e) / d(ln s)."""
    below = 1.0 + s * (_C1 + s * (_B2 + s * (_B3 + s * _B4)))
    return _C1 * s / (1.0 + _C1 * s) - s * (_C1 + s * (2.0 * _B2 + s * (3.0 * _B3 + s * 4.0 * _B4))) / below


def viscoelastic_restitution(speed: float, reference_speed: float) -> float:
    """Return e at the approach speed v [m/s]: 1 - 1.15345 s^2 + ..., s = (v / v_1)^(1/10)."""
    return float(_restitution((speed / reference_speed) ** 0.1))


def viscoelastic_speed(mass: float, radius: float, modulus: float, dissipation: float) -> float:
    """Return the speed v_1 = beta^-5 [m/s], beta = 3/2 A (k / m*)^(2/5) with Hertz's stiffness k.

    Parameters
    ----------
    mass : float
        Effective mass m* [kg].
    radius : float
        Effective radius R* [m].
    modulus : float
        Effective modulus E* [Pa].
    dissipation : float
        Constant A of the force k (x^(3/2) + 3/2 A sqrt(x) dx/dt) [s].
    """
    return float((1.5 * dissipation) ** -5 * (mass / hertz_stiffness(radius, modulus)) ** 2)


def _efficiency(rate: float, reference_speed: float) -> float:
    if rate <= 0.0:
        return 1.0
    # Newton's method for the speed v whose rebound v e is the rate, in logarithms
    wanted = math.log(rate / reference_speed)
    log_s = 0.1 * wanted
    for _iteration in range(20):
        s = math.exp(log_s)
        change = (10.0 * log_s + math.log(_restitution(s)) - wanted) / (10.0 + _slope(s))
        log_s -= change
        if abs(change) < 1e-15:
            break
    s = math.exp(log_s)
    e = _restitution(s)
    return float(e * e * (1.0 + 0.1 * _slope(s)))


@final
@dataclass(frozen=True)
class ViscoelasticImpact(PowerProcess):
    """Spheres with the force k (x^(3/2) + 3/2 A sqrt(x) dx/dt), never pulling: e falls from 1 as 1 - C (v / v_1)^(1/5).

    With s = (v / v_1)^(1/10), e = (1 + c_1 s) / (1 + c_1 s + b_2 s^2 + b_3 s^3 + b_4 s^4); v_1 is
    :func:`viscoelastic_speed`, and e(v_1) = 0.40.  That is within 0.005 of the integrated force up to v_1, within
    0.009 up to 100 v_1.

    The efficiency of the expansion depends on its own rate such that a contact by itself, without coupling of normal
    and slip, leaves with just e v.  With coupling, or among other contacts, the same efficiency holds all along the
    expansion; energy is never gained.

    References
    ----------
    T. Schwager, T. Pöschel, "Coefficient of normal restitution of viscous particles and cooling rate of granular
    gases", Phys. Rev. E 57 (1998) 650-654.

    P. Müller, T. Pöschel, "Collision of viscoelastic spheres: Compact expressions for the coefficient of normal
    restitution", Phys. Rev. E 84 (2011) 021302.
    """

    reference_speed: float = parameter(
        1.0, doc="approach speed v_1 at which e = 0.40", unit="m/s", above=0.0, usual=(1e-9, 1e12)
    )
    stiffness: float = stiffness_parameter()
    exponent: float = exponent_parameter()
    duration: float = duration_parameter()

    @property
    def efficiency(self) -> Callable[..., float]:
        """E d(v e)/dv at the speed v whose rebound v e is the rate."""
        return _efficiency

    def is_fulfilled(self, stored: float, returned: float, tolerance: float) -> bool:
        """Tell whether no more energy [J] came back than went in."""
        return -tolerance <= returned <= stored + tolerance
