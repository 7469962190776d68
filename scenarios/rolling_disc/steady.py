"""Closed forms of a thin disc of radius a that rolls with its centre at rest, tilted by alpha.

The contact runs round a circle of radius a cos(alpha) at the rate Omega.  Centre and contact point of the disc are at
rest, so the disc turns about the line between them, at Omega sin(alpha); its angular momentum along that line is
(m a^2 / 4) Omega sin(alpha), and the moment of the weight, m g a cos(alpha), turns it round:

    Omega^2 sin(alpha) = 4 g / a

This is exact for every alpha, and needs no friction.  The energy is (3/2) m g a sin(alpha).  The power of
:class:`scenarios.rolling_disc.air_film.AirFilm` makes sin^3(alpha) fall linearly in time, as long as it falls slowly.

References
----------
H. K. Moffatt, "Euler's disk and its finite-time singularity", Nature 404 (2000) 833-834.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def precession(tilt: Floats | float, radius: float, gravity: float = 9.81) -> Floats:
    """Return Omega [rad/s] of a tilt alpha [rad]."""
    rates: Floats = np.sqrt(4.0 * gravity / (radius * np.sin(tilt)))
    return rates


def time_to_flat(tilt: float, radius: float, mass: float, viscosity: float) -> float:
    """Return the time until the air has brought the disc down [s]; infinite without air."""
    air = 2.0 * math.pi * viscosity * radius
    return mass * math.sin(tilt) ** 3 / air if air > 0.0 else math.inf


def settling(t: Floats, tilt: float, radius: float, mass: float, viscosity: float) -> Floats:
    """Return the tilt over time [rad]; nan after the time to flat."""
    left = 1.0 - t / time_to_flat(tilt, radius, mass, viscosity)
    tilts: Floats = np.arcsin(math.sin(tilt) * np.cbrt(np.where(left >= 0.0, left, np.nan)))
    return tilts
