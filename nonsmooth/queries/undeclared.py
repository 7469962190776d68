"""What is said before a run of bodies that overlap at the start and have no contact."""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Sequence

import numpy as np

from nonsmooth.errors import NonsmoothWarning
from nonsmooth.interfaces import Body
from nonsmooth.interfaces.distance_backend import Place
from nonsmooth.queries.near import near_bodies
from nonsmooth.queries.ties import Ties
from nonsmooth.solids.placed import Placed, overlap
from nonsmooth.system.system import System

_NAMED = 3
"""Pairs that are named; of others the number is told."""


class UndeclaredOverlap(NonsmoothWarning):
    """Bodies that overlap at the start and have no contact: they pass through each other."""


def warn_of_overlaps(system: System, places: Sequence[Sequence[Place]]) -> None:
    """Warn of bodies that overlap at the start, where their frames have these places, though nothing is said of them.

    Left alone are pairs with a declared contact, be it of some of their shapes, of one mechanism, of driven bodies, and
    those that the user excluded; planes, on whose wrong side a body may well be meant to start; and all of a system
    without any contact, in which nothing is meant to touch.
    """
    bodies = system.bodies
    solid = [any(shape.solid is not None for shapes in body.frames for shape in shapes) for body in bodies]
    near = [(i, j) for i, j in near_bodies(bodies, places, np.zeros(len(bodies))) if solid[i] and solid[j]]
    if not system.declarations or not near:
        return
    ties = Ties.of(system)
    said = ties.declared | ties.excluded
    found = [
        (i, j, depth)
        for i, j in near
        if (i, j) not in said and not ties.same_mechanism(i, j)
        if (depth := _overlap(bodies[i], places[i], bodies[j], places[j])) > 0.0
    ]
    if not found:
        return
    names = system.names.bodies
    named = [f"{names[i]!r} and {names[j]!r} by at least {depth:.2g} m" for i, j, depth in found[:_NAMED]]
    more = [f"and {len(found) - _NAMED} more pairs"] if len(found) > _NAMED else []
    warnings.warn(
        f"Bodies without a contact overlap at the start, and will pass through each other: {'; '.join(named + more)}. "
        "Declare their contact by system.contact(...), or say by system.exclude(first, second) that they do not touch. "
        "nonsmooth.proximity(system) lists all pairs.",
        UndeclaredOverlap,
        stacklevel=4,
    )


def _overlap(one: Body, places: Sequence[Place], two: Body, others: Sequence[Place]) -> float:
    """Return how deep at least solids of two bodies reach into each other [m], 0 if they may touch."""
    for a, b in itertools.product(_solids(one, places), _solids(two, others)):
        (low, high), (below, above) = a[0].bounds, b[0].bounds
        if np.any(low > above) or np.any(below > high):
            continue
        allowed = max(1e-9, 1e-6 * min(a[1], b[1])) + a[0].solid.set_back + b[0].solid.set_back
        way = 0.5 * (below + above - low - high)
        away = float(np.linalg.norm(way))
        found = overlap(a[0], b[0], allowed, way / away if away > 0.0 else np.array([0.0, 0.0, 1.0]))
        if found > 0.0:
            return found
    return 0.0


def _solids(body: Body, places: Sequence[Place]) -> list[tuple[Placed, float]]:
    """Return the solids of a body where they stand, with the extents of their shapes [m]."""
    return [
        (Placed(solid, *place), shape.extent)
        for place, shapes in zip(places, body.frames, strict=True)
        for shape in shapes
        if (solid := shape.solid) is not None
    ]
