"""Packs a surface, convex or not, into one array for compiled functions, and reads its rows.

The array holds the faces, triangles, convex edges and corners of the surface, and a tree of their bounding boxes.
"""

from __future__ import annotations

import itertools
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from nonsmooth.compiled import block_at, compiled
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import SharedNumbers
from nonsmooth.types import Floats

from ...meshes.features import FLAT, Features
from ...meshes.patches import Patches
from ...meshes.topology import Integers, neighbours
from ...vectors import Vector3, dot, vector_at
from ..features.edge_vertex import Vertex

Numbers = tuple[float, ...]

SIZE, NODES, N_NODES, MEMBERS, FACES, TRIANGLES, N_TRIANGLES, EDGES, N_EDGES, CORNERS, STARS, N_FACES, N_PATCHES = (
    range(13)
)
N_CORNERS, SWEEP, IS_CONVEX = 13, 14, 15
"""Indices in the head of a surface's numbers.

``SIZE`` is the index of the size [m].  Names that begin with ``N_`` are indices of a number of rows or of patches.
``SWEEP`` is that of the radius about the surface [m], ``IS_CONVEX`` that of 1 for a convex surface, else 0.  The others
are indices of the offset at which the rows of that name begin.
"""
_HEAD = 16
"""Length of the head."""
NODE, FACE, TRIANGLE, EDGE, CORNER = 10, 7, 43, 16, 6
"""Number of floats in the row of each kind.  Numbers in brackets count floats, if there are several.

=========  ============================================================================================
row        contents, in this order
=========  ============================================================================================
node       lowest corner of its box (3) [m]; highest corner (3) [m]; number of the node after its
           subtree; index of its list of members; number of its members, 0 unless it is a leaf; the
           patches of all features in its subtree, one bit for each patch
face       outward normal (3); distance of its plane from the origin [m]; number of its patch; numbers
           of its first triangle and of its triangles, which follow one another
triangle   vertices (9) [m]; number of its face; for each edge the outward normal in the plane (3) and
           the edge's distance from the origin along it [m]; for each edge where the face ends there
           (``INSIDE``, ``CONVEX``, ``CONCAVE``); outward normals, of any length, at the edges (9) and at
           the vertices (9): they give the sign of the distance of a point
edge       first end (3) [m]; unit vector along it (3); length [m]; unit vectors from the edge into its
           two faces (6); number of its patch; lengths by which the body extends past the first and the
           second end (2) [m]: 0 at a corner, else the size of the surface
corner     position (3) [m]; number of its patch; index of the unit vectors along its edges; number of
           its edges
=========  ============================================================================================

The members of a node are the features in its box, by number: triangles first, then convex edges, then corners.
"""
UPPER, SKIP, FIRST_MEMBER, N_MEMBERS, PATCH_BITS = 3, 6, 7, 8, 9
"""Offsets in the row of a node: highest corner, node after its subtree, list and number of its members, its patches."""
_OFFSET, _FACE_PATCH, _FIRST_TRIANGLE, _N_OF_FACE = 3, 4, 5, 6
"""Offsets in the row of a face: distance of its plane, number of its patch, first triangle and number of triangles."""
FACE_NUMBER, EDGE_PLANES, BORDERS = 9, 10, 22
"""Offsets in the row of a triangle: number of its face, planes at its edges, kinds of its edges."""
_EDGE_PATCH, EXTENSIONS = 13, 14
"""Offsets in the row of an edge after those of a core's edge: number of its patch, extensions past both ends."""
_CORNER_PATCH, STAR, _N_STAR = 3, 4, 5
"""Offsets in the row of a corner: number of its patch, index and number of the unit vectors along its edges."""
INSIDE, CONVEX, CONCAVE = 0.0, 1.0, 2.0
"""Kinds of edges of a triangle: inside of its face, or on the border of the face, where the next face bends down or up.
"""
ON_FACE, ON_EDGE, ON_CORNER = 0, 1, 2
"""Kinds of features of a surface."""
BITS = 52
"""Largest number of patches whose bits a float stores exactly, one bit for each patch.

With more patches, a node of the tree does not know its patches, and a search visits it for every patch.
"""
_LEAF = 4
"""Largest number of features in a leaf of the tree."""


class Solid(NamedTuple):
    """A body with a surface, at its place in the world."""

    frame: Floats
    """Frame block of the body."""
    surface: Floats
    """Its surface."""


@compiled
def are_convex(one: Solid, other: Solid) -> bool:
    """Return whether two bodies are convex."""
    return one.surface[IS_CONVEX] * other.surface[IS_CONVEX] > 0.0


@compiled
def _face_at(surface: Floats, face: int) -> Floats:
    """Return the row of a face."""
    return block_at(surface, int(surface[FACES]) + FACE * face)


@compiled
def normal_of(surface: Floats, face: int) -> Vector3:
    """Return the outward unit normal of a face."""
    return vector_at(_face_at(surface, face), 0)


@compiled
def face_height(surface: Floats, face: int, point: Vector3) -> float:
    """Return the height of a point over the plane of a face [m]."""
    row = _face_at(surface, face)
    return float(dot(vector_at(row, 0), point) - row[_OFFSET])


@compiled
def triangles_of(surface: Floats, face: int) -> tuple[Floats, int]:
    """Return the row of the first triangle of a face, which the others follow, and the number of its triangles."""
    row = _face_at(surface, face)
    return block_at(surface, int(surface[TRIANGLES]) + TRIANGLE * int(row[_FIRST_TRIANGLE])), int(row[_N_OF_FACE])


@compiled
def edge_at(surface: Floats, edge: int) -> Floats:
    """Return the row of a convex edge."""
    return block_at(surface, int(surface[EDGES]) + EDGE * edge)


@compiled
def corner_row(surface: Floats, corner: int) -> Floats:
    """Return the row of a corner."""
    return block_at(surface, int(surface[CORNERS]) + CORNER * corner)


@compiled
def corner_at(surface: Floats, corner: int) -> Vertex:
    """Return a corner, in the axes of the surface."""
    row = corner_row(surface, corner)
    return Vertex(vector_at(row, 0), row[_N_STAR], block_at(surface, int(surface[STARS]) + int(row[STAR])))


@compiled
def feature_of(surface: Floats, member: int) -> tuple[int, int, Floats]:
    """Return kind, number and row of the feature of a member of the tree; of a face, the row is that of a triangle."""
    edge = member - int(surface[N_TRIANGLES])
    if edge < 0:
        row = block_at(surface, int(surface[TRIANGLES]) + TRIANGLE * member)
        return ON_FACE, int(row[FACE_NUMBER]), row
    corner = edge - int(surface[N_EDGES])
    if corner < 0:
        return ON_EDGE, edge, edge_at(surface, edge)
    return ON_CORNER, corner, corner_row(surface, corner)


@compiled
def patch_of(surface: Floats, member: int) -> float:
    """Return the number of the patch to which the feature of a member of the tree belongs."""
    kind, number, row = feature_of(surface, member)
    if kind == ON_FACE:
        return float(_face_at(surface, number)[_FACE_PATCH])
    return float(row[_EDGE_PATCH if kind == ON_EDGE else _CORNER_PATCH])


_NUMBERS: WeakKeyDictionary[Features, dict[tuple[Patches, float], SharedNumbers]] = WeakKeyDictionary()
"""Numbers that were made, as long as their surface exists: contacts with the same object share one copy."""


def surface_numbers(features: Features, patches: Patches, sweep: float) -> SharedNumbers:
    """Return the numbers of a surface whose features are divided into patches, with a radius ``sweep`` about it [m].

    They are: head, rows, unit vectors at corners.
    """
    made = _NUMBERS.setdefault(features, {})
    if (patches, sweep) not in made:
        made[patches, sweep] = _numbers(features, patches, sweep)
    return made[patches, sweep]


def _numbers(features: Features, patches: Patches, sweep: float) -> SharedNumbers:
    """Return the numbers that :func:`surface_numbers` describes."""
    # the triangles of a face follow one another
    order = np.argsort(features.face_of, kind="stable")
    counts = np.bincount(features.face_of, minlength=len(features.planes))
    triangles = _triangles(features)[order]
    ends_of = np.array(features.edges, dtype=int).reshape(-1, 4)[:, :2]
    beyond = np.where(np.isin(ends_of, features.corners), 0.0, features.size)
    edges = np.column_stack([_edge_rows(features), np.array(patches.of_edges, dtype=float), beyond])
    lengths = np.array([len(star) for star in features.stars], dtype=int)
    tips = features.vertices[list(features.corners)]
    corners = np.column_stack([tips, patches.of_corners, 3 * (np.cumsum(lengths) - lengths), lengths])
    ways = features.vertices[list(itertools.chain(*features.stars))] - np.repeat(tips, lengths, axis=0)
    stars = ways / np.linalg.norm(ways, axis=1)[:, None]
    ends = features.vertices[ends_of]
    boxes = [features.vertices[features.triangles[order]], ends, tips[:, None]]
    low = np.concatenate([box.min(axis=1) for box in boxes])
    high = np.concatenate([box.max(axis=1) for box in boxes])
    members, nodes = list[int](), list[list[float]]()
    of_faces = np.array(patches.of_faces, dtype=int)
    owners = np.concatenate([of_faces[features.face_of[order]], patches.of_edges, patches.of_corners]).astype(np.int64)
    bits = np.left_shift(1, owners) if patches.count <= BITS else np.full(len(owners), (1 << BITS) - 1)
    _branch(low, high, bits, np.arange(len(low)), members, nodes)
    faces = np.column_stack([features.planes, patches.of_faces, np.cumsum(counts) - counts, counts])
    parts = [np.array(nodes), np.array(members), faces, triangles, edges, corners, stars]
    begins = list(itertools.accumulate((part.size for part in parts), initial=_HEAD))
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
        len(corners),
        sweep,
        float(features.is_convex),
    )
    return SharedNumbers(np.concatenate([head, *(part.ravel() for part in parts)]))


def _edge_rows(features: Features) -> Vector:
    """Return a row for each convex edge, shape [n, 13]: the first numbers of an ``EDGE`` row."""
    edges = np.array(features.edges, dtype=int).reshape(-1, 4)
    start, way = features.vertices[edges[:, 0]], features.vertices[edges[:, 1]] - features.vertices[edges[:, 0]]
    length = np.linalg.norm(way, axis=1, keepdims=True)
    along = way / length
    # a segment has no faces
    normals = np.vstack([features.planes[:, :3], np.zeros(3)])[edges[:, 2:]]
    return np.hstack([start, along, length, np.cross(normals[:, 0], along), np.cross(along, normals[:, 1])])


def star_lengths(features: Features, number: int) -> list[float]:
    """Return the lengths of the edges of a corner [m], in the order of its unit vectors."""
    ways = features.vertices[list(features.stars[number])] - features.vertices[features.corners[number]]
    return [float(x) for x in np.linalg.norm(ways, axis=1)]


def part_names(features: Features, kind: str = "") -> list[str]:
    """Return the names of all faces, edges and corners by number, or of those of a kind; a segment's edge is a side."""
    edge = "edge" if len(features.planes) > 0 else "side"
    counts = ("face", len(features.planes)), (edge, len(features.edges)), ("corner", len(features.corners))
    return [f"{name} {i}" for name, n in counts for i in range(n) if kind in ("", "edge" if name == edge else name)]


def _triangles(features: Features) -> Vector:
    """Return the rows of all triangles, shape [n, 43]."""
    corners = features.vertices[features.triangles]
    normals = features.planes[features.face_of, :3]
    along = np.roll(corners, -1, axis=1) - corners
    along /= np.linalg.norm(along, axis=2)[:, :, None]
    out = np.cross(along, normals[:, None])
    heights = np.einsum("nij,nij->ni", out, corners)
    # outward vectors: at an edge the sum of both normals, at a vertex the normals weighted by the triangles' angles
    pairs = neighbours(features.triangles)
    at_edges = np.repeat(normals, 3, axis=0)
    between = at_edges[pairs[:, 0]] + at_edges[pairs[:, 1]]
    at_edges[pairs[:, 0]] = at_edges[pairs[:, 1]] = between
    # at a concave edge the normal of the next face leads back over the triangle
    is_concave = np.einsum("nij,nij->ni", out, at_edges.reshape(-1, 3, 3)) < -FLAT
    angles = np.arccos(np.clip(-np.einsum("nij,nij->ni", along, np.roll(along, 1, axis=1)), -1.0, 1.0))
    at_vertices = np.zeros_like(features.vertices)
    np.add.at(at_vertices, features.triangles.reshape(-1), angles.reshape(-1, 1) * np.repeat(normals, 3, axis=0))
    return np.hstack(
        [
            corners.reshape(-1, 9),
            features.face_of[:, None],
            np.concatenate([out, heights[:, :, None]], axis=2).reshape(-1, 12),
            np.where(features.inner, INSIDE, np.where(is_concave, CONCAVE, CONVEX)),
            at_edges.reshape(-1, 9),
            at_vertices[features.triangles].reshape(-1, 9),
        ]
    )


def _branch(
    low: Vector, high: Vector, bits: Integers, own: Integers, members: list[int], nodes: list[list[float]]
) -> None:
    """Append a tree of bounding boxes over the features ``own`` to ``nodes``: the root, then its halves, depth first.

    ``low`` and ``high`` are the corners of the boxes of all features [m], ``bits`` their patches as bits, and ``own``
    indices into these arrays.  The features of the leaves are appended to ``members``.
    """
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
