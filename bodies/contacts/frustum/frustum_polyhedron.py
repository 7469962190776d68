"""Contacts of a cylinder, cone or disc and a polyhedron: a vertex over caps and side, and the list of all contacts."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.frustum import COS, HIGH, LOW, SIDE, SIN, SWEEP, Frustum
from ...shapes.polyhedron import Polyhedron
from ...vectors import put, vector_at
from ..features.frames import across, point_in_world, write_tangent
from ..features.polytope_tables import FACE, Numbers, face_table, star_lengths, star_of, vertex_table
from ..features.vertex_face import CLOSED, height_over
from ..features.writing import write_round
from .flank_edge import FlankEdge
from .frustum import (
    FLANK,
    HIGH_CAP,
    LOW_CAP,
    axis_in_world,
    center_in_world,
    least_over,
    part_names,
    part_number,
    seen_by,
    tip_past_rim,
    write_part,
)
from .frustum_swept import FrustumSwept, check_number
from .frustum_writing import size_of_both
from .rim_edge import RimEdge
from .rim_face import RimFace


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    n_vertices: float,
    vertices: Floats,
    vertex: float,
    n_star: float,
    star: Floats,
    lengths: Floats,
    n_faces: float,
    faces: Floats,
    size: float,
) -> None:
    ax, ay, az = axis_in_world(a, frustum)
    cx, cy, cz = center_in_world(a, frustum)
    v = 3 * int(vertex)
    px, py, pz = point_in_world(b, vector_at(vertices, v))
    along, away, (ex, ey, ez) = across((px - cx, py - cy, pz - cz), (ax, ay, az))
    cosine, sine = frustum[COS], frustum[SIN]
    dr, dz = away - frustum[0], along - frustum[LOW]
    margin = CLOSED * size
    flat = frustum[SIDE] == 0.0
    best, highest = -math.inf, -math.inf
    for part in (LOW_CAP, FLANK, HIGH_CAP):
        if (part == FLANK and flat) or (part == HIGH_CAP and frustum[1] == 0.0):
            continue
        radial, axial, height = 0.0, -1.0, -dz
        if part == HIGH_CAP:
            axial, height = 1.0, along - frustum[HIGH]
        elif part == FLANK:
            radial, axial, height = cosine, sine, cosine * dr + sine * dz
        nx, ny, nz = radial * ex + axial * ax, radial * ey + axial * ay, radial * ez + axial * az
        qx, qy, qz = px - height * nx, py - height * ny, pz - height * nz
        best = max(best, least_over(b, n_vertices, vertices, (nx, ny, nz), (qx, qy, qz)))
        highest = max(highest, height)
    found, gap, past = LOW_CAP, 0.0, math.inf
    for part in (LOW_CAP, FLANK, HIGH_CAP):
        if (part == FLANK and flat) or (part == HIGH_CAP and frustum[1] == 0.0):
            continue
        radial, axial, height, beyond = 0.0, -1.0, -dz, away - frustum[0]
        if part == HIGH_CAP:
            axial, height, beyond = 1.0, along - frustum[HIGH], away - frustum[1]
        elif part == FLANK:
            radial, axial, height = cosine, sine, cosine * dr + sine * dz
            up = cosine * dz - sine * dr
            beyond = max(-up, up - frustum[SIDE])
        nx, ny, nz = radial * ex + axial * ax, radial * ey + axial * ay, radial * ez + axial * az
        qx, qy, qz = px - height * nx, py - height * ny, pz - height * nz
        if least_over(b, n_vertices, vertices, (nx, ny, nz), (qx, qy, qz)) < best - margin:
            continue
        if height < 0.0:
            # behind a part only what lies inside of the body can touch it; of a disc, what has the disc inside of it
            inside = highest
            if flat:
                x, y, z = px - cx, py - cy, pz - cz
                inside = tip_past_rim(b, n_star, star, lengths, (x, y, z), (nx, ny, nz), -height, frustum[0])
                inside = min(inside, height_over(b, n_faces, faces, qx, qy, qz))
            beyond = max(beyond, inside)
        if beyond - margin < past:
            found, gap, past = part, height, beyond - margin
    if past > 0.0:
        gap = math.hypot(gap, past)
    radial, axial = 0.0, -1.0 if found == LOW_CAP else 1.0
    if found == FLANK:
        radial, axial = cosine, sine
    out[GAP], out[FEATURE], out[PAST_END] = gap, part_number(frustum, found), past
    put(out, NORMAL, (radial * ex + axial * ax, radial * ey + axial * ay, radial * ez + axial * az))
    put(out, POINT_B, (px, py, pz))
    for i in range(3):
        out[POINT_A + i] = out[POINT_B + i] - gap * out[NORMAL + i]
    write_tangent(a, out)
    write_part(out, SIDE_A, found, (ax, ay, az), (ex, ey, ez), radial, max(away - gap * radial, 0.0))
    write_round(out, SIDE_B, 0.0)


@final
@dataclass(frozen=True)
class FrustumPolyhedron(ContactKinematics):
    """Contact of a vertex of the polyhedron with the cap or side of the round body that best separates the bodies.

    The two bodies have further contacts: edges across the side and the rims, and rims and feet over the faces.  The
    features of a contact never change; a contact whose features do not face each other is open.  A body that lies on
    its side has contacts of its two rims, a standing body has contacts of its feet.

    Attributes
    ----------
    frustum : tuple of float
        The first body, with its rims set back by its feet (:func:`bodies.contacts.frustum.frustum.set_back`).
    vertices : tuple of float
        All vertices of the second body [m].
    vertex : int
        Number of the vertex of this contact.
    star, lengths : tuple of float
        Unit vectors along its edges, and their lengths [m].
    faces : tuple of float
        All faces of the second body.
    size : float
        Size of the bodies [m].
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, Polyhedron)

    frustum: Numbers
    vertices: Numbers
    vertex: int
    star: Numbers
    lengths: Numbers
    faces: Numbers
    size: float

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contacts of rims and feet with faces, vertices with the frustum, and edges with side and rims.

        Faces, vertices and edges are those of the polyhedron.  If one of the two bodies is rounded, return the contacts
        of :class:`bodies.FrustumSwept`.
        """
        assert isinstance(first, Frustum)
        assert isinstance(second, Polyhedron)
        if first.frustum[SWEEP] > 0.0 or second.sweep > 0.0:
            return FrustumSwept.between(first, second)
        core, size = second.core, size_of_both(first, second)
        check_number(len(core.edges))
        vertices, faces = vertex_table(core), face_table(core)
        numbers = seen_by(first, second.core)
        own = (
            cls(numbers, vertices, i, star_of(core, i), star_lengths(core, i), faces, size)
            for i in range(len(vertices) // 3)
        )
        edges = FlankEdge.between(first, second), RimEdge.between(first, second)
        return tuple(itertools.chain(RimFace.between(first, second), own, *edges))

    def parameters(self) -> dict[str, Value]:
        """Return the numbers of both bodies by the names of the evaluator's arguments."""
        return {
            "frustum": self.frustum,
            "n_vertices": float(len(self.vertices) // 3),
            "vertices": self.vertices,
            "vertex": float(self.vertex),
            "n_star": float(len(self.lengths)),
            "star": self.star,
            "lengths": self.lengths,
            "n_faces": float(len(self.faces) // FACE),
            "faces": self.faces,
            "size": self.size,
        }

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Names of the frustum's parts, each with the vertex; in this contact, the vertex never touches a rim.

        Rims have names only so that the numbers of the features agree with those of the parts.
        """
        return tuple(f"{part} and vertex {self.vertex}" for part in part_names(self.frustum))
