"""Residual checks that all laws of one kind share: they test whether a force or an impulse obeys a law."""

from __future__ import annotations

import functools
import inspect
import math
from collections.abc import Callable

import numpy as np

from nonsmooth.interfaces import (
    AnisotropicFrictionLaw,
    CompliantNormalLaw,
    FrictionLaw,
    ImpactMap,
    StatefulFrictionLaw,
    TractionLaw,
)
from nonsmooth.types import Array

Pair = tuple[float, float]


def coefficient_of(law: FrictionLaw, state: tuple[float, ...] | None = None) -> Callable[[float], float]:
    """Friction coefficient of a law as a function of the slip speed [m/s] alone, by default in its initial state."""
    offered: dict[str, object] = dict(law.parameters())
    if isinstance(law, StatefulFrictionLaw):
        offered["state"] = law.initial_state if state is None else state
    names = list(inspect.signature(law.coefficient).parameters)[1:]
    return functools.partial(law.coefficient, **{name: offered[name] for name in names})


def opposes_slip(
    law: FrictionLaw,
    slip: Pair,
    normal_force: float,
    tangential_force: Pair,
    tolerance: float,
    state: tuple[float, ...] | None = None,
) -> bool:
    """True if a force lies in the disc of a friction law and, under slip, on its edge opposite to the slip.

    Parameters
    ----------
    law : FrictionLaw
        Gives the coefficient at this slip speed, or at speed 0 if the contact is at rest.
    slip : tuple of float
        Slip velocity [m/s], shape (2,); at rest up to the tolerance.
    normal_force : float
        Normal force [N].
    tangential_force : tuple of float
        Tangential force [N], shape (2,).
    tolerance : float
        Largest deviation that is taken as zero: of velocities [m/s], and of forces [N].
    state : tuple of float, optional
        Inner states of the law, if it has any; by default its initial states.
    """
    speed = math.hypot(*slip)
    rests = speed <= tolerance
    bound = coefficient_of(law, state)(0.0 if rests else speed) * normal_force
    if rests:
        return math.hypot(*tangential_force) <= bound + tolerance
    # a distance, so that the verdict is the same in any axes
    return math.dist(tangential_force, [-bound * v / speed for v in slip]) <= tolerance


def follows_compliance(
    law: CompliantNormalLaw, indentation: float, rate: float, closing_rate: float, force: float, tolerance: float
) -> bool:
    """True if a normal force [N] equals the force of a compliant law within the tolerance [N]."""
    names = list(inspect.signature(law.force).parameters)[3:]
    parameters = {name: law.parameters()[name] for name in names}
    return abs(law.force(indentation, rate, closing_rate, **parameters) - force) <= tolerance


def lies_in_half_ellipses(
    law: AnisotropicFrictionLaw, slip: Pair, normal_force: float, tangential_force: Pair, tolerance: float
) -> bool:
    """True if a friction force obeys an anisotropic law within the tolerance.

    At rest the force must lie within the bound, which consists of half ellipses. Under slip it must be the point of the
    bound at which the outward normal is opposite to the slip.

    The components of slip and force are along the axis of the law and across it. Parameters as for
    :func:`opposes_slip`.
    """
    forward, backward, across = law.ratios
    mu = coefficient_of(law)
    if math.hypot(*slip) <= tolerance:
        along = forward if tangential_force[0] < 0.0 else backward
        gauge = math.hypot(tangential_force[0] / along, tangential_force[1] / across)
        return gauge <= mu(0.0) * normal_force + tolerance / min(along, across)
    along = forward if slip[0] > 0.0 else backward
    counted = along * slip[0], across * slip[1]
    speed = math.hypot(*counted)
    factor = -mu(speed) * normal_force / speed
    return math.dist(tangential_force, (factor * along * counted[0], factor * across * counted[1])) <= tolerance


def follows_traction(
    law: TractionLaw,
    motion: tuple[float, ...],
    state: tuple[float, ...],
    normal_force: float,
    traction: tuple[float, ...],
    tolerance: float,
) -> bool:
    """True if force and moment [N, N m] equal the values of a law of traction within the tolerance."""
    names = list(inspect.signature(law.traction).parameters)[4:]
    out = [math.nan] * (5 + len(state))
    law.traction(normal_force, motion, state, out, **{name: law.parameters()[name] for name in names})
    return math.dist(out[:5], traction) <= tolerance


def follows_map(
    law: ImpactMap, delassus: Array, before: Array, impulses: Array, friction: Array, tolerance: float
) -> bool:
    """True if impulses change the velocities [m/s] as the impulses of an impact map in closed form do.

    An impact map that solves a problem has a residual check of the problem instead, because the problem may have
    several solutions.
    """
    n = len(friction)
    names = list(inspect.signature(law.impulses).parameters)[5:]
    own = {name: np.full(n, law.numbers()[name]) for name in names}
    out = np.zeros(3 * n)
    law.impulses(n, np.ravel(delassus), before, out, friction, **own)
    return float(np.max(np.abs(delassus @ (impulses - out)))) <= tolerance
