"""Pairs of bodies that may be near each other, by sweep and prune of boxes, and pairs that a system declares."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.interfaces import Body
from nonsmooth.interfaces.distance_backend import Place
from nonsmooth.interfaces.solid import Vector
from nonsmooth.queries.places import BodyFrames
from nonsmooth.system.system import System

Pairs = frozenset[tuple[int, int]]
"""Pairs of body numbers, the lower number first."""


def places_at_start(system: System) -> list[list[Place]]:
    """Places of the frames of all bodies at t = 0."""
    return [BodyFrames(body, system.gravity).at(0.0, *system.start(body)) for body in system.bodies]


def near_bodies(
    bodies: Sequence[Body], places: Sequence[Sequence[Place]], margins: Vector
) -> Iterator[tuple[int, int]]:
    """Pairs of bodies whose boxes overlap, the lower number first; without pairs of driven bodies.

    Parameters
    ----------
    bodies : sequence of Body
        The bodies; a body without shapes has no box.
    places : sequence
        Places of the frames of each body.
    margins : Vector
        Margin by which the box of each body is enlarged [m], shape [n].
    """
    low, high = (np.array(corners) for corners in zip(*map(_box, bodies, places), strict=True))
    low, high = low - margins[:, None], high + margins[:, None]
    order = np.argsort(low[:, 0], kind="stable")
    ends = np.searchsorted(low[order, 0], high[order, 0], side="right")
    movable = np.array([body.n_u > 0 for body in bodies])
    found = []
    for rank, i in enumerate(order.tolist()):
        others = order[rank + 1 : ends[rank]]
        meet = np.all((low[others, 1:] <= high[i, 1:]) & (low[i, 1:] <= high[others, 1:]), axis=1)
        found += [(min(i, j), max(i, j)) for j in others[meet & (movable[others] | movable[i])].tolist()]
    yield from sorted(found)


def size_of(body: Body) -> float:
    """Largest finite extent of the shapes of a body [m]; infinite if all of its shapes are infinite."""
    extents = [shape.extent for shapes in body.frames for shape in shapes if np.isfinite(shape.extent)]
    return max(extents, default=np.inf)


def _box(body: Body, frames: Sequence[Place]) -> tuple[Vector, Vector]:
    """Lower and upper corner of the box of all shapes [m], shape [3] each; an empty box if the body has no shapes."""
    balls = [(place, shape.extent) for (place, _), shapes in zip(frames, body.frames, strict=True) for shape in shapes]
    if not balls:
        return np.full(3, np.inf), np.full(3, -np.inf)
    return (
        np.min([place - radius for place, radius in balls], axis=0),
        np.max([place + radius for place, radius in balls], axis=0),
    )


@final
@dataclass(frozen=True)
class Ties:
    """Pairs of bodies with declared contacts, pairs that joints connect, and pairs excluded from contact.

    Attributes
    ----------
    declared, joined, excluded : Pairs
        Pairs with declared contacts, with a joint between them, and pairs that the user excluded from contact.
    mechanisms : tuple of frozenset of int
        Groups of bodies that joints connect, directly or through others; a driven body may be in several groups.
    """

    declared: Pairs
    joined: Pairs
    excluded: Pairs
    mechanisms: tuple[frozenset[int], ...]

    @classmethod
    def of(cls, system: System) -> Ties:
        """Collect these pairs of bodies, and the groups that joints connect, from a system."""
        number = {id(body): i for i, body in enumerate(system.bodies)}

        def pairs(bodies: Iterable[tuple[Body, Body]]) -> Pairs:
            numbers = [(number[id(one)], number[id(two)]) for one, two in bodies]
            return frozenset([(i, j) if i < j else (j, i) for i, j in numbers])

        joined = pairs((tie.first, tie.second) for tie in system.joints)
        return cls(
            pairs((said.first, said.second) for said in system.declarations),
            joined,
            pairs(system.excluded),
            _mechanisms(system, joined),
        )

    def same_mechanism(self, i: int, j: int) -> bool:
        """True if joints connect two bodies, directly or through others."""
        return any(i in group and j in group for group in self.mechanisms)


def _mechanisms(system: System, joined: Pairs) -> tuple[frozenset[int], ...]:
    groups: list[set[int]] = []
    for pair in joined:
        movable = {i for i in pair if system.bodies[i].n_u > 0}
        # a driven body, such as the ground, does not connect the bodies that are joined to it
        met = [group for group in groups if group & movable]
        groups = [group for group in groups if not group & movable]
        groups.append(set().union(pair, *met))
    return tuple(map(frozenset, groups))
