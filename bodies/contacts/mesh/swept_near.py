"""Which corners of a surface are near a swept polyhedron or segment, and may touch it."""

from __future__ import annotations

import math

from bodies.contacts.features.frames import vector_in_body, vector_in_world
from bodies.contacts.features.nearest import nearest_feature
from bodies.contacts.surface.surface_near import seen_from
from bodies.contacts.surface.surface_tables import (
    CORNER,
    CORNERS,
    MEMBERS,
    N_EDGES,
    N_NODES,
    N_TRIANGLES,
    NODE,
    NODES,
    STARS,
)
from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import NORMAL
from nonsmooth.types import Floats


@compiled
def steepest(surface: Floats, corner: int, x: float, y: float, z: float) -> float:
    """Return how far a vector in the axes of a surface points along the edge of a corner that is most along it."""
    most, star = -math.inf, int(surface[STARS]) + int(surface[corner + 4])
    for _ in range(int(surface[corner + 5])):
        most = max(most, x * surface[star] + y * surface[star + 1] + z * surface[star + 2])
        star += 3
    return most


@compiled
def corners_over(
    a: Floats,
    b: Floats,
    surface: Floats,
    n_faces: float,
    faces: Floats,
    n_edges: float,
    edges: Floats,
    ends: Floats,
    sweep: float,
    reach: float,
    turn: float,
    kind: float,
    out: Floats,
    n: int,
    most: int,
) -> int:
    """Write the corners of the surface in ``a`` near a core in ``b`` behind ``n``; return how many there are.

    Of a corner that touches what is nearest lies along none of its edges.  The way there changes by no more than the
    corner moves, and by the turn of its edges.

    Parameters
    ----------
    a, b : Floats
        Frame blocks.
    surface : Floats
        Numbers of the surface.
    n_faces, faces, n_edges, edges, ends, sweep : float and Floats
        The core and the radius about it, as of :class:`bodies.contacts.features.swept_vertex.SweptVertex`.
    reach, turn, kind, out, n, most : float, Floats and int
        As of :func:`bodies.contacts.surface.surface_near.corners_near`.
    """
    first, members, node = int(surface[N_TRIANGLES]) + int(surface[N_EDGES]), int(surface[MEMBERS]), 0
    while node < int(surface[N_NODES]) and n <= most:
        at = int(surface[NODES]) + NODE * node
        dx, dy, dz = (
            0.5 * (surface[at + 3] - surface[at]),
            0.5 * (surface[at + 4] - surface[at + 1]),
            0.5 * (surface[at + 5] - surface[at + 2]),
        )
        x, y, z = seen_from(b, a, surface[at] + dx, surface[at + 1] + dy, surface[at + 2] + dz)
        found = nearest_feature(n_faces, faces, n_edges, edges, ends, x, y, z)
        if found[1] > sweep + reach + math.sqrt(dx * dx + dy * dy + dz * dz):
            node = int(surface[at + 6])
            continue
        for i in range(int(surface[at + 8])):
            corner = int(surface[members + int(surface[at + 7]) + i]) - first
            if corner < 0 or n > most:
                continue
            c = int(surface[CORNERS]) + CORNER * corner
            x, y, z = seen_from(b, a, surface[c], surface[c + 1], surface[c + 2])
            _, distance, nx, ny, nz, _ = nearest_feature(n_faces, faces, n_edges, edges, ends, x, y, z)
            if distance > sweep + reach:
                continue
            nx, ny, nz = vector_in_world(b, nx, ny, nz)
            nx, ny, nz = vector_in_body(a, nx, ny, nz)
            if distance <= 0.0 or distance * steepest(surface, c, -nx, -ny, -nz) <= reach + turn * distance:
                out[NORMAL + 3 * n], out[NORMAL + 1 + 3 * n], out[NORMAL + 2 + 3 * n] = kind, float(corner), 0.0
                n += 1
        node += 1
    return n
