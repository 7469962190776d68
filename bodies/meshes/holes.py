"""Holes of a mesh: rings of open edges, closed by triangles about their middle."""

from __future__ import annotations

import numpy as np

from bodies.meshes.integrals import areas_of
from bodies.meshes.topology import Integers, edge_counts, half_edges
from nonsmooth.interfaces.body import Vector


def close_holes(vertices: Vector, faces: Integers) -> tuple[Vector, Integers, str]:
    """Return the mesh with a fan of triangles in every ring of open edges, and what was added.

    A ring of three gets one triangle, another a vertex in its middle: exact where the hole is flat and star-shaped.
    """
    rings = _rings(faces)
    if not rings:
        return vertices, faces, ""
    points, new = [vertices], []
    n = len(vertices)
    for ring in rings:
        if len(ring) == 3:
            new.append(tuple(ring))
            continue
        points.append(np.mean(vertices[ring], axis=0)[None])
        new += [(ring[i], ring[(i + 1) % len(ring)], n) for i in range(len(ring))]
        n += 1
    whole, added = np.concatenate(points), np.array(new, dtype=np.int64)
    area = float(np.sum(areas_of(whole, added)))
    share = area / (area + float(np.sum(areas_of(vertices, faces))))
    told = f"{len(rings)} holes closed by {len(added)} triangles of {area:.3g} m^2, {share:.2%} of the surface"
    return whole, np.concatenate([faces, added]), told


def _rings(faces: Integers) -> list[list[int]]:
    """Return the rings of open edges, against the sense of their triangles."""
    _, counts, which = edge_counts(faces)
    edges = half_edges(faces)[counts[which] == 1]
    following: dict[int, list[int]] = {}
    for start, end in edges.tolist():
        following.setdefault(end, []).append(start)
    rings = []
    while following:
        ring = [next(iter(following))]
        while following.get(ring[-1]):
            after = following[ring[-1]].pop()
            if not following[ring[-1]]:
                del following[ring[-1]]
            if after == ring[0]:
                rings.append(ring)
                break
            ring.append(after)
        else:
            # a ring that does not close: wound against each other; the check of edges says so
            following.pop(ring[-1], None)
    return rings
