"""Attractors matched from one value of a parameter to the next."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.checks import is_finite
from nonsmooth.errors import InvalidInput
from nonsmooth.studies.attractors.linkage import hausdorff
from nonsmooth.types import Array

Integers = NDArray[np.int64]


@final
@dataclass(frozen=True, eq=False)
class Group:
    """Runs that go to one attractor.

    Attributes
    ----------
    runs : array
        Numbers of the runs, shape [n_runs].
    points : array
        The attractor over the scales of its coordinates, shape [n_points, n_coordinates].
    period : int or None
        After how many periods it repeats, 0 where it does not; None where that is not known, or not the same in all.
    """

    runs: NDArray[np.int64]
    points: Array
    period: int | None


Grouping = Callable[[Integers], list[Group]]
"""From the numbers of some runs to their groups."""


@final
@dataclass(frozen=True)
class Along:
    """Along which parameter attractors are followed.

    Parameters
    ----------
    parameter : str
        Parameter along which attractors are matched.
    tolerance : float
        How far an attractor may move from one value to the next, as Hausdorff distance of its points, of which each
        coordinate counts in units of its scale, or of the tolerance of its feature.
    bins : int
        Parts of the range where the runs are draws; of a grid each value counts.
    """

    parameter: str
    tolerance: float
    bins: int = 10

    def __post_init__(self) -> None:
        if not (is_finite(self.tolerance) and self.tolerance > 0.0):
            remedy = "Give how far an attractor moves from one value to the next."
            raise InvalidInput("Along: tolerance", "must be positive and finite", self.tolerance, remedy)


def matched(known: Sequence[Array], now: Sequence[Array], tolerance: float) -> list[int]:
    """Return of each attractor which of the known ones it is, -1 for none.

    Of all ways to pair as many as there can be pairs within the tolerance, it is that with the least sum of distances.

    Parameters
    ----------
    known, now : sequence of array
        Points of each attractor, shape [n_points, n_coordinates].
    tolerance : float
        Hausdorff distance beyond which two are not the same.

    References
    ----------
    G. Datseris, K. L. Rossi, A. Wagemakers, "Framework for global stability analysis of dynamical systems", Chaos 33
    (2023) 073151.
    """
    from scipy.optimize import linear_sum_assignment

    distances = np.array([[hausdorff(one, other) for other in known] for one in now]).reshape(len(now), len(known))
    # what is too far apart costs more than all that may be paired
    costs = np.where(distances <= tolerance, distances, 1.0 + 2.0 * tolerance * min(distances.shape, default=0))
    found = [-1] * len(now)
    for i, j in zip(*linear_sum_assignment(costs), strict=True):
        if distances[i, j] <= tolerance:
            found[i] = int(j)
    return found


def followed(parts: Sequence[Sequence[Group]], tolerance: float) -> list[Group]:
    """Return the attractors of all parts, those that are the same as one group.

    An attractor that is missed for some values is looked for where it was last.

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
