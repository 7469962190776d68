"""Equations of the arm: two uniform links below a pivot, a torsional spring and damper at the elbow."""

from __future__ import annotations

import math

from nonsmooth.types import Floats


def mass(q: Floats, out: Floats, link_mass: float, link_length: float) -> None:
    """Write the mass matrix M, row by row; q are the angles of the links from the vertical [rad]."""
    unit = link_mass * link_length**2
    out[0] = 4.0 / 3.0 * unit
    out[1] = out[2] = 0.5 * unit * math.cos(q[0] - q[1])
    out[3] = unit / 3.0


def force(
    t: float,
    q: Floats,
    u: Floats,
    out: Floats,
    link_mass: float,
    link_length: float,
    spring: float,
    damping: float,
    elbow_angle: float,
    gravity_z: float,
) -> None:
    """Write h: weight, terms quadratic in u, and the moment of the elbow."""
    turning = 0.5 * link_mass * link_length**2 * math.sin(q[0] - q[1])
    weight = link_mass * link_length * gravity_z
    elbow = spring * (q[1] - q[0] - elbow_angle) + damping * (u[1] - u[0])
    out[0] = -turning * u[1] ** 2 + 1.5 * weight * math.sin(q[0]) + elbow
    out[1] = turning * u[0] ** 2 + 0.5 * weight * math.sin(q[1]) - elbow


def potential(
    q: Floats, link_mass: float, link_length: float, spring: float, elbow_angle: float, gravity_z: float
) -> float:
    """Return the energy of weight and spring [J]."""
    weight = link_mass * link_length * gravity_z
    return weight * (1.5 * math.cos(q[0]) + 0.5 * math.cos(q[1])) + 0.5 * spring * (q[1] - q[0] - elbow_angle) ** 2


def power(t: float, q: Floats, u: Floats, damping: float) -> float:
    """Return the power of the damper [W]."""
    return -damping * (u[1] - u[0]) ** 2


def tip(q: Floats, out: Floats, link_length: float, height: float) -> None:
    """Write the position of the tip [m]; the links hang from a pivot at the height ``height`` over the origin [m]."""
    out[0] = link_length * (math.sin(q[0]) + math.sin(q[1]))
    out[2] = height - link_length * (math.cos(q[0]) + math.cos(q[1]))


def tip_jacobian(q: Floats, out: Floats, link_length: float) -> None:
    """Write the Jacobian of the tip's velocity."""
    for i in range(2):
        out[i] = link_length * math.cos(q[i])
        out[4 + i] = link_length * math.sin(q[i])


def tip_bias(q: Floats, u: Floats, out: Floats, link_length: float) -> None:
    """Write the acceleration of the tip for u' = 0 [m/s^2]."""
    out[0] = -link_length * (math.sin(q[0]) * u[0] ** 2 + math.sin(q[1]) * u[1] ** 2)
    out[2] = link_length * (math.cos(q[0]) * u[0] ** 2 + math.cos(q[1]) * u[1] ** 2)


def links(q: Floats, link_length: float, height: float) -> list[list[tuple[float, float, float]]]:
    """Return the ends of both links [m]."""
    pivot = (0.0, 0.0, height)
    elbow = (link_length * math.sin(q[0]), 0.0, height - link_length * math.cos(q[0]))
    end = (elbow[0] + link_length * math.sin(q[1]), 0.0, elbow[2] - link_length * math.cos(q[1]))
    return [[pivot, elbow], [elbow, end]]
