"""Equations of crank, rod and slider in their three absolute angles; the mechanism moves in the x-z plane."""

from __future__ import annotations

import math

from nonsmooth.engine.memory.blocks import ROTATION
from nonsmooth.types import Floats


def mass(
    q: Floats,
    out: Floats,
    crank_length: float,
    rod_length: float,
    crank_mass: float,
    rod_mass: float,
    slider_mass: float,
    crank_inertia: float,
    rod_inertia: float,
    slider_inertia: float,
) -> None:
    """Write the mass matrix M, row by row."""
    carried = rod_mass + slider_mass
    out[0] = crank_inertia + crank_length**2 * (0.25 * crank_mass + carried)
    out[1] = out[3] = crank_length * rod_length * (0.5 * rod_mass + slider_mass) * math.cos(q[0] - q[1])
    out[4] = rod_inertia + rod_length**2 * (0.25 * rod_mass + slider_mass)
    out[8] = slider_inertia


def force(
    t: float,
    q: Floats,
    u: Floats,
    out: Floats,
    crank_length: float,
    rod_length: float,
    crank_mass: float,
    rod_mass: float,
    slider_mass: float,
    gravity_z: float,
) -> None:
    """Write h: weight and terms quadratic in u."""
    rod = rod_length * (0.5 * rod_mass + slider_mass)
    turning = crank_length * rod * math.sin(q[0] - q[1])
    carried = 0.5 * crank_mass + rod_mass + slider_mass
    out[0] = -turning * u[1] ** 2 + gravity_z * crank_length * carried * math.cos(q[0])
    out[1] = turning * u[0] ** 2 + gravity_z * rod * math.cos(q[1])


def potential(
    q: Floats,
    crank_length: float,
    rod_length: float,
    crank_mass: float,
    rod_mass: float,
    slider_mass: float,
    gravity_z: float,
) -> float:
    """Return the energy of weight [J]."""
    crank = crank_length * (0.5 * crank_mass + rod_mass + slider_mass) * math.sin(q[0])
    return -gravity_z * (crank + rod_length * (0.5 * rod_mass + slider_mass) * math.sin(q[1]))


def slider(q: Floats, out: Floats, crank_length: float, rod_length: float) -> None:
    """Write position and axes of the slider."""
    out[0] = crank_length * math.cos(q[0]) + rod_length * math.cos(q[1])
    out[2] = crank_length * math.sin(q[0]) + rod_length * math.sin(q[1])
    c, s = math.cos(q[2]), math.sin(q[2])
    out[ROTATION], out[ROTATION + 2] = c, -s
    out[ROTATION + 4] = 1.0
    out[ROTATION + 6], out[ROTATION + 8] = s, c


def slider_jacobian(q: Floats, out: Floats, crank_length: float, rod_length: float) -> None:
    """Write the Jacobian of the slider's velocity and angular velocity; an angle from x to z turns about -y."""
    out[0], out[1] = -crank_length * math.sin(q[0]), -rod_length * math.sin(q[1])
    out[6], out[7] = crank_length * math.cos(q[0]), rod_length * math.cos(q[1])
    out[14] = -1.0


def slider_bias(q: Floats, u: Floats, out: Floats, crank_length: float, rod_length: float) -> None:
    """Write the slider's acceleration for u' = 0 [m/s^2]."""
    out[0] = -crank_length * math.cos(q[0]) * u[0] ** 2 - rod_length * math.cos(q[1]) * u[1] ** 2
    out[2] = -crank_length * math.sin(q[0]) * u[0] ** 2 - rod_length * math.sin(q[1]) * u[1] ** 2


def links(q: Floats, crank_length: float, rod_length: float) -> list[list[tuple[float, float, float]]]:
    """Return the ends of crank and rod [m]."""
    pin = (crank_length * math.cos(q[0]), 0.0, crank_length * math.sin(q[0]))
    end = (pin[0] + rod_length * math.cos(q[1]), 0.0, pin[2] + rod_length * math.sin(q[1]))
    return [[(0.0, 0.0, 0.0), pin], [pin, end]]
