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
from nonsmooth.system.lookup import body_number

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution


def distances(
    solution: Solution, one: Body | str, other: Body | str, times: ArrayLike | None = None, by: str | None = None
) -> DistanceHistory:
    """Return how far two bodies are from each other at times of a solution.

    Raises
    ------
    InvalidInput, NoDistance, MissingPackagesError
        As :func:`nonsmooth.distance`, or if the system has no such body.
    """
    system = solution.system
    first, second = (system.bodies[body_number("Solution.distances", body, system)] for body in (one, other))
    if first is second:
        raise InvalidInput("Solution.distances", "needs two different bodies", first, "Name the other body.")
    pair = BodyPair(first.frames, second.frames, by)
    row = np.atleast_1d(read_times("Solution.distances", solution, times))
    ours, theirs = (solution.poses(body, row) for body in (first, second))
    places = zip(ours.origin, ours.rotation, theirs.origin, theirs.rotation, strict=True)
    found = [pair.at([*zip(o, r, strict=True)], [*zip(p, s, strict=True)]) for o, r, p, s in places]
    return DistanceHistory.of(row, found, (system.name_of(first), system.name_of(second)))
