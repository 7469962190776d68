"""Which points, and which sets of points, belong together."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nonsmooth.types import Array

Integers = NDArray[np.int64]


def linked(points: Array) -> Integers:
    """Return the group of each point by single linkage: points within 1 in all coordinates are in one group.

    Points are sorted into cells of size 1.  Points of one cell belong together, and only points of neighbouring cells
    are compared, so that many points in few places are quick.

    Parameters
    ----------
    points : array
        Coordinates in units of the linking distance, shape [n_points, n_coordinates].

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
        if not groups.connected(one, two) and nearest(members[one], members[two]).min() <= 1.0:
            groups.merge(one, two)
    roots = np.array([groups[cell] for cell in range(len(cells))])[of_points]
    _, first, found = np.unique(roots, return_index=True, return_inverse=True)
    return np.argsort(np.argsort(first))[found.reshape(-1)]


def nearest(points: Array, others: Array) -> Array:
    """Return the distance of each point from the nearest of other points, in the maximum norm, shape [n_points]."""
    from scipy.spatial import cKDTree

    return np.asarray(cKDTree(others).query(points, p=np.inf)[0])


def hausdorff(one: Array, other: Array) -> float:
    """Return the Hausdorff distance of two sets: the largest distance of a point of either from the other set."""
    return float(max(nearest(one, other).max(), nearest(other, one).max()))


SPACING = 0.9
"""Quantile of the distances of the points of a set from their neighbours: its spacing."""
SHARE = 0.5
"""Share of the points of either set within the spacing of the other, from which two sets overlap.  Of two samples of
one set about nine tenths are within it."""


def overlapping(sets: Array) -> list[Integers]:
    """Return groups of sets that overlap, each as the numbers of its sets; a set that overlaps no other has no group.

    Each set joins the first one that it overlaps.  Then a group joins a larger one if that share of its points lies
    among those of the larger one: a sample may cover a part of the set.

    Parameters
    ----------
    sets : array
        Points of each set over the scales of their coordinates, shape [n_sets, n_points, n_coordinates].
    """
    spacing = np.array([_spacing(points) for points in sets])
    found = list[Integers]()
    # the sort keeps the order of groups of one size
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
        # a quick test first: the mean of a sample lies within the bounds of the others
        likely = others[np.all((means[others] >= low) & (means[others] <= high), axis=1)]
        here = [i for i in likely if _within(sets[i], one, spacing[first]) and _within(one, sets[i], spacing[i])]
        groups.append(np.array([first, *here]))
        left = np.setdiff1d(others, here)
    return groups


def _within(points: Array, others: Array, spacing: float) -> bool:
    return bool(np.mean(nearest(points, others) <= spacing) >= SHARE)


def _spacing(points: Array) -> float:
    """Return the spacing of a set of points."""
    from scipy.spatial import cKDTree

    return float(np.quantile(cKDTree(points).query(points, k=2, p=np.inf)[0][:, 1], SPACING))
