"""Equations of the woodpecker toy, for small angles: sleeve M and bird S, joined by a torsional spring.

Coordinates are the height y of the sleeve and the angles phi_M, phi_S of sleeve and bird.  The published model defines
gaps and slips but no outlines.  Here the gap of the beak is along x, and the gaps of the sleeve's edges are along y.
Each contact point touches its own face of the pole only.
"""

from __future__ import annotations

from nonsmooth.types import Floats


def mass(
    q: Floats,
    out: Floats,
    sleeve_mass: float,
    bird_mass: float,
    sleeve_inertia: float,
    bird_inertia: float,
    sleeve_arm: float,
    bird_arm: float,
) -> None:
    """Write the mass matrix M to ``out``, row by row."""
    out[0] = bird_mass + sleeve_mass
    out[1] = out[3] = bird_mass * sleeve_arm
    out[2] = out[6] = bird_mass * bird_arm
    out[4] = sleeve_inertia + bird_mass * sleeve_arm**2
    out[5] = out[7] = bird_mass * sleeve_arm * bird_arm
    out[8] = bird_inertia + bird_mass * bird_arm**2


def force(
    t: float,
    q: Floats,
    u: Floats,
    out: Floats,
    sleeve_mass: float,
    bird_mass: float,
    sleeve_arm: float,
    bird_arm: float,
    spring: float,
    gravity_z: float,
) -> None:
    """Write h: weight and spring."""
    moment = spring * (q[1] - q[2])
    out[0] = (bird_mass + sleeve_mass) * gravity_z
    out[1] = bird_mass * sleeve_arm * gravity_z - moment
    out[2] = bird_mass * bird_arm * gravity_z + moment


def potential(
    q: Floats,
    sleeve_mass: float,
    bird_mass: float,
    sleeve_arm: float,
    bird_arm: float,
    spring: float,
    gravity_z: float,
) -> float:
    """Return the energy of weight and spring [J]."""
    raised = (bird_mass + sleeve_mass) * q[0] + bird_mass * (sleeve_arm * q[1] + bird_arm * q[2])
    return 0.5 * spring * (q[1] - q[2]) ** 2 - gravity_z * raised


def beak(
    q: Floats,
    out: Floats,
    sleeve_arm: float,
    bird_arm: float,
    beak_arm: float,
    beak_height: float,
    pole_radius: float,
) -> None:
    """Write the position of the beak's tip [m] to ``out``: ``out[0]`` is its gap along x, ``out[2]`` its height.

    ``out[1]`` remains zero.  ``q`` and the lengths are those of the toy's published model.
    """
    out[0] = sleeve_arm + bird_arm - beak_arm - pole_radius - beak_height * q[2]
    out[2] = q[0] + beak_height + sleeve_arm * q[1] + (bird_arm - beak_arm) * q[2]


def beak_jacobian(
    q: Floats, out: Floats, sleeve_arm: float, bird_arm: float, beak_arm: float, beak_height: float
) -> None:
    """Write the derivatives of gap and height of the beak by q, row by row, to ``out``."""
    out[2] = -beak_height
    out[6], out[7], out[8] = 1.0, sleeve_arm, bird_arm - beak_arm


def lower_edge(q: Floats, out: Floats, sleeve_radius: float, pole_radius: float, sleeve_height: float) -> None:
    """Write the gap, along y, and the height [m] of the sleeve's edges that touch if its angle is negative."""
    out[1] = sleeve_radius - pole_radius + sleeve_height * q[1]
    out[2] = q[0] + sleeve_radius * q[1]


def lower_edge_jacobian(q: Floats, out: Floats, sleeve_radius: float, sleeve_height: float) -> None:
    """Write the derivatives of gap and height of the lower edges by q, row by row, to ``out``."""
    out[4] = sleeve_height
    out[6], out[7] = 1.0, sleeve_radius


def upper_edge(q: Floats, out: Floats, sleeve_radius: float, pole_radius: float, sleeve_height: float) -> None:
    """Write the gap, along y, and the height [m] of the sleeve's edges that touch if its angle is positive."""
    out[1] = sleeve_radius - pole_radius - sleeve_height * q[1]
    out[2] = q[0] + sleeve_radius * q[1]


def upper_edge_jacobian(q: Floats, out: Floats, sleeve_radius: float, sleeve_height: float) -> None:
    """Write the derivatives of gap and height of the upper edges by q, row by row, to ``out``."""
    out[4] = -sleeve_height
    out[6], out[7] = 1.0, sleeve_radius


def no_bias(q: Floats, u: Floats, out: Floats) -> None:
    """Write nothing: the bias of all points is zero, because they are linear in q."""


def outlines(
    q: Floats,
    pole_radius: float,
    sleeve_radius: float,
    sleeve_height: float,
    sleeve_arm: float,
    bird_arm: float,
    beak_arm: float,
    beak_height: float,
) -> list[list[tuple[float, float, float]]]:
    """Return the ends of the lines that draw sleeve, spring and bird [m]; the beak touches the pole at x = 0."""

    def place(x: float, z: float, angle: float, across: float, up: float) -> tuple[float, float, float]:
        return x + across - up * angle, 0.0, z + up + across * angle

    axis = -pole_radius
    corners = [
        place(axis, q[0], q[1], i * sleeve_radius, j * sleeve_height) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))
    ]
    spring = place(axis, q[0], q[1], sleeve_arm, 0.0)
    bird = place(spring[0], spring[2], q[2], bird_arm, 0.0)
    beak_root = place(bird[0], bird[2], q[2], 0.0, beak_height)
    tip = place(bird[0], bird[2], q[2], -beak_arm, beak_height)
    tail = place(bird[0], bird[2], q[2], 0.0, -beak_height)
    sleeve = [[corners[i], corners[(i + 1) % 4]] for i in range(4)]
    edge = place(axis, q[0], q[1], sleeve_radius, 0.0)
    return [*sleeve, [edge, spring], [spring, bird], [tail, beak_root], [beak_root, tip]]
