"""The distance of two bodies over a run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body
from nonsmooth.queries.bodies import BodyPair
from nonsmooth.queries.places import BodyFrames
from nonsmooth.queries.result import DistanceHistory

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution


def distances(solution: Solution, first: Body, second: Body, by: str | None = None) -> DistanceHistory:
    """Return how far two bodies are from each other at all samples of a solution.

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
    frames = [BodyFrames(body, solution.system.gravity) for body in (first, second)]
    states = [solution.of(body) for body in (first, second)]
    return DistanceHistory.of(
        solution.t,
        [
            pair.at(*(frame.at(t, q[i], u[i]) for frame, (q, u) in zip(frames, states, strict=True)))
            for i, t in enumerate(solution.t.tolist())
        ],
    )
