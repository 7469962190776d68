"""Meshes for drawing: bars, arrows, dots and pieces of planes, and their normals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.histories.arrays import Floats, Integers

_SIDES, _RINGS = 12, 6
"""Number of flat sides around a round bar, and of pieces along it.  A picture sorts pieces by depth, so that a bar is
drawn correctly if another mesh covers a part of it."""
_CREASE = np.cos(0.6)
"""Cosine of 0.6 rad: two faces at a larger angle have a visible edge between them."""


@final
@dataclass(frozen=True, eq=False)
class ShadedMesh:
    """Triangles, each with a shade of one colour.

    Attributes
    ----------
    vertices : array
        Vertices [m], shape [n, 3].
    triangles : array
        Numbers of three vertices, counter-clockwise seen from outside, shape [m, 3].
    shade : array
        Brightness of each triangle, 1 for the colour itself, shape [m].
    """

    vertices: Floats
    triangles: Integers
    shade: Floats

    @classmethod
    def of(cls, vertices: Floats, triangles: Integers) -> ShadedMesh:
        """Mesh with the shade 1 everywhere."""
        return cls(vertices, triangles, np.ones(len(triangles)))


def bar(first: Floats, last: Floats, radius: float) -> ShadedMesh:
    """Round bar from one point to another [m], shape [3] each; they must differ."""
    turn = 2.0 * np.pi * np.arange(_SIDES) / _SIDES
    ring = radius * np.column_stack([0.0 * turn, np.cos(turn), np.sin(turn)])
    along = np.linalg.norm(last - first) * np.linspace(0.0, 1.0, _RINGS + 1)
    points = (ring + along[:, None, None] * [1.0, 0.0, 0.0]).reshape(-1, 3)
    ends = np.array([[0.0, 0.0, 0.0], [along[-1], 0.0, 0.0]])
    i = np.arange(_SIDES * _RINGS)
    j = i - i % _SIDES + (i + 1) % _SIDES
    sides = np.concatenate([np.column_stack([i, i + _SIDES, j]), np.column_stack([j, i + _SIDES, j + _SIDES])])
    i, j, n = i[:_SIDES], j[:_SIDES], _SIDES * _RINGS
    caps = [np.column_stack([i, j, 0 * i + len(points)]), np.column_stack([j + n, i + n, 0 * i + len(points) + 1])]
    axes = along_axes((last - first)[None])[0]
    return ShadedMesh.of(first + np.concatenate([points, ends]) @ axes.T, np.concatenate([sides, *caps]))


def arrow() -> ShadedMesh:
    """Arrow of length 1 from the origin along the first axis."""
    shaft, head = bar(np.zeros(3), np.array([0.75, 0.0, 0.0]), 0.03), bar(np.array([0.7, 0.0, 0.0]), np.eye(3)[0], 0.09)
    # the bar that is its head narrows to a point
    point = head.vertices * np.column_stack([np.ones(len(head.vertices)), *2 * [(1.0 - head.vertices[:, 0]) / 0.3]])
    return ShadedMesh.of(
        np.concatenate([shaft.vertices, point]), np.concatenate([shaft.triangles, head.triangles + len(shaft.vertices)])
    )


def along_axes(ways: Floats) -> Floats:
    """Axes as columns, shape [n, 3, 3]; the first axis has the direction of ``ways``, shape [n, 3].

    The axes turn no more than the directions do.  A zero vector is replaced by the direction x.
    """
    length = np.linalg.norm(ways, axis=1, keepdims=True)
    first = np.where(length > 0.0, ways / np.where(length > 0.0, length, 1.0), [1.0, 0.0, 0.0])
    aside = np.eye(3)[np.argmin(np.max(np.abs(first), axis=0))]
    third = np.cross(first, aside)
    still = np.linalg.norm(third, axis=1, keepdims=True) < 1e-9
    third = np.where(still, np.cross(first, np.roll(aside, 1)), third)
    third /= np.linalg.norm(third, axis=1, keepdims=True)
    return np.stack([first, np.cross(third, first), third], axis=2)


def dot(place: Floats, radius: float) -> ShadedMesh:
    """Octahedron about a point [m], shape [3]."""
    corners = place + radius * np.concatenate([np.eye(3), -np.eye(3)])
    upper = [(0, 1, 2), (1, 3, 2), (3, 4, 2), (4, 0, 2)]
    lower = [(b, a, 5) for a, b, _ in upper]
    return ShadedMesh.of(corners, np.array(upper + lower))


def board(low: Floats, high: Floats, cell: float) -> ShadedMesh:
    """Rectangle at the height zero between two corners [m], shape [2] each, chequered in two shades."""
    n_x, n_y = np.maximum(1, np.ceil((high - low) / cell - 1e-9)).astype(int).tolist()
    x, y = np.meshgrid(low[0] + cell * np.arange(n_x + 1), low[1] + cell * np.arange(n_y + 1), indexing="ij")
    i, j = (one.ravel() for one in np.meshgrid(np.arange(n_x), np.arange(n_y), indexing="ij"))
    at = i * (n_y + 1) + j
    right = at + n_y + 1
    triangles = np.stack([np.column_stack([at, right, right + 1]), np.column_stack([at, right + 1, at + 1])], axis=1)
    vertices = np.column_stack([x.ravel(), y.ravel(), 0.0 * x.ravel()])
    return ShadedMesh(vertices, triangles.reshape(-1, 3), np.repeat(np.where((i + j) % 2, 0.93, 1.0), 2))


def face_normals(corners: Floats) -> Floats:
    """Unit normals of triangles with corners of shape [m, 3, 3]; zero for a triangle without area."""
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    return np.asarray(normal / np.where(size > 0.0, size, 1.0))


def corner_normals(mesh: ShadedMesh) -> Floats:
    """Unit normal at each corner of each triangle, shape [m, 3, 3], for smooth shading.

    It is the mean normal of those faces at the vertex whose angle to the triangle is less than 0.6 rad.  So the surface
    is shaded as smooth, except at sharp edges.
    """
    normals = face_normals(mesh.vertices[mesh.triangles])
    vertex, face = mesh.triangles.ravel(), np.repeat(np.arange(len(mesh.triangles)), 3)
    order = np.argsort(vertex, kind="stable")
    _, begin, size = np.unique(vertex[order], return_index=True, return_counts=True)
    begin, size = np.repeat(begin, size), np.repeat(size, size)
    own, total = normals[face[order]], np.zeros((len(order), 3))
    for k in range(int(size.max(initial=0))):
        other = normals[face[order[begin + k % size]]]
        total += np.where((k < size) & (np.einsum("ij,ij->i", own, other) > _CREASE), 1.0, 0.0)[:, None] * other
    length = np.linalg.norm(total, axis=1, keepdims=True)
    found = np.zeros_like(total)
    found[order] = np.where(length > 0.0, total / np.where(length > 0.0, length, 1.0), [0.0, 0.0, 1.0])
    return found.reshape(-1, 3, 3)
