"""Find contacts whose force or impulse is outside of the friction cone of their law."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from nonsmooth.certificates import coefficient_of
from nonsmooth.histories.arrays import Floats, Integers
from nonsmooth.interfaces import CompliantNormalLaw, FrictionLaw
from nonsmooth.interfaces.friction_law import StatefulFrictionLaw
from nonsmooth.system.contact import Contact

_SPEEDS = np.concatenate([[0.0], np.logspace(-6.0, 3.0, 91)])
"""Slip speeds at which the largest friction coefficient is sought [m/s]: 0, and ten per decade from 1e-6 to 1e3 m/s."""
_ROUND_OFF = 1e-6
"""Allowed excess of friction over its bound, because solvers leave round-off of this order.

It is this part of the largest normal force (or impulse) of the instant.
"""


def beyond_cones(
    contacts: Sequence[Contact], number: Integers, first: Integers, normal: Floats, friction: Floats, speed: Floats
) -> NDArray[np.bool_]:
    """Find forces or impulses of contacts that are outside of the friction cone: booleans, shape [m].

    The array is True for a contact whose bodies attract each other, and for one with more friction than the law allows.

    Parameters
    ----------
    contacts : sequence of Contact
        Contacts of the system.
    number : array
        Number of the contact of each force or impulse, shape [m].  Those of one instant follow each other.
    first : array
        Index of the first force or impulse of each instant, and m as last number, shape [n + 1].
    normal : array
        Normal forces [N] or impulses [N s], shape [m].
    friction : array
        Friction, in the same unit, shape [m, 3], or along two tangents, shape [m, 2].
    speed : array
        Slip speed at which the coefficient is evaluated [m/s], shape [m]; NaN means the largest of all coefficients.

    Returns
    -------
    array
        Booleans.  If the coefficient depends on direction, the largest is taken.  Laws with inner states, traction
        laws, the pull of adhesive laws, and laws without a value at a speed are not checked.
    """
    bound, may_pull = np.full(len(number), np.inf), np.zeros(len(number), dtype=bool)
    for i in np.unique(number).tolist():
        law, normal_law, entries = contacts[i].friction, contacts[i].normal, np.flatnonzero(number == i)
        may_pull[entries] = isinstance(normal_law, CompliantNormalLaw) and normal_law.reach > 0.0
        if isinstance(law, FrictionLaw) and not isinstance(law, StatefulFrictionLaw):
            coefficient = coefficient_of(law)
            most = max(_value(coefficient, float(v)) for v in _SPEEDS)
            bound[entries] = [most if np.isnan(v) else _value(coefficient, v) for v in speed[entries].tolist()]
    known = np.isfinite(bound)
    slack = _ROUND_OFF * _largest_of_instants(normal, first)
    allowed = np.where(known, bound, 0.0) * np.maximum(normal, 0.0) + slack
    rubs = known & (np.linalg.norm(friction, axis=1) > allowed)
    return np.asarray(rubs | (normal < -slack) & ~may_pull)


def _value(coefficient: Callable[[float], float], speed: float) -> float:
    """Coefficient of friction of a law at a slip speed [m/s].

    It is infinite if the law has no value at this speed, such as log(speed) at rest.  An infinite bound is not checked.
    """
    try:
        return coefficient(speed)
    except (ArithmeticError, ValueError):
        return math.inf


def _largest_of_instants(normal: Floats, first: Integers) -> Floats:
    """For each normal force or impulse, the largest magnitude of all that have the same instant; shape [m], same unit.

    ``normal`` and ``first`` are as in :func:`beyond_cones`.
    """
    counts = np.diff(first)
    starts = first[:-1][counts > 0]
    most = np.maximum.reduceat(np.abs(normal), starts) if len(starts) else np.zeros(0)
    return np.asarray(np.repeat(most, counts[counts > 0]))
