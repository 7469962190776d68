"""Closed forms for a uniform block of base L and height H that rocks without slip and does not bounce (e = 0).

The block turns about one lower corner until the other strikes.  Then nothing but the impulse at the striking corner
acts, so the angular momentum about it is kept.  With tan alpha = L / H:

- the corner that leaves rises at once, for sin^2(alpha) < 2/3, and takes no impulse whatever its law is;
- the striking corner does not slip if the friction is at least :func:`least_friction`.

References
----------
G. W. Housner, "The behavior of inverted pendulum structures during earthquakes", Bull. Seismol. Soc. Am. 53 (1963)
403-417.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def slenderness(base: float, height: float) -> float:
    """Return the angle alpha between a side and the diagonal [rad]."""
    return math.atan2(base, height)


def velocity_ratio(alpha: float) -> float:
    """Return omega+ / omega- = 1 - 3/2 sin^2(alpha); 0 where it would be negative, as the block stops."""
    return max(0.0, 1.0 - 1.5 * math.sin(alpha) ** 2)


def frictionless_ratio(alpha: float) -> float:
    """Return omega+ / omega- of a frictionless block, 1 - 6 t^2 / (1 + 4 t^2) with t = tan(alpha) < 1 / sqrt(2)."""
    square = math.tan(alpha) ** 2
    return 1.0 - 6.0 * square / (1.0 + 4.0 * square)


def least_friction(alpha: float) -> float:
    """Return the ratio of tangential to normal impulse that no slip needs, 3 t / (4 + t^2) with t = tan(alpha)."""
    tangent = math.tan(alpha)
    return 3.0 * tangent / (4.0 + tangent**2)


def quarter_period(alpha: float, tilt: float, diagonal: float, gravity: float = 9.81) -> float:
    """Return the time from rest at ``tilt`` to the first impact for a slender block.

    It is (1/p) arcosh(1 / (1 - tilt / alpha)), p^2 = 3 g / (4 R), R half of the ``diagonal`` [m].
    """
    return math.acosh(1.0 / (1.0 - tilt / alpha)) / math.sqrt(1.5 * gravity / diagonal)


def amplitudes(alpha: float, tilt: float, n: int) -> Floats:
    """Return the largest tilts between the impacts [rad], from the start at rest on, shape [n].

    The rise of the mass centre is as the square of the velocity ratio.
    """
    rise = (math.cos(alpha - tilt) - math.cos(alpha)) * velocity_ratio(alpha) ** (2.0 * np.arange(n))
    peaks: Floats = alpha - np.arccos(math.cos(alpha) + rise)
    return peaks


def frictionless_fall(base: float, height: float, tilt: float, gravity: float = 9.81) -> tuple[float, float]:
    """Return time [s] and rate of the tilt [rad/s] at which a frictionless block lies flat, let go at ``tilt``.

    No force moves its mass centre sideways, at the height f = (L sin(tilt) + H cos(tilt)) / 2.  So the energy gives the
    rate, (J/m + f'^2) rate^2 = 2 g (f_0 - f), and its quadrature the time.
    """
    from scipy.integrate import quad

    def rate(angle: float) -> float:
        slope = 0.5 * (base * math.cos(angle) - height * math.sin(angle))
        # the difference of the heights, without cancellation
        middle, half = 0.5 * (tilt + angle), 0.5 * (tilt - angle)
        fallen = math.sin(half) * (base * math.cos(middle) - height * math.sin(middle))
        return math.sqrt(2.0 * gravity * fallen / ((base**2 + height**2) / 12.0 + slope**2))

    # tilt - angle = s^2: the integrand has no pole at the start
    time, _ = quad(lambda s: 2.0 * s / rate(tilt - s * s), 0.0, math.sqrt(tilt), epsabs=1e-12, epsrel=1e-12)
    return float(time), rate(0.0)
