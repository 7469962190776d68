"""Which sets of points overlap so much that they are samples of one set."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nonsmooth.studies.attractors.linkage import nearest

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
SPACING, SHARE = 0.9, 0.5
"""Two sets overlap where this share of the points of either, or more, are as near to the other set as that part of its
points are to their own neighbours: of samples of one set about nine tenths are."""


def overlapping(sets: Floats) -> list[Ints]:
    """Return groups of sets that overlap, each as the numbers of its sets; those that overlap none are in no group.

    Each set goes to the first one, in their order, that it overlaps.  Then groups go to a larger one where that share
    of their points lies among its points: a sample may be of a part of the set.

    Parameters
    ----------
    sets : array
        Points of each, over the scales of their coordinates, shape [n_sets, n_points, n_coordinates].
    """
    spacing = np.array([_spacing(points) for points in sets])
    found = list[Ints]()
    # a sort that keeps the order of those that are as large
    for group in sorted(_alike(sets, spacing), key=len, reverse=True):
        points = sets[group].reshape(-1, sets.shape[2])
        for i, larger in enumerate(found):
            if _within(points, sets[larger].reshape(-1, sets.shape[2]), spacing[larger[0]]):
                found[i] = np.append(larger, group)
                break
        else:
            if len(group) > 1:
                found.append(group)
    return found


def _alike(sets: Floats, spacing: Floats) -> list[Ints]:
    means, left, groups = sets.mean(axis=1), np.arange(len(sets)), list[Ints]()
    while len(left):
        first, others = int(left[0]), left[1:]
        one, low, high = sets[first], sets[first].min(axis=0), sets[first].max(axis=0)
        # a sample has its mean among the points of the others, which is quickly looked at
        likely = others[np.all((means[others] >= low) & (means[others] <= high), axis=1)]
        here = [i for i in likely if _within(sets[i], one, spacing[first]) and _within(one, sets[i], spacing[i])]
        groups.append(np.array([first, *here]))
        left = np.setdiff1d(others, here)
    return groups


def _within(points: Floats, others: Floats, spacing: float) -> bool:
    return bool(np.mean(nearest(points, others) <= spacing) >= SHARE)


def _spacing(points: Floats) -> float:
    """Return how far points are from their nearest neighbours, most of them at most."""
    from scipy.spatial import cKDTree

    return float(np.quantile(cKDTree(points).query(points, k=2, p=np.inf)[0][:, 1], SPACING))
