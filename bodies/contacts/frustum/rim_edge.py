"""Contact of an edge that crosses a rim of a cylinder, a cone or a disc.

In the view along the edge, the rim is an ellipse and the edge is a point.  The nearest point of the ellipse is the foot
of a normal to the ellipse through that point.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import SIDE_A
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.frustum import COS, HIGH, LOW, SIDE, SIN, SWEEP, Frustum
from ...shapes.polyhedron import SweptPolytope
from ..features.polytope_tables import LENGTH, ConvexCore, Numbers, edge_rows
from ..features.writing import write_sweep
from ..smooth.smooth_core import axes_in_world, forth
from .frustum import HIGH_RIM, LOW_RIM, RIM_NAMES, center_in_world, seen_by, write_part
from .frustum_writing import (
    astray_of_edge,
    edge_in_frustum,
    past_end,
    size_of_both,
    write_crossing,
)

_STEEP = 0.5
"""Cosine of the angle between edge and axis, above which contacts are sought on the rim's half nearer to the edge.

The edge is then too steep to cross both halves of the rim.
"""
_STEPS = 100


@compiled
def foot_on_ellipse(semi_x: float, semi_y: float, x: float, y: float) -> tuple[float, float, float]:
    """Return the foot of the normal from (x, y) to the upper half of an ellipse: its cosine and sine, and a check.

    The foot is the point (semi_x cosine, semi_y sine); semi_x is at least semi_y.  The check is 0 if there is a foot
    with a local minimum of the distance, else positive.  A point (x, y) in the lower half-plane has such a foot only if
    it lies within the evolute of the ellipse; the check is then a measure of the distance from the evolute.  The foot
    is the zero of F = a x sin - b y cos - (a^2 - b^2) sin cos, with the semi-axes a and b, between bounds of opposite
    sign, by Newton's method and halvings.
    """
    p, q = semi_x * abs(x), semi_y * y
    focal = max(semi_x * semi_x - semi_y * semi_y, 0.0)
    low, none = 0.0, 0.0
    if q < 0.0:
        third_p, third_q = p ** (1.0 / 3.0), (-q) ** (1.0 / 3.0)
        reach = third_p * third_p + third_q * third_q
        none = max(math.sqrt(reach * reach * reach) - focal, 0.0)
        low = math.atan2(third_q, third_p)
    high = 0.5 * math.pi
    if none > 0.0:
        angle = low
    else:
        angle = math.atan2(max(q, 0.0) * semi_x, p * semi_y) if p + max(q, 0.0) > 0.0 else high
        if q <= 0.0:
            angle = math.acos(min(p / focal, 1.0)) if focal > 0.0 else high
        angle = min(max(angle, low), high)
        for _ in range(_STEPS):
            c, s = math.cos(angle), math.sin(angle)
            value = p * s - q * c - focal * s * c
            slope = p * c + q * s - focal * (c * c - s * s)
            if value > 0.0:
                high = angle
            else:
                low = angle
            after = angle - value / slope if slope > 0.0 else 2.0 * math.pi
            if after < low or after > high:
                after = 0.5 * (low + high)
            if abs(after - angle) <= 2e-16 * abs(angle):
                break
            angle = after
    c, s = math.cos(angle), math.sin(angle)
    return (c if x >= 0.0 else -c), s, none


def evaluate_rim_edge(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    rim: float,
    half: float,
    edge: Floats,
    radius: float,
    n_faces: float,
    faces: Floats,
    n_vertices: float,
    vertices: Floats,
    size: float,
) -> None:
    """Write the geometry block of an edge, rounded by ``radius`` [m], that crosses one half of a rim."""
    axes = axes_in_world(a, frustum)
    cx, cy, cz = center_in_world(a, frustum)
    vx, vy, vz, dx, dy, dz = edge_in_frustum(b, edge, axes, cx, cy, cz)
    part = int(rim)
    wide, height, up = frustum[0], frustum[LOW], -1.0
    if part == HIGH_RIM:
        wide, height, up = frustum[1], frustum[HIGH], 1.0
    # g: perpendicular to the edge, in the rim's plane; f: the edge's projection; h: perpendicular to g and the edge
    across = math.sqrt(dx * dx + dy * dy)
    fx, fy = (dx / across, dy / across) if across > 0.0 else (1.0, 0.0)
    gx, gy = -fy, fx
    hx, hy, hz = -dz * gy, dz * gx, dx * gy - dy * gx
    short = hx * fx + hy * fy
    if short < 0.0:
        hx, hy, hz, short = -hx, -hy, -hz, -short
    along = vx * gx + vy * gy
    over_rim = vx * hx + vy * hy + (vz - height) * hz
    # an edge nearly in the plane of the rim can cross both half circles: this contact takes the one given by ``half``
    side = half
    if short > _STEEP:
        side = half * (1.0 if over_rim >= 0.0 else -1.0)
    cosine, sine, none = foot_on_ellipse(wide, wide * short, along, side * over_rim)
    sine *= side
    ex, ey = cosine * gx + sine * fx, cosine * gy + sine * fy
    tx, ty = -ey, ex
    # the normal is perpendicular to the rim's tangent and to the edge
    nx, ny, nz = ty * dz, -tx * dz, tx * dy - ty * dx
    crossing = math.sqrt(nx * nx + ny * ny + nz * nz)
    px, py, pz = wide * ex, wide * ey, height
    s = (px - vx) * dx + (py - vy) * dy + (pz - vz) * dz
    wx, wy, wz = vx + s * dx - px, vy + s * dy - py, vz + s * dz - pz
    total = radius + frustum[SWEEP]
    if total == 0.0 and crossing > 1e-6:
        nx, ny, nz = nx / crossing, ny / crossing, nz / crossing
    else:
        # rounded bodies, or an edge along the rim's tangent: the normal is along the line between both points, or
        # radial if the points coincide
        apart = math.sqrt(wx * wx + wy * wy + wz * wz)
        nx, ny, nz = (wx / apart, wy / apart, wz / apart) if apart > 1e-9 * size else (ex, ey, 0.0)
    if total > 0.0:
        # a rounded edge along the tangent touches the rim at a single point, so the crossing is well defined
        crossing = 1.0
    ahead = nx * wx + ny * wy + nz * wz
    astray, flip = 2.0, 1.0
    for sign in (-1.0, 1.0):
        if total > 0.0 and sign * ahead < 0.0:
            # rounded bodies: the normal must point from the rim to the edge, so skip the opposite sign
            continue
        radial, axial = sign * (ex * nx + ey * ny), sign * nz
        off = max(-radial, astray_of_edge(b, edge, axes, sign * nx, sign * ny, sign * nz))
        if frustum[SIDE] > 0.0:
            off = max(off, -up * (frustum[COS] * axial - frustum[SIN] * radial))
        if off < astray:
            astray, flip = off, sign
    nx, ny, nz = flip * nx, flip * ny, flip * nz
    gap = flip * ahead
    over = max(-s, s - edge[LENGTH])
    if none > 0.0 or crossing <= 1e-6 or (short > _STEEP and half < 0.0):
        over = size
    qx, qy, qz = forth(axes, (px, py, pz))
    past = past_end(a, b, frustum, n_faces, faces, n_vertices, vertices, gap, over, crossing, astray, size)
    qx, qy, qz = cx + qx, cy + qy, cz + qz
    write_crossing(a, b, out, frustum, axes, edge, radius, gap, past, crossing, (nx, ny, nz), (qx, qy, qz))
    ux, uy, uz = forth(axes, (ex, ey, 0.0))
    write_part(out, SIDE_A, part, (axes[2], axes[5], axes[8]), (ux, uy, uz), ex * nx + ey * ny, wide)
    write_sweep(out, SIDE_A, frustum[SWEEP])


@final
@dataclass(frozen=True)
class RimEdge(ContactKinematics):
    """Contact of an edge of the second body that crosses one half of a rim of the first.

    An edge that lies across a cap crosses its rim twice, so that there are two contacts, one on either half.

    Attributes
    ----------
    frustum : tuple of float
        The first body, with its rims set back by its feet (:func:`bodies.contacts.frustum.frustum.set_back`).
    rim : int
        1 for the lower rim, 3 for the upper one.
    half : float
        1 for the half circle towards which the edge points, seen along the axis; -1 for the opposite half circle.  For
        an edge at less than 60 degrees to the axis, 1 is the half circle nearer to the edge, and -1 has no contact.
    edge : tuple of float
        Row of the edge (:data:`bodies.contacts.features.polytope_tables.EDGE`).
    radius : float
        Radius about the edge [m].
    core : ConvexCore
        Faces and vertices of the second body's core; empty for a surface that need not be convex.
    size : float
        Size of the bodies [m].
    name : str
        Name of the edge.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, SweptPolytope)

    frustum: Numbers
    rim: int
    half: float
    edge: Numbers
    radius: float
    core: ConvexCore
    size: float
    name: str

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contacts of both halves of each rim with each edge."""
        assert isinstance(first, Frustum)
        assert isinstance(second, SweptPolytope)
        numbers, core, size = seen_by(first, second.core), ConvexCore.of(second.core), size_of_both(first, second)
        return tuple(
            contact
            for i, row in enumerate(edge_rows(second.core))
            for contact in cls.of_rims(numbers, row, second.sweep, core, size, f"edge {i}")
        )

    @classmethod
    def of_rims(
        cls, frustum: Numbers, edge: Numbers, radius: float, core: ConvexCore, size: float, name: str
    ) -> tuple[RimEdge, ...]:
        """Return the contacts of both halves of each rim with one edge; a disc has one rim, an apex is not a rim."""
        rims = [LOW_RIM, HIGH_RIM] if frustum[SIDE] > 0.0 and frustum[1] > 0.0 else [LOW_RIM]
        return tuple(cls(frustum, rim, half, edge, radius, core, size, name) for rim in rims for half in (1.0, -1.0))

    def parameters(self) -> dict[str, Value]:
        """Return the numbers of both bodies by the names of the evaluator's arguments."""
        return {
            "frustum": self.frustum,
            "rim": float(self.rim),
            "half": self.half,
            "edge": self.edge,
            "radius": self.radius,
            **self.core.values(),
            "size": self.size,
        }

    @property
    def evaluator(self) -> Callable[..., None]:
        """Newton's method for one angle, between bounds."""
        return evaluate_rim_edge

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features."""
        return (f"{RIM_NAMES[self.rim]} and {self.name}",)
