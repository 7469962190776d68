"""Which bodies of a system may be near each other: boxes round where they stand, swept along an axis."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from nonsmooth.interfaces import Body
from nonsmooth.interfaces.distance_backend import Place
from nonsmooth.interfaces.solid import Vector
from nonsmooth.queries.places import BodyFrames
from nonsmooth.system.system import System


def places_at_start(system: System) -> list[list[Place]]:
    """Return the places of the frames of all bodies at t = 0."""
    return [BodyFrames(body, system.gravity).at(0.0, *system.start(body)) for body in system.bodies]


def near_bodies(
    bodies: Sequence[Body], places: Sequence[Sequence[Place]], margins: Vector
) -> Iterator[tuple[int, int]]:
    """Yield the pairs of bodies whose boxes meet, each enlarged by a margin of its own, the lower number first.

    Pairs of driven bodies and bodies without shapes are left out.

    Parameters
    ----------
    bodies : sequence of Body
        The bodies.
    places : sequence
        Where the frames of each stand.
    margins : Vector
        Those of all bodies [m], shape [n].
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
    """Return the largest finite extent of the shapes of a body [m]; infinite if it has none."""
    extents = [shape.extent for shapes in body.frames for shape in shapes if np.isfinite(shape.extent)]
    return max(extents, default=np.inf)


def _box(body: Body, frames: Sequence[Place]) -> tuple[Vector, Vector]:
    """Return corners of a box round all shapes [m], shape [3] each; turned inside out without any."""
    balls = [(place, shape.extent) for (place, _), shapes in zip(frames, body.frames, strict=True) for shape in shapes]
    if not balls:
        return np.full(3, np.inf), np.full(3, -np.inf)
    return (
        np.min([place - radius for place, radius in balls], axis=0),
        np.max([place + radius for place, radius in balls], axis=0),
    )


def touching(size: Any) -> Any:
    """Return by how much bodies may be apart or overlap that touch [m]: what the start of a run allows."""
    return np.maximum(1e-9, 1e-6 * size)
