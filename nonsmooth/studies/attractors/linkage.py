"""Which points, and which sets of points, belong together."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nonsmooth.types import Array

Integers = NDArray[np.int64]


def linked(points: Array) -> Integers:
    """Return to which group each point belongs: two of which no coordinate differs by more than 1 are in the same one.

    Cells of size 1 make it quick where many points lie in few places: points of one cell are near each other, and
    only points of neighbouring cells are compared.

    Parameters
    ----------
    points : array
        Coordinates over what counts as near, shape [n_points, n_coordinates].

    Returns
    -------
    array
        Numbers from 0 on, in the order of the first points, shape [n_points].
    """
    from scipy.cluster.hierarchy import DisjointSet
    from scipy.spatial import cKDTree

    cells, of_points = np.unique(np.floor(points), axis=0, return_inverse=True)
    of_points = of_points.reshape(-1)
    order = np.argsort(of_points, kind="stable")
    members = np.split(points[order], np.searchsorted(of_points[order], np.arange(1, len(cells))))
    groups = DisjointSet(range(len(cells)))
    for one, two in cKDTree(cells).query_pairs(1.5, p=np.inf, output_type="ndarray").tolist():
        if not groups.connected(one, two) and distance_between(members[one], members[two]) <= 1.0:
            groups.merge(one, two)
    roots = np.array([groups[cell] for cell in range(len(cells))])[of_points]
    _, first, found = np.unique(roots, return_index=True, return_inverse=True)
    return np.argsort(np.argsort(first))[found.reshape(-1)]


def nearest(points: Array, others: Array) -> Array:
    """Return of each point the greatest difference of a coordinate to the nearest of other points, shape [n_points]."""
    from scipy.spatial import cKDTree

    return np.asarray(cKDTree(others).query(points, p=np.inf)[0])


def distance_between(one: Array, other: Array) -> float:
    """Return the distance of the two nearest points of two sets."""
    return float(nearest(one, other).min())


def hausdorff(one: Array, other: Array) -> float:
    """Return the Hausdorff distance of two sets: how far a point of either is at most from the nearest of the other."""
    return float(max(nearest(one, other).max(), nearest(other, one).max()))


SPACING, SHARE = 0.9, 0.5
"""Two sets overlap where this share of the points of either, or more, are as near to the other set as that part of its
points are to their own neighbours: of samples of one set about nine tenths are."""


def overlapping(sets: Array) -> list[Integers]:
    """Return groups of sets that overlap, each as the numbers of its sets; those that overlap none are in no group.

    Each set goes to the first one, in their order, that it overlaps.  Then groups go to a larger one where that share
    of their points lies among its points: a sample may be of a part of the set.

    Parameters
    ----------
    sets : array
        Points of each, over the scales of their coordinates, shape [n_sets, n_points, n_coordinates].
    """
    spacing = np.array([_spacing(points) for points in sets])
    found = list[Integers]()
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


def _alike(sets: Array, spacing: Array) -> list[Integers]:
    means, left, groups = sets.mean(axis=1), np.arange(len(sets)), list[Integers]()
    while len(left):
        first, others = int(left[0]), left[1:]
        one, low, high = sets[first], sets[first].min(axis=0), sets[first].max(axis=0)
        # a sample has its mean among the points of the others, which is quickly looked at
        likely = others[np.all((means[others] >= low) & (means[others] <= high), axis=1)]
        here = [i for i in likely if _within(sets[i], one, spacing[first]) and _within(one, sets[i], spacing[i])]
        groups.append(np.array([first, *here]))
        left = np.setdiff1d(others, here)
    return groups


def _within(points: Array, others: Array, spacing: float) -> bool:
    return bool(np.mean(nearest(points, others) <= spacing) >= SHARE)


def _spacing(points: Array) -> float:
    """Return how far points are from their nearest neighbours, most of them at most."""
    from scipy.spatial import cKDTree

    return float(np.quantile(cKDTree(points).query(points, k=2, p=np.inf)[0][:, 1], SPACING))
