"""Solver of the impact problem with Coulomb's friction cone at velocity level.

It serves impact laws that give the velocities after an impact from the velocities before it, such as Newton's law.
"""

from __future__ import annotations

import math

import numpy as np

from nonsmooth.compiled import compiled
from nonsmooth.types import Array, Floats

from .natural_map import find_zero, is_unbounded, sweep
from .pyramid import solve_on_pyramids

_SWEEPS = 100
_NARROW = (0.0, 0.25, 0.06, 0.015, 0.004, 0.001, 3e-4, 1e-4)
"""Angles between the facets of the pyramids in successive trials [rad]; 0 stands for evenly spaced facets.

Facets in a narrow fan about the last friction impulse approximate the cone near this impulse.
"""
_COMPLIANCES = (1e-9, 1e-7, 1e-5, 1e-3)


@compiled
def solve_cone(
    n: int, delassus: Floats, rates: Floats, shift: Floats, base: Floats, least: Floats, out: Floats, friction: Floats
) -> int:
    """Solve for the impulses P, starting from ``out`` or from the solution on pyramids; return 1 for an exact solution.

    The rates after the impact are z = rates + G P, and xi = z + shift.  Conditions for each contact:

    - P_N >= least, xi_N >= 0, and (P_N - least) xi_N = 0;
    - P_T - base_T lies in the disc of radius mu (P_N - base_N).  If xi_T is not 0, it lies on the edge of the disc,
      opposite to xi_T.

    With ``shift`` 0, as in an inelastic impact, a solution exists unless driven bodies squeeze a free one: unless some
    impulses in the cones move nothing, and no rates after the impact stop the approach along them.

    Parameters
    ----------
    n : int
        Number of contacts.
    delassus : array
        G, row by row [1/kg], length 9 n^2.
    rates, shift : array
        Rates (n, t1, t2) of each contact before, and the shift added to the rates after [m/s], length 3 n.
    base : array
        Impulses that are subtracted from P before the friction condition is applied [N s], length 3 n.
    least : array
        Least normal impulses [N s], length n.
    out : array
        Impulses: a start, then the solution [N s], length 3 n.  Without a solution they are the solution on narrow
        pyramids inside the cones; the first one is nan if the pyramids have no solution, either.
    friction : array
        Coefficients mu, length n.
    """
    width = 3 * n
    matrix, free, p, mu = np.zeros((width, width)), np.zeros(width), np.zeros(width), np.zeros(n)
    kept, lower = np.zeros(width), np.zeros(n)
    for i in range(width):
        free[i], p[i], kept[i] = rates[i] + shift[i], out[i], base[i]
        mu[i // 3], lower[i // 3] = friction[i // 3], least[i // 3]
        for j in range(width):
            matrix[i, j] = delassus[i * width + j]
    answered = 0
    for trial in range(-1, len(_NARROW)):
        if trial >= 0:
            answered += solve_on_pyramids(n, matrix, free, kept, lower, mu, _NARROW[trial], p)
            if answered == 0:
                break
        for sweeps in (0, _SWEEPS):
            for _sweep in range(sweeps):
                sweep(n, matrix, free, kept, lower, mu, p)
            for compliance in _COMPLIANCES:
                tried = p.copy()
                if find_zero(n, matrix, free, kept, lower, mu, compliance, False, tried) == 1:
                    # the pyramids of trials from 0 on may give unnecessarily large impulses: reduce these; trial -1
                    # starts from the caller's impulses, such as 0
                    if trial >= 0:
                        _lessen(n, matrix, free, kept, lower, mu, tried)
                    _write_inside(n, kept, lower, mu, tried, out)
                    return 1
    _write_inside(n, kept, lower, mu, p, out)
    if answered == 0 or is_unbounded(n, matrix, free, lower, p):
        out[0] = math.nan
    return 0


@compiled
def _lessen(n: int, matrix: Array, free: Array, base: Array, least: Array, friction: Array, p: Array) -> None:
    """Replace impulses P that solve the problem by a solution with nearly the least norm |P|, if one is found.

    Redundant contacts, such as the contacts of a wedged body, may have arbitrarily large impulses that cancel each
    other.  The solution on pyramids may contain such impulses, and the search that starts from it does not remove them.
    """
    for compliance in _COMPLIANCES[::-1]:
        tried = p.copy()
        if find_zero(n, matrix, free, base, least, friction, compliance, True, tried) == 1:
            longer = 0.0
            for i in range(3 * n):
                longer += tried[i] * tried[i] - p[i] * p[i]
            if longer < 0.0:
                p[:] = tried
            return


@compiled
def _write_inside(n: int, base: Array, least: Array, friction: Array, p: Array, out: Floats) -> None:
    """Write impulses to ``out``, projected into their friction cones, which they leave by round-off only."""
    for a in range(n):
        i = 3 * a
        out[i] = max(least[a], p[i])
        p1, p2 = p[i + 1] - base[i + 1], p[i + 2] - base[i + 2]
        size, radius = math.sqrt(p1 * p1 + p2 * p2), friction[a] * (out[i] - base[i])
        cut = radius / size if size > radius else 1.0
        out[i + 1], out[i + 2] = base[i + 1] + cut * p1, base[i + 2] + cut * p2


@compiled
def solve_rebound(n: int, delassus: Floats, rates: Floats, shift: Floats, out: Floats, friction: Floats) -> None:
    """Solve for the impulses of an impact; if it has no solution, for the impulses of the inelastic impact.

    ``shift`` [m/s] sets the rebound.  The conditions of :func:`solve_cone` hold for the rates after the impact plus
    this shift, which is e times the rates before the impact in Newton's law.  A wedged body has no such solution: the
    impulse that opens one contact compresses another one.  The impact is then solved with ``shift`` 0, as inelastic.
    If that has no solution, either, the first impulse is nan, and the run names the squeezed body.
    """
    none, least = np.zeros(3 * n), np.zeros(n)
    for i in range(3 * n):
        out[i] = 0.0
    if solve_cone(n, delassus, rates, shift, none, least, out, friction) == 0:
        for i in range(3 * n):
            out[i] = 0.0
        solve_cone(n, delassus, rates, none, none, least, out, friction)


def cone_deviation(
    delassus: Array, rates: Array, shift: Array, base: Array, least: Array, impulses: Array, friction: Array
) -> float:
    """Return the largest violation of the conditions of :func:`solve_cone` by impulses [m/s]; 0 for a solution.

    The arguments, P and xi are those of :func:`solve_cone`.  Each condition is written as an equation whose residual is
    a velocity:

    - complementarity: min(G_NN (P_N - least), xi_N) = 0;
    - friction: G_T (D - proj(D - xi_T / G_T)) = 0, with D = P_T - base_T.  The function proj gives the nearest point of
      the friction disc of the radius mu (P_N - base_N).  G_T is the sum of the contact's two tangential diagonal
      entries of G.
    """
    n = len(friction)
    xi = (rates + shift + delassus @ impulses).reshape(n, 3)
    own = np.diag(delassus).reshape(n, 3)
    across = own[:, 1:].sum(axis=1, keepdims=True)
    across = np.where(across > 0.0, across, own[:, :1])
    normal, counted = impulses.reshape(n, 3)[:, 0], (impulses - base).reshape(n, 3)
    complementary = np.minimum(own[:, 0] * (normal - least), xi[:, 0])
    aim = counted[:, 1:] - xi[:, 1:] / across
    bound = friction * np.maximum(counted[:, 0], 0.0)
    size = np.maximum(np.hypot(*aim.T), 1e-300)
    missed = across * (counted[:, 1:] - aim * np.minimum(1.0, bound / size)[:, None])
    return float(np.max([np.abs(complementary), np.hypot(*missed.T)]))


def follows_cone(
    delassus: Array,
    before: Array,
    impulses: Array,
    friction: Array,
    tolerance: float,
    restitution: float,
    tangential_restitution: float,
) -> bool:
    """Return whether impulses solve the problem with xi = z+ + e z- (:class:`nonsmooth.interfaces.ImpactMap`).

    For a contact that was separating before the impact, the normal restitution e is 0.
    """
    shift = tangential_restitution * before
    shift[::3] = restitution * np.minimum(before[::3], 0.0)
    base, least = np.zeros(len(before)), np.zeros(len(friction))
    return cone_deviation(delassus, before, shift, base, least, impulses, friction) <= tolerance
