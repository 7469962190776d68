"""Two bodies with all of their shapes, made ready once, and how far they are from each other."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import final

import numpy as np

from nonsmooth.checks import check_kind
from nonsmooth.errors import InvalidInput, NoDistance
from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.distance_backend import Place
from nonsmooth.queries.pair import ShapePair, shape_pair
from nonsmooth.queries.result import EXACT, DistanceResult

Carried = Sequence[Sequence[Shape]]
"""The shapes of every frame of a body."""


@final
class BodyPair:
    """All pairs of the shapes of two bodies.

    Parameters
    ----------
    first, second : sequence of sequences of Shape
        The shapes that the frames of either carry.
    by : str, optional
        The way to be taken (:class:`nonsmooth.queries.pair.ShapePair`).
    quick : bool
        Whether contacts are left alone where solids tell.

    Raises
    ------
    InvalidInput
        If one has no shape, or the way does not know two shapes.
    MissingPackagesError
        If the library is not installed.
    """

    def __init__(self, first: Carried, second: Carried, by: str | None = None, quick: bool = False) -> None:
        sides = [
            [(frame, shape) for frame, shapes in enumerate(carried) for shape in shapes] for carried in (first, second)
        ]
        if not all(sides):
            raise InvalidInput("distance", "needs bodies that carry shapes", None, "Without a shape nothing is near.")
        if by is not None:
            check_kind("distance: by", by, str, 'For example "exact", or leave it out.')
        self._by, self._quick = by, quick
        numbered = [
            ((i, j), frame, other, one, two)
            for i, (frame, one) in enumerate(sides[0])
            for j, (other, two) in enumerate(sides[1])
        ]
        if len(numbered) > 1:
            # two planes have no nearest points: where bodies have other shapes these count, else it is an error
            bounded = [pair for pair in numbered if math.isfinite(min(pair[3].extent, pair[4].extent))]
            numbered = bounded or numbered[:1]
        self._numbered = numbered
        # a pair that nothing knows is told of at once, the others are made ready when they are near
        self._pairs: dict[tuple[int, int], ShapePair] = {}
        if len(self._numbered) == 1:
            self._pair(*self._numbered[0][0], *self._numbered[0][3:])

    def _pair(self, i: int, j: int, one: Shape, two: Shape) -> ShapePair:
        if (i, j) not in self._pairs:
            self._pairs[i, j] = shape_pair(one, two, self._by, self._quick)
        return self._pairs[i, j]

    def at(self, first: Sequence[Place], second: Sequence[Place]) -> DistanceResult:
        """Return the least gap of all pairs of shapes, the frames at their places.

        Raises
        ------
        NoDistance
            If nothing tells it there.
        """
        # nearer than this no shapes are whose balls about the origins of their frames are so far apart
        least = [0.0]
        if len(self._numbered) > 1:
            least = [
                float(np.linalg.norm(first[frame][0] - second[other][0])) - one.extent - two.extent
                for _, frame, other, one, two in self._numbered
            ]
        best: DistanceResult | None = None
        untold: NoDistance | None = None
        for number in sorted(range(len(least)), key=least.__getitem__):
            if best is not None and least[number] > best.gap:
                break
            shapes, frame, other, one, two = self._numbered[number]
            try:
                found = self._pair(*shapes, one, two).at(first[frame], second[other])
            except NoDistance as error:
                # of contacts alone those count that face
                if self._by != EXACT:
                    raise
                untold = error
                continue
            if best is None or found.gap < best.gap:
                best = replace(found, shapes=shapes)
        if best is None:
            assert untold is not None
            raise untold
        return best
