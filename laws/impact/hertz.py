"""Stiffness and duration of a contact of two elastic bodies, after Hertz."""

from __future__ import annotations

import math

HERTZ_EXPONENT = 1.5
"""The exponent eta of F = k x^eta where two curved surfaces touch at a point."""


def contact_time(mass: float, radius: float, modulus: float, speed: float) -> float:
    """Return the duration of an elastic impact [s], T_c = 2.87 (m*^2 / (R* E*^2 v))^(1/5).

    Parameters
    ----------
    mass : float
        Effective mass m* = 1 / (n . G n) [kg].
    radius : float
        Effective radius R*, 1 / R* = 1 / R_1 + 1 / R_2 [m].
    modulus : float
        Effective modulus E*, 1 / E* = (1 - nu_1^2) / E_1 + (1 - nu_2^2) / E_2 [Pa].
    speed : float
        Relative normal speed v at the start [m/s].

    References
    ----------
    K. L. Johnson, *Contact Mechanics*, Cambridge University Press (1985), section 11.4.
    """
    return float(2.87 * (mass**2 / (radius * modulus**2 * speed)) ** 0.2)


def closing_time(mass: float, radius: float, modulus: float, acceleration: float) -> float:
    """Return the duration [s] of the impact whose bounce is just as short: v = a T_c in :func:`contact_time`.

    It is the T_c of the accumulation rule (33) for bodies pressed together by the acceleration a [m/s^2].
    """
    return float((2.87**5 * mass**2 / (radius * modulus**2 * acceleration)) ** (1.0 / 6.0))


def effective_modulus(first: tuple[float, float], second: tuple[float, float]) -> float:
    """Return E* [Pa] of two materials, 1 / E* = (1 - nu_1^2) / E_1 + (1 - nu_2^2) / E_2.

    Parameters
    ----------
    first, second : tuple of float
        Young's modulus [Pa], infinite for a rigid body, and Poisson's ratio.
    """
    return 1.0 / ((1.0 - first[1] ** 2) / first[0] + (1.0 - second[1] ** 2) / second[0])


def effective_radius(first: float, second: float = math.inf) -> float:
    """Return R* [m] of two spheres, 1 / R* = 1 / R_1 + 1 / R_2; infinite for a plane, negative for a hollow."""
    return 1.0 / (1.0 / first + 1.0 / second)


def hertz_stiffness(radius: float, modulus: float) -> float:
    """Return k of F = k x^(3/2) [N/m^1.5], k = 4/3 E* sqrt(R*).

    Of two contacts only the ratio counts in an impact: (E*_1 / E*_2) sqrt(R*_1 / R*_2).

    Parameters
    ----------
    radius : float
        Effective radius R* [m], :func:`effective_radius`.
    modulus : float
        Effective modulus E* [Pa], :func:`effective_modulus`.

    References
    ----------
    K. L. Johnson, *Contact Mechanics*, Cambridge University Press (1985), section 4.2.
    """
    return 4.0 / 3.0 * modulus * math.sqrt(radius)
