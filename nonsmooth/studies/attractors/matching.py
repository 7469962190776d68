"""Attractors matched from one value of a parameter to the next."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.studies.attractors.linkage import hausdorff
from nonsmooth.studies.inputs import check_positive
from nonsmooth.types import Array

Integers = NDArray[np.int64]


@final
@dataclass(frozen=True, eq=False)
class Group:
    """Runs that lead to one attractor.

    Attributes
    ----------
    runs : array
        Numbers of the runs, shape [n_runs].
    points : array
        The attractor over the scales of its coordinates, shape [n_points, n_coordinates].
    period : int or None
        Periods after which it repeats, 0 if it does not; None if that is unknown, or not the same for all runs.
    """

    runs: NDArray[np.int64]
    points: Array
    period: int | None


Grouping = Callable[[Integers], list[Group]]
"""From the numbers of some runs to their groups."""


@final
@dataclass(frozen=True)
class Along:
    """A parameter along which attractors are matched from value to value.

    Parameters
    ----------
    parameter : str
        Parameter along which attractors are matched.
    tolerance : float
        Largest Hausdorff distance of an attractor from itself at the next value; coordinates count in units of their
        scales, features in units of their tolerances.
    bins : int
        Parts of the range if the runs are draws; of a grid each value counts.
    """

    parameter: str
    tolerance: float
    bins: int = 10

    def __post_init__(self) -> None:
        check_positive(
            "Along: tolerance", self.tolerance, "Give how far an attractor moves from one value to the next."
        )


def matched(known: Sequence[Array], now: Sequence[Array], tolerance: float) -> list[int]:
    """Return the number of the known attractor that matches each attractor, -1 for none.

    As many as possible are paired within the tolerance, with the least sum of distances.

    Parameters
    ----------
    known, now : sequence of array
        Points of each attractor, shape [n_points, n_coordinates].
    tolerance : float
        Largest Hausdorff distance of a pair.

    References
    ----------
    G. Datseris, K. L. Rossi, A. Wagemakers, "Framework for global stability analysis of dynamical systems", Chaos 33
    (2023) 073151.
    """
    from scipy.optimize import linear_sum_assignment

    distances = np.array([[hausdorff(one, other) for other in known] for one in now]).reshape(len(now), len(known))
    # a forbidden pair costs more than all allowed ones together
    costs = np.where(distances <= tolerance, distances, 1.0 + 2.0 * tolerance * min(distances.shape, default=0))
    found = [-1] * len(now)
    for i, j in zip(*linear_sum_assignment(costs), strict=True):
        if distances[i, j] <= tolerance:
            found[i] = int(j)
    return found


def joined(parts: Sequence[Sequence[Group]], tolerance: float) -> list[Group]:
    """Return the attractors of all parts, matched ones as one group.

    An attractor that is absent at some values is matched with its last points.

    Parameters
    ----------
    parts : sequence of sequence of Group
        The attractors of each value, in the order of the values.
    tolerance : float
        As of :func:`matched`.
    """
    known = list[Group]()
    for part in parts:
        which = matched([one.points for one in known], [one.points for one in part], tolerance)
        for now, place in zip(part, which, strict=True):
            if place < 0:
                known.append(now)
            else:
                before = known[place]
                period = now.period if now.period == before.period else None
                known[place] = Group(np.append(before.runs, now.runs), now.points, period)
    return known
