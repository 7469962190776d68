"""Groups of points by single linkage, and groups of sets of points that overlap."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nonsmooth.types import Array

Integers = NDArray[np.int64]


def linked(points: Array) -> Integers:
    """Return the group of each point by single linkage: points that differ by at most 1 in each coordinate are linked.

    Points are sorted into cells of size 1.  All points of a cell are linked, and only points of neighbouring cells are
    compared.  Many points in few cells are therefore grouped fast.

    Parameters
    ----------
    points : array
        Coordinates in units of the linking distance, shape [n_points, n_coordinates].

    Returns
    -------
    array
        Number of the group of each point, shape [n_points].  Groups are numbered from 0 in the order of their first
        points.
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
    """Return the distance of each of ``points`` to the nearest of ``others`` in the maximum norm, shape [n_points]."""
    from scipy.spatial import cKDTree

    return np.asarray(cKDTree(others).query(points, p=np.inf)[0])


def hausdorff(one: Array, other: Array) -> float:
    """Return the Hausdorff distance of two sets: the largest distance of a point of either from the other set."""
    return float(max(nearest(one, other).max(), nearest(other, one).max()))


SPACING = 0.9
"""The spacing of a set of points is this quantile of the distances of the points from their nearest neighbours."""
SHARE = 0.5
"""Two sets overlap if at least this share of the points of each is within the spacing of the other; two samples of one
attractor have a share of about 0.9."""


def overlapping(sets: Array) -> list[Integers]:
    """Return groups of sets that overlap, each as the numbers of its sets; a set that overlaps no other has no group.

    Each set joins the first earlier set that it overlaps (:data:`SHARE`).  Then a smaller group joins a larger group if
    at least :data:`SHARE` of its points is within the spacing (:data:`SPACING`) of the first set of the larger group.
    The reason is that a sample may cover only a part of an attractor.

    Parameters
    ----------
    sets : array
        Points of each set over the scales of their coordinates, shape [n_sets, n_points, n_coordinates].
    """
    spacing = np.array([_spacing(points) for points in sets])
    found = list[Integers]()
    # the sort is stable: groups of equal size keep their order
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
        # quick test first: if two sets sample one attractor, the mean of one is most likely within the other's bounds
        likely = others[np.all((means[others] >= low) & (means[others] <= high), axis=1)]
        here = [i for i in likely if _within(sets[i], one, spacing[first]) and _within(one, sets[i], spacing[i])]
        groups.append(np.array([first, *here]))
        left = np.setdiff1d(others, here)
    return groups


def _within(points: Array, others: Array, spacing: float) -> bool:
    return bool(np.mean(nearest(points, others) <= spacing) >= SHARE)


def _spacing(points: Array) -> float:
    """Return the quantile :data:`SPACING` of the distances, in the maximum norm, of points from their nearest points.

    The distance is in the units of ``points``, which are scales of the coordinates.
    """
    from scipy.spatial import cKDTree

    return float(np.quantile(cKDTree(points).query(points, k=2, p=np.inf)[0][:, 1], SPACING))
