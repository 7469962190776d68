"""An ellipsoid that rolls on a plane without slipping: equations of motion, integrated by scipy for comparison."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Floats = NDArray[np.float64]


def contact_point(semi: Floats, offset: float, n: Floats) -> tuple[Floats, Floats]:
    """Return the contact point from the mass centre [m], and its derivative with respect to the normal n, in body axes.

    With S the squares of the semi-axes the point is r = offset e_z - S n / h, h = sqrt(n . S n) the support function.

    Parameters
    ----------
    semi : ndarray
        Semi-axes [m], shape [3].
    offset : float
        Centre of the ellipsoid over the mass centre [m].
    n : ndarray
        The upward normal in body axes, shape [3].
    """
    stretched = semi**2 * n
    h = float(np.sqrt(n @ stretched))
    return np.array([0.0, 0.0, offset]) - stretched / h, np.outer(stretched, stretched) / h**3 - np.diag(semi**2) / h


def _across(v: Floats) -> Floats:
    """Return the matrix of the cross product with v."""
    x, y, z = v.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def roll(
    semi: Floats,
    offset: float,
    mass: float,
    tensor: Floats,
    gravity: float,
    n: Floats,
    spin: Floats,
    times: Floats,
) -> tuple[Floats, Floats]:
    """Return upward normals and angular velocities [rad/s], in body axes, at given times, shapes [n, 3].

    They follow from J w' + w x J w = r x m (a + g n) and n' = -w x n.  Here r is the point of :func:`contact_point`,
    and a is the acceleration of the mass centre, the rate of its velocity -w x r.

    Parameters
    ----------
    semi, offset, n
        As for :func:`contact_point`; n at the start.
    mass : float
        Mass [kg].
    tensor : ndarray
        Inertia tensor about the mass centre, in body axes [kg m^2], shape [3, 3].
    gravity : float
        Acceleration of gravity [m/s^2].
    spin : ndarray
        Angular velocity at the start, in body axes [rad/s], shape [3].
    times : ndarray
        Times [s], ascending, from the start on.
    """

    def rates(_: float, y: Floats) -> Floats:
        n, w = y[:3], y[3:]
        r, by_normal = contact_point(semi, offset, n)
        # numpy's cross product takes ten times as long
        across_w, across_r = _across(w), _across(r)
        turning = -across_w @ n
        # acceleration of the mass centre for w' = 0, plus gravity along the upward normal n
        bias = gravity * n - across_w @ (by_normal @ turning + across_w @ r)
        matrix = tensor - mass * across_r @ across_r
        return np.concatenate([turning, np.linalg.solve(matrix, mass * across_r @ bias - across_w @ tensor @ w)])

    start = np.concatenate([n, spin])
    found = solve_ivp(rates, (times[0], times[-1]), start, "DOP853", times, rtol=1e-10, atol=1e-11)
    return found.y[:3].T, found.y[3:].T
