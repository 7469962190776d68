"""One contact problem with Coulomb's cone at velocity level, for the laws that map velocities."""

from __future__ import annotations

import math

import numpy as np

from nonsmooth.compiled import compiled
from nonsmooth.types import Array, Floats

_SWEEPS = 100000
_EXACT = 1e-15
_SOLVED = 1e-9
_ENDLESS = 1e100
_PATIENCE = 500
_PROGRESS = 0.999
_LEAST_RELAXATION = 0.03


@compiled
def solve_cone(
    n: int, delassus: Floats, rates: Floats, shift: Floats, base: Floats, least: Floats, out: Floats, friction: Floats
) -> None:
    """Solve for the impulses P by projection, contact by contact, from what ``out`` holds.

    With z = rates + G P and xi = z + shift: P_N >= least complementary to xi_N >= 0; P_T - base_T in the disc of
    radius mu (P_N - base_N), on its edge against xi_T unless that vanishes.

    Parameters
    ----------
    n : int
        Number of contacts.
    delassus : array
        G, row by row [1/kg], length 9 n^2.
    rates, shift : array
        Rates (n, t1, t2) of each contact before, and what is added to those after [m/s], length 3 n.
    base : array
        Impulses that friction does not count [N s], length 3 n.
    least : array
        Least normal impulses [N s], length n.
    out : array
        Impulses: a start, then the solution [N s], length 3 n.  Not a number where the sweeps do not converge.
    friction : array
        Coefficients mu, length n.
    """
    width = 3 * n
    change = size = relaxation = 1.0
    before = math.inf
    for sweep in range(1, _SWEEPS):
        if sweep % _PATIENCE == 0:
            # strong coupling of normal and slip, as in Painlevé's paradox, makes full steps go round in circles
            if change > _PROGRESS * before:
                relaxation = max(0.5 * relaxation, _LEAST_RELAXATION)
            before = change
        change = size = 0.0
        for a in range(n):
            line = 3 * a
            after = rates[line] + shift[line]
            for j in range(width):
                after += delassus[line * width + j] * out[j]
            old = out[line]
            out[line] = max(least[a], old - relaxation * after / delassus[line * width + line])
            change = max(change, abs(out[line] - old))
            # a step of the projected gradient on the disc, short enough for any 2 x 2 block
            step = relaxation / (delassus[(line + 1) * width + line + 1] + delassus[(line + 2) * width + line + 2])
            v1, v2 = rates[line + 1] + shift[line + 1], rates[line + 2] + shift[line + 2]
            for j in range(width):
                v1 += delassus[(line + 1) * width + j] * out[j]
                v2 += delassus[(line + 2) * width + j] * out[j]
            p1, p2 = out[line + 1] - base[line + 1] - step * v1, out[line + 2] - base[line + 2] - step * v2
            bound = friction[a] * (out[line] - base[line])
            norm = math.sqrt(p1 * p1 + p2 * p2)
            if norm > bound:
                p1, p2 = p1 * bound / norm, p2 * bound / norm
            p1, p2 = p1 + base[line + 1], p2 + base[line + 2]
            change = max(change, abs(p1 - out[line + 1]), abs(p2 - out[line + 2]))
            out[line + 1], out[line + 2] = p1, p2
            size = max(size, out[line])
        if change <= _EXACT * relaxation * size:
            return
        if not size < _ENDLESS:
            break
    if not change <= _SOLVED * relaxation * size:
        out[0] = math.nan


def cone_deviation(
    delassus: Array, rates: Array, shift: Array, base: Array, least: Array, impulses: Array, friction: Array
) -> float:
    """Return by how much impulses miss the problem of :func:`solve_cone` [m/s], with its arguments; 0 for a solution.

    Both conditions are fixed points of a projection, whose step makes a velocity of an impulse: complementarity is
    min(G_NN (P_N - least), xi_N) = 0, and P_T - base_T is the projection on the disc of what xi_T leads to.
    """
    n = len(friction)
    xi = (rates + shift + delassus @ impulses).reshape(n, 3)
    own = np.diag(delassus).reshape(n, 3)
    across = own[:, 1:].sum(axis=1, keepdims=True)
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
    """Tell whether impulses solve the problem for z+ + e z-; for arguments see :class:`nonsmooth.interfaces.ImpactMap`.

    A contact that was separating counts with the normal restitution 0.
    """
    shift = tangential_restitution * before
    shift[::3] = restitution * np.minimum(before[::3], 0.0)
    base, least = np.zeros(len(before)), np.zeros(len(friction))
    return cone_deviation(delassus, before, shift, base, least, impulses, friction) <= tolerance
