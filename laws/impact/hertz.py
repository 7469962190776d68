"""How long a contact of two elastic bodies lasts, after Hertz."""

from __future__ import annotations


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


def plane_strain_modulus(young_modulus: float, poisson_ratio: float) -> float:
    """Return the effective modulus [Pa] of two bodies of the same material, E / (2 (1 - nu^2))."""
    return young_modulus / (2.0 * (1.0 - poisson_ratio**2))
