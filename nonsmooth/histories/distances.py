"""The distance of two bodies over a run."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.errors import InvalidInput
from nonsmooth.histories.times import read_times
from nonsmooth.interfaces import Body
from nonsmooth.queries.bodies import BodyPair
from nonsmooth.queries.result import DistanceHistory

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution


def distances(
    solution: Solution, first: Body, second: Body, times: ArrayLike | None = None, by: str | None = None
) -> DistanceHistory:
    """Return how far two bodies are from each other at times of a solution.

    Raises
    ------
    InvalidInput, NoDistance, MissingPackagesError
        As :func:`nonsmooth.distance`, or if a body is not of the system.
    """
    for body in (first, second):
        if not any(body is other for other in solution.system.bodies):
            raise InvalidInput(
                "Solution.distances", "needs a body of this system", body, "Take it from solution.system.bodies."
            )
    if first is second:
        raise InvalidInput("Solution.distances", "needs two different bodies", first, "Name the other body.")
    pair = BodyPair(first.frames, second.frames, by)
    row = np.atleast_1d(read_times("Solution.distances", solution, times))
    one, other = (solution.poses(body, row) for body in (first, second))
    places = zip(one.origin, one.rotation, other.origin, other.rotation, strict=True)
    found = [pair.at([*zip(o, r, strict=True)], [*zip(p, s, strict=True)]) for o, r, p, s in places]
    return DistanceHistory.of(row, found, (solution.system.name_of(first), solution.system.name_of(second)))
