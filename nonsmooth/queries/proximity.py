"""Pairs of bodies that are near each other, touch or overlap at the start, with or without a declared contact."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.checks import check_kind, is_finite
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body
from nonsmooth.queries.distance import BodyPair
from nonsmooth.queries.near import Ties, near_bodies, places_at_start, size_of
from nonsmooth.queries.result import DistanceResult
from nonsmooth.solids.measure import touching
from nonsmooth.system.system import System

NEAR, TOUCHING, OVERLAPPING = "near", "touching", "overlapping"
_PART = 0.1
"""Default of the largest gap of bodies that are listed as near, relative to the extent of the smaller body."""


@final
@dataclass(frozen=True)
class NearPair:
    """Two bodies that are near each other.

    Attributes
    ----------
    bodies : tuple of Body
        The bodies.
    numbers : tuple of int
        Numbers of the bodies in the system.
    state : str
        "near", "touching" (a gap or overlap of at most 1e-6 of the smaller extent) or "overlapping".
    declared, joined, excluded : bool
        Whether the pair has a declared contact; is tied by joints, directly or through other bodies; is excluded.
    distance : DistanceResult
        Distance of the bodies, with the method.
    """

    bodies: tuple[Body, Body]
    numbers: tuple[int, int]
    state: str
    declared: bool
    joined: bool
    excluded: bool
    distance: DistanceResult


def proximity(system: System, within: float | None = None) -> tuple[NearPair, ...]:
    """Pairs of bodies that are near each other at the start, those without a declared contact included.

    Parameters
    ----------
    system : System
        The system, with the starts of its bodies.
    within : float, optional
        Largest gap of the pairs to list [m]; by default, for each pair, a tenth of the extent of the smaller body.

    Returns
    -------
    tuple of NearPair
        The pairs in order of their gaps, the least gap first. Pairs of driven bodies are left out.

    Raises
    ------
    InvalidInput
        If ``system`` is not a System, or ``within`` is negative or not finite.
    """
    check_kind("proximity: system", system, System, "Make it by nonsmooth.System([...]).")
    if within is not None and not (is_finite(within) and within >= 0.0):
        raise InvalidInput("proximity: within", "must be finite and not negative [m]", within, "Leave it out.")
    bodies, places, ties = system.bodies, places_at_start(system), Ties.of(system)
    sizes = np.array([size_of(body) for body in bodies])
    # an unbounded body gets no margin of its own: the size of the other body decides
    finite = np.where(np.isfinite(sizes), sizes, 0.0)
    margins = np.maximum(_PART * finite if within is None else within, touching(finite))
    found = []
    for i, j in near_bodies(bodies, places, margins):
        if not any(math.isfinite(shape.extent) for k in (i, j) for shapes in bodies[k].frames for shape in shapes):
            continue
        pair = BodyPair(bodies[i].frames, bodies[j].frames)
        gap = pair.at(places[i], places[j])
        size = min(sizes[i], sizes[j])
        least = float(touching(size))
        if gap.gap > max(_PART * size if within is None else within, least):
            continue
        state = NEAR if gap.gap > least else TOUCHING if gap.gap >= -least else OVERLAPPING
        said = (i, j) in ties.declared, ties.same_mechanism(i, j), (i, j) in ties.excluded
        found.append(NearPair((bodies[i], bodies[j]), (i, j), state, *said, gap))
    return tuple(sorted(found, key=lambda one: one.distance.gap))
