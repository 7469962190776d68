"""Which bodies of a system are near each other at the start, touch or overlap, whatever is declared of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.checks import check_kind, is_finite
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body
from nonsmooth.queries.distance import BodyPair
from nonsmooth.queries.near import Ties, near_bodies, places_at_start, size_of, touching
from nonsmooth.queries.result import DistanceResult
from nonsmooth.system.system import System

NEAR, TOUCHING, OVERLAPPING = "near", "touching", "overlapping"
_PART = 0.1
"""Default distance of bodies that are near, relative to the smaller body."""


@final
@dataclass(frozen=True)
class NearPair:
    """Two bodies that are near each other.

    Attributes
    ----------
    bodies : tuple of Body
        The bodies.
    numbers : tuple of int
        Their numbers in the system.
    state : str
        "near", "touching" (to a millionth of the smaller one's extent, at least 1e-9 m) or "overlapping".
    declared, joined, excluded : bool
        Whether they have contacts, are tied by joints, be it over other bodies, or are said not to touch.
    distance : DistanceResult
        How far they are from each other, and how that was found.
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
        Its bodies where they start.
    within : float, optional
        Gaps up to which pairs are told [m]; by default, for every two bodies, a tenth of the extent of the smaller one.

    Returns
    -------
    tuple of NearPair
        The least gap first; pairs of driven bodies are left out.

    Raises
    ------
    InvalidInput
        If it is no system, or ``within`` is negative or not finite.
    """
    check_kind("proximity: system", system, System, "Make it by nonsmooth.System([...]).")
    if within is not None and not (is_finite(within) and within >= 0.0):
        raise InvalidInput("proximity: within", "must be finite and not negative [m]", within, "Leave it out.")
    bodies, places, ties = system.bodies, places_at_start(system), Ties.of(system)
    sizes = np.array([size_of(body) for body in bodies])
    # whoever is unbounded is as near as the other one allows
    finite = np.where(np.isfinite(sizes), sizes, 0.0)
    margins = np.maximum(_PART * finite if within is None else within, touching(finite))
    found = []
    for i, j in near_bodies(bodies, places, margins):
        if not any(math.isfinite(shape.extent) for k in (i, j) for shapes in bodies[k].frames for shape in shapes):
            continue
        pair = BodyPair(bodies[i].frames, bodies[j].frames, quick=True)
        gap = pair.at(places[i], places[j])
        size = min(sizes[i], sizes[j])
        least = float(touching(size))
        if gap.gap > max(_PART * size if within is None else within, least):
            continue
        state = NEAR if gap.gap > least else TOUCHING if gap.gap >= -least else OVERLAPPING
        said = (i, j) in ties.declared, ties.same_mechanism(i, j), (i, j) in ties.excluded
        found.append(NearPair((bodies[i], bodies[j]), (i, j), state, *said, gap))
    return tuple(sorted(found, key=lambda one: one.distance.gap))
