"""The distance of two bodies or shapes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body, Shape
from nonsmooth.interfaces.distance_backend import Place
from nonsmooth.queries.bodies import BodyPair, Carried
from nonsmooth.queries.places import HERE, BodyFrames, read_place
from nonsmooth.queries.result import DistanceResult


def distance(
    first: Body | Shape, second: Body | Shape, *, at: Sequence[Any] = (None, None), by: str | None = None
) -> DistanceResult:
    """Return how far two bodies, or two shapes, are from each other: one call for every pair that can be built.

    Parameters
    ----------
    first, second : Body or Shape
        Of a body all shapes count.
    at : sequence of two
        Where either stands: a position [m], shape (3), or a position and a unit quaternion (scalar first), of the frame
        of the body, or of that in which a shape's own numbers are.  By default, None, it is in no way moved or turned;
        a driven body or a mechanism then stands where it does at t = 0.
    by : str, optional
        One way to find it, for a look from outside: "exact", "planes" or the name of a library ("fcl", "coal").  By
        default the best that is known answers, and says what it is in ``how``.

    Returns
    -------
    DistanceResult
        With ``gap`` (negative where they overlap), the bounds ``lower`` and ``upper``, points, normal, and ``how``.

    Raises
    ------
    InvalidInput
        If something is neither a body nor a shape, a pose is wrong, nothing is known of two shapes, or the way asked
        for does not know them.
    NoDistance
        If the way asked for tells nothing at these places.
    MissingPackagesError
        If the library asked for is not installed.
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
            "Its coordinates say where they are: ask solution.distances, or nonsmooth.proximity of a system.",
        )
    return side.frames, [read_place(thing, pose)]
