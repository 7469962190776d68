"""Meshes for the tests: sound ones, and how to spoil them."""

from __future__ import annotations

import math
import struct
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Mesh = tuple[Array, Array]

BRACKET_OUTLINE = ((0.0, 0.0), (0.03, 0.0), (0.03, 0.01), (0.01, 0.01), (0.01, 0.02), (0.0, 0.02))
"""An L [m]: its area is 4e-4 m^2."""
CHANNEL_OUTLINE = (
    (0.0, 0.0),
    (0.04, 0.0),
    (0.04, 0.03),
    (0.03, 0.03),
    (0.03, 0.01),
    (0.01, 0.01),
    (0.01, 0.03),
    (0.0, 0.03),
)
"""A U, 2 cm wide and deep inside [m]."""


def box(x: float = 0.02, y: float = 0.03, z: float = 0.05, at: Any = (0.0, 0.0, 0.0)) -> Mesh:
    """Return a box with these sides [m] about a point."""
    signs = np.array([(i, j, k) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
    quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    faces = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return 0.5 * signs * [x, y, z] + np.array(at), np.array(faces)


def bracket(depth: float = 0.015) -> Mesh:
    """Return an L of this depth along z [m]."""
    return _prism(BRACKET_OUTLINE, ((0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)), depth)


def channel(depth: float = 0.02) -> Mesh:
    """Return a U of this depth along z [m]."""
    return _prism(CHANNEL_OUTLINE, ((0, 1, 4), (1, 2, 3), (1, 3, 4), (0, 4, 5), (0, 5, 6), (0, 6, 7)), depth)


def _prism(outline: Any, triangles: Any, depth: float) -> Mesh:
    n = len(outline)
    points = np.array([(x, y, z) for z in (0.0, depth) for x, y in outline])
    bottom = [(a, c, b) for a, b, c in triangles]
    top = [(a + n, b + n, c + n) for a, b, c in triangles]
    sides = [t for i in range(n) for j in [(i + 1) % n] for t in ((i, j, j + n), (i, j + n, i + n))]
    return points, np.array([*bottom, *top, *sides])


def torus(n: int = 24, m: int = 12, radius: float = 0.02, thickness: float = 0.008) -> Mesh:
    """Return a torus of n x m squares, each cut in two."""
    around, across = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    u, v = 2.0 * np.pi * around / n, 2.0 * np.pi * across / m
    r = radius + thickness * np.cos(v)
    points = np.stack([r * np.cos(u), r * np.sin(u), thickness * np.sin(v)], axis=-1).reshape(-1, 3)

    def at(i: Array, j: Array) -> Array:
        return np.asarray(i % n * m + j % m).ravel()

    a, b = at(around, across), at(around + 1, across)
    c, d = at(around + 1, across + 1), at(around, across + 1)
    return points, np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def together(*meshes: Mesh) -> Mesh:
    """Return the meshes as one, without common vertices."""
    starts = np.cumsum([0, *(len(points) for points, _ in meshes)])
    faces = [triangles + start for (_, triangles), start in zip(meshes, starts, strict=False)]
    return np.concatenate([points for points, _ in meshes]), np.concatenate(faces)


def write_stl(path: Path, mesh: Mesh, told: int | None = None) -> Path:
    """Write a binary STL; ``told`` is a number of triangles to write into its head instead of the true one."""
    points, faces = mesh
    count = len(faces) if told is None else told
    with path.open("wb") as file:
        file.write(b"\0" * 80 + struct.pack("<I", count))
        for a, b, c in np.asarray(points)[faces].astype("<f4"):
            file.write(np.concatenate([np.zeros(3, "<f4"), a, b, c]).tobytes() + b"\0\0")
        if told is not None:
            file.truncate(84 + 50 * told)
    return path


def turned(mesh: Mesh, angle: float = 0.7, shift: Any = (0.0, 0.0, 0.0)) -> Mesh:
    """Return the mesh turned about the axis (1, 2, 3), then shifted."""
    axis = np.array([1.0, 2.0, 3.0]) / math.sqrt(14.0)
    cross = np.cross(np.eye(3), axis)
    turn = np.eye(3) * math.cos(angle) - math.sin(angle) * cross + (1 - math.cos(angle)) * np.outer(axis, axis)
    return mesh[0] @ turn.T + np.array(shift), mesh[1]


def hills(n: int = 40) -> Mesh:
    """Return a block of 2 m whose upper side has hills and valleys of 3 cm, in 2 n^2 triangles there."""
    x = np.linspace(-1.0, 1.0, n + 1)
    wide, deep = (grid.ravel() for grid in np.meshgrid(x, x, indexing="ij"))
    over = np.column_stack([wide, deep, 0.03 * np.sin(9.0 * wide) * np.cos(7.0 * deep)])
    points = np.concatenate([over, np.column_stack([wide, deep, np.full(len(wide), -0.2)])])
    first = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    lower = np.column_stack([first, first + n + 1, first + n + 2])
    upper = np.concatenate([lower, np.column_stack([first, first + n + 2, first + 1])])
    k, below, side = np.arange(n), (n + 1) ** 2, (n + 1) * n
    borders = [
        (k * (n + 1), (k + 1) * (n + 1)),
        ((k + 1) * (n + 1) + n, k * (n + 1) + n),
        (k + 1, k),
        (side + k, side + k + 1),
    ]
    walls = [np.column_stack(face) for a, b in borders for face in ((a, a + below, b), (b, a + below, b + below))]
    return points, np.concatenate([upper, upper[:, ::-1] + below, *walls])
