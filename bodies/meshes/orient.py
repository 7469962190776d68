"""Winding of triangles: neighbours alike, the outside counter-clockwise."""

from __future__ import annotations

import numpy as np

from bodies.meshes.integrals import volume_of
from bodies.meshes.topology import Integers, half_edges, neighbours, shells
from nonsmooth.interfaces.body import Vector


def orient(vertices: Vector, faces: Integers) -> tuple[Integers, int]:
    """Return the triangles wound like their neighbours, every shell with a positive volume; and how many were turned.

    Cavities are told by nothing but their winding, so that they would become bodies: a mesh with more than one shell
    keeps the sense of each in which most of its triangles are wound.
    """
    flipped = _flips(faces)
    number = shells(faces)
    several = int(np.max(number)) > 0
    for i in range(int(np.max(number)) + 1):
        own = number == i
        if several:
            inverted = 2 * np.sum(flipped[own]) > np.sum(own)
        else:
            inverted = volume_of(vertices, _turned(faces[own], flipped[own])) < 0.0
        if inverted:
            flipped[own] = ~flipped[own]
    return _turned(faces, flipped), int(np.sum(flipped))


def _turned(faces: Integers, flipped: np.ndarray) -> Integers:
    return np.where(flipped[:, None], faces[:, ::-1], faces)


def _flips(faces: Integers) -> np.ndarray:
    """Return which triangles to turn so that each is wound like the first of its shell, shape [m]."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import breadth_first_order

    pairs, edges, m = neighbours(faces), half_edges(faces), len(faces)
    one, two = pairs[:, 0] // 3, pairs[:, 1] // 3
    # two half edges that run the same way belong to triangles wound against each other
    against = edges[pairs[:, 0], 0] == edges[pairs[:, 1], 0]
    relation = {}
    for i, j, differ in zip(one.tolist(), two.tolist(), against.tolist(), strict=True):
        relation[i, j] = relation[j, i] = differ
    links = coo_matrix((np.ones(2 * len(one)), (np.append(one, two), np.append(two, one))), shape=(m, m)).tocsr()
    flipped, seen = np.zeros(m, dtype=bool), np.zeros(m, dtype=bool)
    for root in range(m):
        if seen[root]:
            continue
        order, before = breadth_first_order(links, root, directed=False)
        seen[order] = True
        for i in order[1:].tolist():
            flipped[i] = flipped[before[i]] ^ relation[int(before[i]), i]
    return flipped
