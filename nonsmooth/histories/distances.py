"""Distance between two bodies over a run."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.errors import InvalidInput
from nonsmooth.histories.history import History, LabelledArray
from nonsmooth.histories.request import numbers_of, read_times
from nonsmooth.interfaces import Body
from nonsmooth.queries.distance import BodyPair

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

_WHERE = "nonsmooth.distances"
_ARRAYS = (
    ("gap", (), "m", "distance, or minus the length of a translation that separates the bodies"),
    ("lower", (), "m", "lower bound of the gap"),
    ("upper", (), "m", "upper bound of the gap"),
    ("first", ("axis",), "m", "nearest point of the first body"),
    ("second", ("axis",), "m", "nearest point of the second body"),
    ("normal", ("axis",), "1", "unit vector from the first to the second body"),
    ("how", (), "1", "method that found it"),
)
"""Attributes of :class:`nonsmooth.queries.result.DistanceResult` with axes, units and descriptions."""


def distances(
    solution: Solution, first: Body | str, second: Body | str, times: ArrayLike | None = None, *, by: str | None = None
) -> History:
    """Distance between two bodies over a run: gap with bounds [m], nearest points [m], normal, and the method.

    Parameters
    ----------
    solution : Solution
        The run.
    first, second : Body or str
        Two bodies of its system, or their names.  The distance is the least one of all pairs of their shapes.
    times : float or array, optional
        Times within the run [s]; by default the samples.
    by : str, optional
        Method (:func:`nonsmooth.distance`).

    Returns
    -------
    History
        Variables "gap", "lower", "upper", "first", "second", "normal" and "how".

    Raises
    ------
    InvalidInput, NoDistance, MissingPackagesError
        In the cases that :func:`nonsmooth.distance` describes.  InvalidInput also if both bodies are the same, if a
        body is not one of the system, or if a time is outside of the run.
    """
    system = solution.system
    numbers = numbers_of(_WHERE, system, ["body"], [first, second])["body"]
    if numbers[0] == numbers[1]:
        raise InvalidInput(_WHERE, "needs two different bodies", first, "Name the other body.")
    bodies = [system.bodies[number] for number in numbers]
    pair = BodyPair(bodies[0].frames, bodies[1].frames, by)
    given = read_times(_WHERE, solution, times)
    row = np.atleast_1d(given)
    poses = [solution.history("position", "rotation", times=row, of=body) for body in bodies]
    places = zip(*(pose[name] for pose in poses for name in ("position", "rotation")), strict=True)
    found = [pair.at([*zip(o, r, strict=True)], [*zip(p, s, strict=True)]) for o, r, p, s in places]
    arrays = []
    for name, axes, unit, description in _ARRAYS:
        shape, kind = (len(row), *(3 for _ in axes)), str if name == "how" else float
        values = np.array([getattr(one, name) for one in found], dtype=kind).reshape(shape)
        arrays.append(LabelledArray.of(name, axes, values if given.ndim else values[0], description, unit))
    whose = {f"{side}_body": system.names.bodies[i] for side, i in zip(("first", "second"), numbers, strict=True)}
    return History.of(given, tuple(arrays), {}, attributes=whose)
