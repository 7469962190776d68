"""Contact of an edge of the second body that crosses the side of a cylinder or a cone."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.engine.memory.blocks import SIDE_A
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.frustum import COS, LOW, SIDE, SIN, SWEEP, Frustum
from ...shapes.polyhedron import SweptPolytope
from ..features.polytope_tables import LENGTH, ConvexCore, Numbers, edge_rows
from ..features.writing import write_sweep
from ..smooth.smooth_core import axes_in_world, forth
from .frustum import FLANK, center_in_world, seen_by, write_part
from .frustum_writing import (
    astray_of_edge,
    edge_in_frustum,
    past_end,
    size_of_both,
    write_crossing,
)


def evaluate_flank_edge(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    edge: Floats,
    radius: float,
    n_faces: float,
    faces: Floats,
    n_vertices: float,
    vertices: Floats,
    size: float,
) -> None:
    """Write the geometry block of a frustum's side and an edge, rounded by ``radius`` [m], that crosses the side."""
    axes = axes_in_world(a, frustum)
    cx, cy, cz = center_in_world(a, frustum)
    vx, vy, vz, dx, dy, dz = edge_in_frustum(b, edge, axes, cx, cy, cz)
    cosine, sine = frustum[COS], frustum[SIN]
    reach = cosine * frustum[0] + sine * frustum[LOW]
    # e: direction from the axis, with a normal of the side perpendicular to the edge: cosine (d . e) + sine d_z = 0
    across = math.sqrt(dx * dx + dy * dy)
    if across > 0.0:
        fx, fy = dx / across, dy / across
        ratio = -sine * dz / (cosine * across)
    else:
        fx, fy, ratio = 1.0, 0.0, 0.0 if sine == 0.0 else -math.copysign(2.0, sine * dz)
    part = min(max(ratio, -1.0), 1.0)
    other = math.sqrt(1.0 - part * part)
    gap, ex, ey = -math.inf, 1.0, 0.0
    for sign in (-1.0, 1.0):
        gx, gy = part * fx - sign * other * fy, part * fy + sign * other * fx
        found = cosine * (gx * vx + gy * vy) + sine * vz - reach
        if found > gap:
            gap, ex, ey = found, gx, gy
    # place on the edge that lies in the direction e from the axis
    crossing = dy * ex - dx * ey
    s = 0.5 * edge[LENGTH]
    if abs(crossing) > 1e-6:
        s = -(vy * ex - vx * ey) / crossing
    px, py, pz = vx + s * dx, vy + s * dy, vz + s * dz
    nx, ny, nz = cosine * ex, cosine * ey, sine
    away = ex * px + ey * py - gap * cosine
    up = cosine * (pz - gap * nz - frustum[LOW]) - sine * (away - frustum[0])
    over = max(max(-s, s - edge[LENGTH]), max(-up, up - frustum[SIDE]))
    if abs(ratio) > 1.0 or abs(crossing) <= 1e-6:
        # no normal of the side is perpendicular to the edge, or the edge is parallel to the side: no valid crossing
        over = size
    qx, qy, qz = forth(axes, (px - gap * nx, py - gap * ny, pz - gap * nz))
    steep, astray = abs(crossing), astray_of_edge(b, edge, axes, nx, ny, nz)
    past = past_end(a, b, frustum, n_faces, faces, n_vertices, vertices, gap, over, steep, astray, size)
    qx, qy, qz = cx + qx, cy + qy, cz + qz
    write_crossing(a, b, out, frustum, axes, edge, radius, gap, past, steep, (nx, ny, nz), (qx, qy, qz))
    ux, uy, uz = forth(axes, (ex, ey, 0.0))
    write_part(out, SIDE_A, FLANK, (axes[2], axes[5], axes[8]), (ux, uy, uz), cosine, max(away, 0.0))
    write_sweep(out, SIDE_A, frustum[SWEEP])


@final
@dataclass(frozen=True)
class FlankEdge(ContactKinematics):
    """Contact of an edge of the second body that crosses the side of the first.

    Attributes
    ----------
    frustum : tuple of float
        The first body (:func:`bodies.shapes.frustum.frustum_numbers`).
    edge : tuple of float
        Row of the edge (:data:`bodies.contacts.features.polytope_tables.EDGE`).
    radius : float
        Radius of the rounding about the edge [m]; 0 for a sharp polyhedron.
    core : ConvexCore
        Faces and vertices of the second body's core; empty for a surface that need not be convex.
    size : float
        Size of the bodies [m].
    name : str
        Name of the edge.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, SweptPolytope)

    frustum: Numbers
    edge: Numbers
    radius: float
    core: ConvexCore
    size: float
    name: str

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return one contact for each edge; empty for a disc, which has no side."""
        assert isinstance(first, Frustum)
        assert isinstance(second, SweptPolytope)
        numbers = seen_by(first, second.core)
        if numbers[SIDE] == 0.0:
            return ()
        size, core, rows = size_of_both(first, second), ConvexCore.of(second.core), enumerate(edge_rows(second.core))
        return tuple(cls(numbers, row, second.sweep, core, size, f"edge {i}") for i, row in rows)

    def parameters(self) -> dict[str, Value]:
        """Return the numbers of both bodies by the names of the evaluator's arguments."""
        return {
            "frustum": self.frustum,
            "edge": self.edge,
            "radius": self.radius,
            **self.core.values(),
            "size": self.size,
        }

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return evaluate_flank_edge

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features."""
        return (f"side and {self.name}",)
