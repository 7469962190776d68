"""What the evaluators of surfaces that need not be convex read: one row of numbers, with a tree of boxes."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import SharedNumbers

from ...meshes.features import Features
from ...meshes.patches import Patches
from ...meshes.topology import Integers, neighbours

Numbers = tuple[float, ...]

SIZE, NODES, N_NODES, MEMBERS, FACES, TRIANGLES, N_TRIANGLES, EDGES, N_EDGES, CORNERS, STARS, N_FACES, N_PATCHES = (
    range(13)
)
"""Indices of the size [m], of the numbers of parts and of the offsets of parts in the numbers of a surface."""
NODE, FACE, TRIANGLE, EDGE, CORNER = 10, 5, 43, 14, 6
"""Length of the row of each part, and its numbers in order:

- a node: lowest and highest coordinates, the next node if this one is left out, the index of its list of
  members, and their number, 0 except in leaves, and the patches of all members below, as the bits of a number;
- a face: outward normal, distance of its plane from the origin, patch;
- a triangle: vertices, face, for every edge the outward normal in the plane and its distance from the origin, whether
  its face ends there, then the vectors that point out of the body at the three edges and at the three vertices;
- an edge: first end, direction, length, in either face the direction from the edge into it, patch;
- a corner: place, patch, where its star of unit vectors along its edges begins, and their number.
"""
NOTHING = SharedNumbers((0.0, 13.0, 1.0, *(10 * [0.0]), *(6 * [1e150]), *(4 * [0.0])))
"""The surface of a body without volume: no point is inside of it."""
BITS = 52
"""Number of bits that a float stores exactly; with more patches, every node is treated as having all of them."""
_LEAF = 4
"""Members of a leaf, at most."""


@lru_cache(maxsize=4)
def surface_numbers(features: Features, patches: Patches) -> SharedNumbers:
    """Return the numbers of a surface whose features are divided into patches."""
    triangles = _triangles(features)
    edges = np.column_stack([edge_rows(features), np.array(patches.of_edges, dtype=float)])
    lengths = np.array([len(star) for star in features.stars], dtype=int)
    tips = features.vertices[list(features.corners)]
    stars = [np.array(star_of(features, i)) for i in range(len(features.corners))]
    corners = np.column_stack([tips, patches.of_corners, 3 * (np.cumsum(lengths) - lengths), lengths])
    ends = features.vertices[np.array(features.edges, dtype=int).reshape(-1, 4)[:, :2]]
    boxes = [features.vertices[features.triangles], ends, tips[:, None]]
    low = np.concatenate([box.min(axis=1) for box in boxes])
    high = np.concatenate([box.max(axis=1) for box in boxes])
    members, nodes = list[int](), list[list[float]]()
    of_faces = np.array(patches.of_faces, dtype=int)
    owners = np.concatenate([of_faces[features.face_of], patches.of_edges, patches.of_corners]).astype(np.int64)
    bits = np.left_shift(1, owners) if patches.count <= BITS else np.full(len(owners), (1 << BITS) - 1)
    _branch(low, high, bits, np.arange(len(low)), members, nodes)
    faces = np.column_stack([features.planes, patches.of_faces])
    parts = [np.array(nodes), np.array(members), faces, triangles, edges, corners, np.concatenate([*stars, []])]
    begins = list(itertools.accumulate((part.size for part in parts), initial=13))
    head = (
        features.size,
        begins[0],
        len(nodes),
        *begins[1:4],
        len(triangles),
        begins[4],
        len(edges),
        *begins[5:7],
        len(faces),
        patches.count,
    )
    return SharedNumbers(np.concatenate([head, *(part.ravel() for part in parts)]))


def edge_rows(features: Features) -> Vector:
    """Return first end, direction, length, and in either face the direction into it, of all convex edges, [n, 13]."""
    edges = np.array(features.edges, dtype=int).reshape(-1, 4)
    start, way = features.vertices[edges[:, 0]], features.vertices[edges[:, 1]] - features.vertices[edges[:, 0]]
    length = np.linalg.norm(way, axis=1, keepdims=True)
    along = way / length
    left, right = features.planes[edges[:, 2], :3], features.planes[edges[:, 3], :3]
    return np.hstack([start, along, length, np.cross(left, along), np.cross(along, right)])


def edge_row(features: Features, number: int) -> Numbers:
    """Return first end, direction, length, and in either face the direction from the edge into it."""
    one, two, left, right = features.edges[number]
    start, end = features.vertices[one].tolist(), features.vertices[two].tolist()
    way = [y - x for x, y in zip(start, end, strict=True)]
    length = math.hypot(*way)
    along = [x / length for x in way]
    inward = *_cross(features.planes[left].tolist(), along), *_cross(along, features.planes[right].tolist())
    return *start, *along, length, *inward


def _cross(a: Sequence[float], b: Sequence[float]) -> Numbers:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def star_of(features: Features, number: int) -> list[float]:
    """Return the unit vectors along the edges of a corner, one after the other."""
    ways = features.vertices[list(features.stars[number])] - features.vertices[features.corners[number]]
    return [float(x) for x in (ways / np.linalg.norm(ways, axis=1)[:, None]).ravel()]


def star_lengths(features: Features, number: int) -> list[float]:
    """Return the lengths of the edges of a corner [m]."""
    ways = features.vertices[list(features.stars[number])] - features.vertices[features.corners[number]]
    return [float(x) for x in np.linalg.norm(ways, axis=1)]


def _triangles(features: Features) -> Vector:
    corners = features.vertices[features.triangles]
    normals = features.planes[features.face_of, :3]
    along = np.roll(corners, -1, axis=1) - corners
    along /= np.linalg.norm(along, axis=2)[:, :, None]
    out = np.cross(along, normals[:, None])
    heights = np.einsum("nij,nij->ni", out, corners)
    # out of the body at an edge: between both normals; at a vertex: by the angles of its triangles
    pairs = neighbours(features.triangles)
    at_edges = np.repeat(normals, 3, axis=0)
    between = at_edges[pairs[:, 0]] + at_edges[pairs[:, 1]]
    at_edges[pairs[:, 0]] = at_edges[pairs[:, 1]] = between
    angles = np.arccos(np.clip(-np.einsum("nij,nij->ni", along, np.roll(along, 1, axis=1)), -1.0, 1.0))
    at_vertices = np.zeros_like(features.vertices)
    np.add.at(at_vertices, features.triangles.reshape(-1), angles.reshape(-1, 1) * np.repeat(normals, 3, axis=0))
    return np.hstack(
        [
            corners.reshape(-1, 9),
            features.face_of[:, None],
            np.concatenate([out, heights[:, :, None]], axis=2).reshape(-1, 12),
            np.logical_not(features.inner),
            at_edges.reshape(-1, 9),
            at_vertices[features.triangles].reshape(-1, 9),
        ]
    )


def _branch(
    low: Vector, high: Vector, bits: Integers, own: Integers, members: list[int], nodes: list[list[float]]
) -> None:
    """Append the nodes of a tree over the boxes ``own``, the first one before what is in it."""
    box = [*np.min(low[own], axis=0).tolist(), *np.max(high[own], axis=0).tolist()]
    node = [*box, 0.0, float(len(members)), 0.0, float(np.bitwise_or.reduce(bits[own]))]
    nodes.append(node)
    if len(own) <= _LEAF:
        node[8] = float(len(own))
        members += own.tolist()
    else:
        middles = low[own] + high[own]
        axis = int(np.argmax(np.ptp(middles, axis=0)))
        order = own[np.argsort(middles[:, axis], kind="stable")]
        for half in (order[: len(order) // 2], order[len(order) // 2 :]):
            _branch(low, high, bits, half, members, nodes)
    node[6] = float(len(nodes))
