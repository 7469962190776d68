"""The paper's coordinates (x1, y1, z1, theta, beta, gamma) of a dumbbell, from and to its state."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nonsmooth.rotations import cross

if TYPE_CHECKING:
    from .scenario import DumbbellScenario

Floats = NDArray[np.float64]

NAMES = ("x1", "y1", "z1", "theta", "beta", "gamma")
"""Centre of ball 1 [m] and the 3-2-1 angles of Eq. (2) [rad]."""
_UNITS = dict(zip(NAMES, 3 * ["m"] + 3 * ["rad"], strict=True))
UNITS = _UNITS | {f"{name}_rate": f"{unit}/s" for name, unit in _UNITS.items()}
"""Units of the coordinates and of their rates, by name."""


@dataclass(frozen=True)
class DumbbellMotion:
    """A motion of the scenario's dumbbell over its plate.

    Attributes
    ----------
    scenario : DumbbellScenario
        The scenario of the run.
    t : array
        Times, ascending [s], shape [n].
    q, u : array
        Coordinates [m, rad] and rates, shape [n, 6].
    """

    scenario: DumbbellScenario
    t: Floats
    q: Floats
    u: Floats

    @classmethod
    def of(cls, scenario: DumbbellScenario, t: Floats, q: Floats, u: Floats) -> DumbbellMotion:
        """Return the motion with coordinates and velocities of the free body, shapes [n, 7] and [n, 6]."""
        return cls(scenario, t, *from_state(t, q, u, scenario.centre_distance))

    @property
    def heights(self) -> Floats:
        """Lowest points of the balls [m], shape [n, 2]."""
        first = self.q[:, 2] - self.scenario.radius
        return np.column_stack([first, first + self.scenario.centre_distance * np.sin(self.q[:, 4])])

    @functools.cached_property
    def gap(self) -> Floats:
        """Gaps between balls and plate [m], shape [n, 2]."""
        first = self.q[:, 2] - self.scenario.radius - self.scenario.plate_height(self.t)
        return np.column_stack([first, first + self.scenario.centre_distance * np.sin(self.q[:, 4])])

    @property
    def gap_rate(self) -> Floats:
        """Rates of the gaps [m/s], shape [n, 2]."""
        first = self.u[:, 2] - self.scenario.plate_velocity(self.t)
        return np.column_stack([first, first + self.scenario.centre_distance * np.cos(self.q[:, 4]) * self.u[:, 4]])

    @property
    def centre(self) -> Floats:
        """Horizontal position of the mass centre [m], shape [n, 2]."""
        arm = self.scenario.centre_distance / 2.0 * np.cos(self.q[:, 4])
        return np.column_stack([self.q[:, 0] - arm * np.sin(self.q[:, 3]), self.q[:, 1] + arm * np.cos(self.q[:, 3])])

    @property
    def slip(self) -> Floats:
        """Slip velocity of ball 1 at its lowest point, along x and y [m/s], shape [n, 2]; Eq. (12) of the paper."""
        r, c_b = self.scenario.radius, np.cos(self.q[:, 4])
        s_t, c_t = np.sin(self.q[:, 3]), np.cos(self.q[:, 3])
        x = self.u[:, 0] - r * s_t * self.u[:, 4] - r * c_b * c_t * self.u[:, 5]
        y = self.u[:, 1] + r * c_t * self.u[:, 4] - r * c_b * s_t * self.u[:, 5]
        return np.column_stack([x, y])


def to_state(q: Floats, u: Floats, centre_distance: float) -> dict[str, Floats]:
    """Return the arguments of ``System.place`` from the paper's coordinates, Eqs. (2) and (3).

    Parameters
    ----------
    q, u : array
        (x1, y1, z1, theta, beta, gamma) [m, rad] and their rates [m/s, rad/s], shape [6].
    centre_distance : float
        Distance l of the ball centres [m].

    Returns
    -------
    dict
        position [m] and velocity [m/s] of the mass centre, orientation (unit quaternion),
        angular_velocity in body axes [rad/s].
    """
    theta, beta, gamma = q[3:]
    turn = _product(_about(2, np.pi / 2.0 + theta), _product(_about(1, -beta), _about(0, gamma)))
    e1 = _axes(turn[None])[0][0]
    s_g, c_g, c_b = np.sin(gamma), np.cos(gamma), np.cos(beta)
    spin = np.array([u[5] + u[3] * np.sin(beta), u[3] * c_b * s_g - u[4] * c_g, u[3] * c_b * c_g + u[4] * s_g])
    position = q[:3] + centre_distance / 2.0 * e1
    velocity = u[:3] + centre_distance / 2.0 * _e1_rate(q[None], u[None])[0]
    return {"position": position, "orientation": turn, "velocity": velocity, "angular_velocity": spin}


def from_state(t: Floats, q: Floats, u: Floats, centre_distance: float) -> tuple[Floats, Floats]:
    """Return the paper's coordinates and rates of a motion, the inverse of :func:`to_state`.

    The angles are continuous in time.  Theta and gamma are not defined if the rod stands upright, |beta| = 90 degrees;
    their rates are then large and have no meaning.

    Parameters
    ----------
    t : array
        Times, ascending [s], shape [n].
    q, u : array
        Coordinates and velocities of the free body, shapes [n, 7] and [n, 6].
    centre_distance : float
        Distance l of the ball centres [m].

    Returns
    -------
    q, u : array
        Paper coordinates [m, rad] and rates [m/s, rad/s], shape [n, 6].
    """
    e1, e2, e3 = _axes(q[:, 3:7])
    c_b = np.hypot(e1[:, 0], e1[:, 1])
    theta = np.arctan2(-e1[:, 0], e1[:, 1])
    beta = np.arctan2(e1[:, 2], c_b)
    gamma = np.arctan2(e2[:, 2], e3[:, 2])
    o1, o2, o3 = u[:, 3], u[:, 4], u[:, 5]
    s_g, c_g = np.sin(gamma), np.cos(gamma)
    # the bound keeps the rate finite if the rod stands upright
    theta_rate = (o2 * s_g + o3 * c_g) / np.maximum(c_b, 1e-12)
    beta_rate = o3 * s_g - o2 * c_g
    gamma_rate = o1 - theta_rate * e1[:, 2]
    rates = np.column_stack([u[:, :3], theta_rate, beta_rate, gamma_rate])
    theta, gamma = _continuous(t, theta, theta_rate), _continuous(t, gamma, gamma_rate)
    places = np.column_stack([q[:, :3] - centre_distance / 2.0 * e1, theta, beta, gamma])
    rates[:, :3] = u[:, :3] - centre_distance / 2.0 * _e1_rate(places, rates)
    return places, rates


def tilt(q: Floats) -> Floats:
    """Return the angle beta of the rod with the plate [rad], shape [n], out of coordinates of the body [n, 7]."""
    e1, _, _ = _axes(q[:, 3:7])
    return np.asarray(np.arctan2(e1[:, 2], np.hypot(e1[:, 0], e1[:, 1])))


def _continuous(t: Floats, angle: Floats, rate: Floats) -> Floats:
    """Undo the jumps of 2 pi; the rates [rad/s] allow for several turns between two samples."""
    travelled = np.concatenate([[0.0], np.cumsum(np.diff(t) * (rate[1:] + rate[:-1]) / 2.0)])
    unwrapped: Floats = travelled + np.unwrap(angle - travelled)
    return unwrapped


def _e1_rate(q: Floats, u: Floats) -> Floats:
    """Return the rate of e1 = (-s_theta c_beta, c_theta c_beta, s_beta) [1/s], shape [n, 3]."""
    s_t, c_t, s_b, c_b = np.sin(q[:, 3]), np.cos(q[:, 3]), np.sin(q[:, 4]), np.cos(q[:, 4])
    x = -c_t * c_b * u[:, 3] + s_t * s_b * u[:, 4]
    y = -s_t * c_b * u[:, 3] - c_t * s_b * u[:, 4]
    return np.column_stack([x, y, c_b * u[:, 4]])


def _axes(turn: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the body axes e1, e2, e3 in the world, shapes [n, 3], of unit quaternions, shape [n, 4]."""
    a, b, c, d = turn.T
    e1 = np.column_stack([a * a + b * b - c * c - d * d, 2.0 * (b * c + a * d), 2.0 * (b * d - a * c)])
    e2 = np.column_stack([2.0 * (b * c - a * d), a * a - b * b + c * c - d * d, 2.0 * (c * d + a * b)])
    e3 = np.column_stack([2.0 * (b * d + a * c), 2.0 * (c * d - a * b), a * a - b * b - c * c + d * d])
    return e1, e2, e3


def _about(axis: int, angle: float) -> Floats:
    """Return the quaternion of a rotation about a coordinate axis."""
    turn = np.zeros(4)
    turn[0], turn[1 + axis] = np.cos(angle / 2.0), np.sin(angle / 2.0)
    return turn


def _product(p: Floats, q: Floats) -> Floats:
    """Return the quaternion product p q."""
    scalar = p[0] * q[0] - p[1:] @ q[1:]
    return np.concatenate([[scalar], p[0] * q[1:] + q[0] * p[1:] + cross(p[1:], q[1:])])
