"""Distance of two bodies or shapes, by the pairs of their shapes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, final

import numpy as np

from nonsmooth.checks import check_kind
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body, Shape
from nonsmooth.interfaces.distance_backend import Place
from nonsmooth.queries.pair import ShapePair, shape_pair
from nonsmooth.queries.places import HERE, BodyFrames, read_place
from nonsmooth.queries.result import DistanceResult

Carried = Sequence[Sequence[Shape]]
"""The shapes of every frame of a body."""


@final
class BodyPair:
    """All pairs of the shapes of two bodies, prepared once.

    Parameters
    ----------
    first, second : sequence of sequences of Shape
        Shapes of the frames of each body.
    by : str, optional
        Method (:class:`nonsmooth.queries.pair.ShapePair`).

    Raises
    ------
    InvalidInput
        A body has no shape, or the method does not know a pair of shapes.
    MissingPackagesError
        The library is not installed.
    """

    def __init__(self, first: Carried, second: Carried, by: str | None = None) -> None:
        sides = [
            [(frame, shape) for frame, shapes in enumerate(carried) for shape in shapes] for carried in (first, second)
        ]
        if not all(sides):
            raise InvalidInput("distance", "needs bodies that carry shapes", None, "Without a shape nothing is near.")
        if by is not None:
            check_kind("distance: by", by, str, 'For example "fcl", or leave it out.')
        self._by = by
        numbered = [
            ((i, j), frame, other, one, two)
            for i, (frame, one) in enumerate(sides[0])
            for j, (other, two) in enumerate(sides[1])
        ]
        if len(numbered) > 1:
            # two unbounded shapes have no nearest points: one such pair is used, and raises, only if there is no other
            bounded = [pair for pair in numbered if math.isfinite(min(pair[3].extent, pair[4].extent))]
            numbered = bounded or numbered[:1]
        self._numbered = numbered
        # a single pair of shapes is prepared here, so that unsupported shapes raise an error at once. If there are
        # several pairs, each pair is prepared when a query first finds its shapes near each other
        self._pairs: dict[tuple[int, int], ShapePair] = {}
        if len(self._numbered) == 1:
            self._pair(*self._numbered[0][0], *self._numbered[0][3:])

    def _pair(self, i: int, j: int, one: Shape, two: Shape) -> ShapePair:
        if (i, j) not in self._pairs:
            self._pairs[i, j] = shape_pair(one, two, self._by)
        return self._pairs[i, j]

    def at(self, first: Sequence[Place], second: Sequence[Place]) -> DistanceResult:
        """Least gap of all pairs of shapes, with the frames at given places.

        Raises
        ------
        NoDistance
            As :meth:`nonsmooth.queries.pair.ShapePair.at`.
        """
        # lower bound of the gap of each pair: the gap of the bounding spheres about the origins of their frames
        least = [0.0]
        if len(self._numbered) > 1:
            least = [
                float(np.linalg.norm(first[frame][0] - second[other][0])) - one.extent - two.extent
                for _, frame, other, one, two in self._numbered
            ]
        best: DistanceResult | None = None
        for number in sorted(range(len(least)), key=least.__getitem__):
            if best is not None and least[number] > best.gap:
                break
            shapes, frame, other, one, two = self._numbered[number]
            found = self._pair(*shapes, one, two).at(first[frame], second[other])
            if best is None or found.gap < best.gap:
                best = replace(found, shapes=shapes)
        assert best is not None
        return best


def distance(
    first: Body | Shape, second: Body | Shape, *, at: Sequence[Any] = (None, None), by: str | None = None
) -> DistanceResult:
    """Distance of two bodies or two shapes: gap with bounds [m], nearest points [m], normal, and the method.

    Parameters
    ----------
    first, second : Body or Shape
        Bodies or shapes; all shapes of a body count.
    at : sequence of two
        Pose of each: a position [m], shape [3], or a position and a unit quaternion (scalar first), of the frame of the
        body or of the shape.  None, the default, is the origin without rotation; for a driven body or a mechanism it is
        the pose at t = 0.
    by : str, optional
        Method: "pair", the default, or the name of a library ("fcl", "coal"), as an independent check.  Shapes without
        convex parts or a surface are left to a library; ``how`` names the method.

    Returns
    -------
    DistanceResult
        Its ``gap`` is negative if they overlap.

    Raises
    ------
    InvalidInput
        An argument is neither a body nor a shape, a pose is wrong, or no method, or not the method `by`, supports the
        shapes.
    NoDistance
        A library computes the distance, and the shapes overlap, or it contradicts support functions.
    MissingPackagesError
        The library `by` is not installed.
    """
    if not isinstance(at, (tuple, list)) or len(at) != 2:
        raise InvalidInput(
            "distance: at", "must be two poses, one for either", at, "None stands for where it is by itself."
        )
    sides = [
        _stand(f"distance: at[{i}]", thing, pose)
        for i, (thing, pose) in enumerate(zip((first, second), at, strict=True))
    ]
    (carried, places), (others, their) = sides
    return BodyPair(carried, others, by).at(places, their)


def _stand(thing: str, side: Any, pose: Any) -> tuple[Carried, list[Place]]:
    if isinstance(side, Shape):
        return ((side,),), [HERE if pose is None else read_place(thing, pose)]
    if not isinstance(side, Body):
        raise InvalidInput("distance", "must be asked of bodies or shapes", side, "For example Ball(0.01).")
    if pose is None:
        q, u = (np.zeros(n) for n in (side.n_q, side.n_u))
        if side.n_q:
            q, u = side.state()
        return side.frames, BodyFrames(side).at(0.0, q, u)
    if len(side.frames) != 1:
        raise InvalidInput(
            thing,
            f"must be None for a {type(side).__name__}, which has {len(side.frames)} frames",
            pose,
            "Its coordinates say where they are: use distances of a solution, or nonsmooth.proximity of a system.",
        )
    return side.frames, [read_place(thing, pose)]
