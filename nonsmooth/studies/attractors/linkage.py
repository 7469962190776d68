"""Single linkage: points belong together where a chain of near ones joins them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def linked(points: Floats) -> Ints:
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


def nearest(points: Floats, others: Floats) -> Floats:
    """Return of each point the greatest difference of a coordinate to the nearest of other points, shape [n_points]."""
    from scipy.spatial import cKDTree

    return np.asarray(cKDTree(others).query(points, p=np.inf)[0])


def distance_between(one: Floats, other: Floats) -> float:
    """Return the distance of the two nearest points of two sets."""
    return float(nearest(one, other).min())


def hausdorff(one: Floats, other: Floats) -> float:
    """Return the Hausdorff distance of two sets: how far a point of either is at most from the nearest of the other."""
    return float(max(nearest(one, other).max(), nearest(other, one).max()))
