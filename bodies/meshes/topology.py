"""Edges and shells of triangles."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces.body import Vector

Integers: TypeAlias = NDArray[np.int64]


def merge_equal(vertices: Vector, faces: Integers) -> tuple[Vector, Integers]:
    """Return the mesh with vertices of equal coordinates made one; those that no triangle has are left out.

    Formats such as STL list the corners of every triangle anew.
    """
    used, inverse = np.unique(faces, return_inverse=True)
    # -0 and 0 are equal and so are not-a-numbers to the search by bytes
    corners = vertices[used] + 0.0
    _, first, groups = np.unique(corners, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first, kind="stable")
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return corners[first[order]], rank[groups.reshape(-1)][inverse.reshape(faces.shape)].astype(np.int64)


def half_edges(faces: Integers) -> Integers:
    """Return the directed edges, three of every triangle in its sense, shape [3 m, 2]."""
    return np.asarray(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2))


def edge_counts(faces: Integers) -> tuple[Integers, Integers, Integers]:
    """Return the undirected edges, shape [n, 2], the number of each, and of every half edge which it is, [3 m]."""
    edges, which, counts = np.unique(
        np.sort(half_edges(faces), axis=1), axis=0, return_inverse=True, return_counts=True
    )
    return edges, counts, which.reshape(-1)


def neighbours(faces: Integers) -> Integers:
    """Return the pairs of half edges of edges that exactly two triangles have, shape [n, 2]."""
    _, counts, which = edge_counts(faces)
    order = np.argsort(which, kind="stable")
    starts = np.cumsum(counts) - counts
    pairs = starts[counts == 2]
    return np.stack([order[pairs], order[pairs + 1]], axis=1)


def shells(faces: Integers) -> Integers:
    """Return the number of the shell of every triangle, from 0: shells share no edge, shape [m]."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    _, counts, which = edge_counts(faces)
    triangle = np.repeat(np.arange(len(faces)), 3)
    links = coo_matrix((np.ones(len(which)), (triangle, which)), shape=(len(faces), len(counts))).tocsr()
    return np.asarray(connected_components(links @ links.T, directed=False)[1], dtype=np.int64)
