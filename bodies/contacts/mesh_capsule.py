"""A capsule against a triangle mesh, convex or not: its ends are spheres, its side meets convex edges and corners."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar, final

import numpy as np

from bodies.contacts.curvature import SIDE_A, SIDE_B, write_principal, write_round
from bodies.contacts.frames import point_in_world, vector_in_body, vector_in_world
from bodies.contacts.mesh_sphere import MeshSphere
from bodies.contacts.surface_search import depth_inside
from bodies.contacts.surface_tables import SIZE, Numbers, edge_row, star_of
from bodies.contacts.surface_vertex import ASTRAY
from bodies.contacts.tangents import write_tangent
from bodies.contacts.vertex_face import DEEP, REACH
from bodies.shapes.capsule import Capsule
from bodies.shapes.sphere import Sphere
from bodies.shapes.triangle_mesh import TriangleMesh
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

_PARALLEL = 0.01
"""Sine of the angle between axis and edge below which they do not cross; then the ends hold all the same."""


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    surface: Floats,
    place: Floats,
    length_a: float,
    n_ways: float,
    ways: Floats,
    segment: Floats,
    radius: float,
) -> None:
    """Write the block of the side of a capsule and an edge; a corner is an edge without length.

    ``place`` holds a point and a direction of the edge, ``ways`` vectors with which no normal makes an acute angle,
    ``segment`` low end, direction and length of the axis.
    """
    ax, ay, az = point_in_world(a, place[0], place[1], place[2])
    bx, by, bz = point_in_world(b, segment[0], segment[1], segment[2])
    ex, ey, ez = vector_in_world(a, place[3], place[4], place[5])
    fx, fy, fz = vector_in_world(b, segment[3], segment[4], segment[5])
    wx, wy, wz = bx - ax, by - ay, bz - az
    size, margin = surface[SIZE], REACH * surface[SIZE]
    s, past = 0.0, -size
    t = -(wx * fx + wy * fy + wz * fz)
    if length_a > 0.0:
        cosine = ex * fx + ey * fy + ez * fz
        square = 1.0 - cosine * cosine
        past = size * (_PARALLEL - math.sqrt(max(square, 0.0)))
        if past <= 0.0:
            along = wx * ex + wy * ey + wz * ez
            s = (along + cosine * t) / square
            t += cosine * s
            past = max(-s, s - length_a) - margin
    past = max(past, max(-t, t - segment[6]) - margin)
    crossed = past
    px, py, pz = ax + s * ex, ay + s * ey, az + s * ez
    nx, ny, nz = bx + t * fx - px, by + t * fy - py, bz + t * fz - pz
    distance = math.sqrt(nx * nx + ny * ny + nz * nz)
    nx, ny, nz = nx / distance, ny / distance, nz / distance
    mx, my, mz = vector_in_body(a, nx, ny, nz)
    for i in range(int(n_ways)):
        past = max(past, size * (mx * ways[3 * i] + my * ways[3 * i + 1] + mz * ways[3 * i + 2] - ASTRAY))
    gap = distance - radius
    if past > 0.0:
        gap = math.sqrt(gap * gap + past * past)
        if crossed <= 0.0:
            x, y, z = vector_in_body(a, bx + t * fx - a[0], by + t * fy - a[1], bz + t * fz - a[2])
            depth = depth_inside(surface, x, y, z)
            if depth > DEEP * size:
                # the axis is inside, which is a sign that a contact was passed
                gap = -depth - radius
    out[0], out[29], out[30] = gap, 0.0, past
    out[1], out[2], out[3] = nx, ny, nz
    out[7], out[8], out[9] = px, py, pz
    for i in range(3):
        out[10 + i] = out[7 + i] + gap * out[1 + i]
    write_tangent(a, out)
    if length_a > 0.0:
        write_principal(out, SIDE_A, ex, ey, ez, 0.0, 1.0, 1.0, 0.0)
    else:
        write_round(out, SIDE_A, 0.0)
    write_principal(out, SIDE_B, fx, fy, fz, 0.0, 1.0, 1.0, radius)


@final
@dataclass(frozen=True)
class MeshCapsule(ContactKinematics):
    """The side of a capsule on a convex edge of a mesh, or on a corner, which is an edge without length.

    A capsule that lies on a face is held by its ends, which are contacts of spheres (:class:`MeshSphere`); where it
    lies across an edge or on a corner, its side is.

    Attributes
    ----------
    surface : tuple of float
        The surface (:mod:`bodies.contacts.surface_tables`).
    place : tuple of float
        A point of the edge [m] and its direction.
    length : float
        Its length [m].
    ways : tuple of float
        Vectors with which no normal of the edge makes an acute angle, one after the other.
    segment : tuple of float
        Low end of the axis [m], its direction, and its length [m].
    radius : float
        Of the capsule [m].
    name : str
        What the edge or corner is called.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (TriangleMesh, Capsule)
    departures: ClassVar[Mapping[str, str]] = MappingProxyType(
        dict.fromkeys(
            ("gap rate", "second-order terms"),
            "side and edge face each other in few random poses; the tests make poses in which they do",
        )
    )
    surface: Numbers
    place: Numbers
    length: float
    ways: Numbers
    segment: Numbers
    radius: float
    name: str

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contacts of both ends with the patches, then those of the side with edges and corners."""
        assert isinstance(first, TriangleMesh)
        assert isinstance(second, Capsule)
        own, radius = first.features, second.radius
        ends = [contact for end in second.ends for contact in MeshSphere.between(first, Sphere(radius, *end))]
        low, high = (np.array(end) for end in second.ends)
        length = float(np.linalg.norm(high - low))
        segment = *low.tolist(), *((high - low) / length).tolist(), length
        surface = ends[0].surface
        rows = [edge_row(own, i) for i in range(len(own.edges))]
        edges = [cls(surface, row[:6], row[6], row[7:], segment, radius, f"edge {i}") for i, row in enumerate(rows)]
        tips = own.vertices[list(own.corners)].tolist()
        corners = [
            cls(surface, (*tip, 0.0, 0.0, 1.0), 0.0, tuple(star_of(own, i)), segment, radius, f"corner {i}")
            for i, tip in enumerate(tips)
        ]
        return *ends, *edges, *corners

    def parameters(self) -> dict[str, Value]:
        """Return the surface, the edge and the capsule."""
        return {
            "surface": self.surface,
            "place": self.place,
            "length_a": self.length,
            "n_ways": float(len(self.ways) // 3),
            "ways": self.ways,
            "segment": self.segment,
            "radius": self.radius,
        }

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """The only pair."""
        return (f"{self.name} and side",)
