"""Contact of a rim, a foot or the apex of a cylinder, cone or disc with the faces of a polyhedron."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.frustum import SWEEP, Frustum
from ...shapes.polyhedron import SweptPolytope
from ...vectors import Vector3, put, vector_at
from ..features.flat_rim import FLATTEST, Touching, touching_point, write_rim
from ..features.frames import across, point_in_body, point_in_world, vector_in_body, vector_in_world, write_tangent
from ..features.polytope_tables import FACE, Numbers, face_table
from ..features.vertex_face import REACH, past_face, plane_height
from ..features.writing import write_flat, write_round
from .frustum import axis_in_world, center_in_world, least_height, seen_by, separation_over_faces
from .frustum_writing import size_of_both


@compiled
def _touching(
    a: Floats, b: Floats, radius: float, center: Vector3, axis: Vector3, normal: Vector3
) -> tuple[float, float, float, Touching]:
    """Return the point of a rim at which its gap over a plane is measured [m], and the touching point of the rim.

    The first three numbers are the coordinates of the point in the world.  The touching point is explained in
    :data:`bodies.contacts.features.flat_rim.Touching`.

    Parameters
    ----------
    a, b : Floats
        Frame blocks of the body with the rim, and of the body with the plane.
    radius : float
        Radius of the rim [m].
    center : tuple of float
        Centre of the rim in the frame of its body [m].
    axis, normal : tuple of float
        Unit axis of the rim, and unit normal of the plane towards the rim, in world axes.
    """
    (x, y, z), (nx, ny, nz) = center, normal
    at = touching_point(a, b, normal, axis, radius)
    reach, (ex, ey, ez), lift, _, _, _ = at
    px, py, pz = point_in_world(a, (x, y, z))
    return px + reach * ex - lift * nx, py + reach * ey - lift * ny, pz + reach * ez - lift * nz, at


@compiled
def _past_flat(faces: Floats, n_faces: float, face: int, x: float, y: float, z: float, radius: float) -> float:
    """Return the distance of a flat rim that touches as a crown past the border of a face [m]; negative if valid.

    The centre of the rim (x, y, z), in the frame of the polyhedron [m], must be over the face.  So must a part of the
    rim of ``radius`` [m]: it lies within the face, or it crosses the border of the face.  If the whole face lies inside
    of the rim, the vertices and edges of the face carry the load instead.
    """
    over = past_face(faces, n_faces, face, plane_height(faces, face, x, y, z), x, y, z)
    if over <= -radius:
        return float(over)
    n = vector_at(faces, face)
    least = radius
    for i in range(int(n_faces)):
        f = FACE * i
        # distance and direction, in the plane of this face, from the centre to the line of another face
        along, sine, (ex, ey, ez) = across(vector_at(faces, f), (n[0], n[1], n[2]))
        away = along * plane_height(faces, face, x, y, z) - plane_height(faces, f, x, y, z)
        if f == face or abs(away) >= radius * sine:
            continue
        away /= sine
        half = math.sqrt(radius * radius - away * away)
        tx, ty, tz = n[1] * ez - n[2] * ey, n[2] * ex - n[0] * ez, n[0] * ey - n[1] * ex
        for sign in (-half, half):
            px, py, pz = x + away * ex + sign * tx, y + away * ey + sign * ty, z + away * ez + sign * tz
            height = plane_height(faces, face, px, py, pz)
            least = min(least, past_face(faces, n_faces, face, height, px, py, pz))
    return float(max(over, least))


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    radius: float,
    x: float,
    y: float,
    z: float,
    n_faces: float,
    faces: Floats,
    sweep: float,
    size: float,
) -> None:
    ax, ay, az = axis_in_world(a, frustum)
    cx, cy, cz = center_in_world(a, frustum)
    ux, uy, uz = vector_in_body(b, (ax, ay, az))
    kx, ky, kz = point_in_body(b, (cx, cy, cz))
    px, py, pz = point_in_world(a, (x, y, z))
    px, py, pz = point_in_body(b, (px, py, pz))
    center, margin = (px, py, pz), REACH * size
    best = separation_over_faces(a, b, frustum, n_faces, faces)
    found, gap, past = 0, 0.0, math.inf
    for i in range(int(n_faces)):
        f = FACE * i
        height = plane_height(faces, f, kx, ky, kz)
        if least_height(frustum, height, (ux, uy, uz), vector_at(faces, f)) < best - margin:
            continue
        nx, ny, nz = vector_in_world(b, vector_at(faces, f))
        px, py, pz, at = _touching(a, b, radius, (x, y, z), (ax, ay, az), (nx, ny, nz))
        px, py, pz = point_in_body(b, (px, py, pz))
        height = plane_height(faces, f, px, py, pz)
        beyond = past_face(faces, n_faces, f, height, px, py, pz)
        if radius > 0.0 and at[4] == FLATTEST:
            px, py, pz = center
            beyond = _past_flat(faces, n_faces, f, px, py, pz, radius)
        if height < 0.0:
            # a rim's point below the plane of a face touches the face only if it is inside of the polyhedron
            for j in range(int(n_faces)):
                beyond = max(beyond, plane_height(faces, FACE * j, px, py, pz))
        if beyond - margin < past:
            found, gap, past = i, height, beyond - margin
    own = frustum[SWEEP]
    gap -= own + sweep
    if past > 0.0:
        gap = math.hypot(gap, past)
    f = FACE * found
    nx, ny, nz = vector_in_world(b, vector_at(faces, f))
    px, py, pz, at = _touching(a, b, radius, (x, y, z), (ax, ay, az), (nx, ny, nz))
    out[GAP], out[FEATURE], out[PAST_END] = gap, float(found), past
    put(out, NORMAL, (-nx, -ny, -nz))
    put(out, POINT_A, (px - own * nx, py - own * ny, pz - own * nz))
    for i in range(3):
        out[POINT_B + i] = out[POINT_A + i] + gap * out[NORMAL + i]
    write_tangent(a, out)
    write_flat(out, SIDE_B)
    if radius > 0.0:
        write_rim(out, SIDE_A, (ax, ay, az), radius, at, own)
    else:
        write_round(out, SIDE_A, own)


@final
@dataclass(frozen=True)
class RimFace(ContactKinematics):
    """Contact of a rim with a face of the second body, at the rim's point that is lowest over the face.

    The face is the one over which the least height of the whole frustum is the largest, so that it best separates the
    bodies.  Feet and the apex are treated as rims of radius 0.  A frustum whose axis is parallel to the face has
    contacts of its two rims.  A frustum that stands on a cap has contacts of its feet.

    Attributes
    ----------
    frustum : tuple of float
        The first body, with its rims set back by its feet (:func:`bodies.contacts.frustum.frustum.set_back`).
    radius : float
        Radius of the rim [m].
    center : tuple of float
        Centre of the rim in the body frame [m].
    faces : tuple of float
        The faces of the second body's core (:func:`bodies.contacts.features.polytope_tables.face_table`).
    sweep : float
        Radius about the core of the second body [m].
    size : float
        Size of the bodies [m].
    name : str
        Name of the rim, foot or apex.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, SweptPolytope)

    frustum: Numbers
    radius: float
    center: tuple[float, float, float]
    faces: Numbers
    sweep: float
    size: float
    name: str

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[RimFace, ...]:
        """Return the contacts of all rims and feet, and of the apex of two sharp bodies; a segment has no faces."""
        assert isinstance(first, Frustum)
        assert isinstance(second, SweptPolytope)
        numbers, faces, size = seen_by(first, second.core), face_table(second.core), size_of_both(first, second)
        if not faces:
            return ()
        named = [(*rim, f"rim {i}") for i, rim in enumerate(first.standing_rims) if rim[0] > 0.0]
        if second.sweep + numbers[SWEEP] == 0.0:
            # the apex of a rounded cone is a sphere, which has a contact of its own
            named += [(*rim, "apex") for rim in first.standing_rims if rim[0] == 0.0]
        named += [(0.0, foot, f"foot {i}") for i, foot in enumerate(first.feet)]
        return tuple(cls(numbers, radius, at, faces, second.sweep, size, name) for radius, at, name in named)

    def parameters(self) -> dict[str, Value]:
        """Return the numbers of rim, frustum and faces by the names of the evaluator's arguments."""
        x, y, z = self.center
        return {
            "frustum": self.frustum,
            "radius": self.radius,
            "x": x,
            "y": y,
            "z": z,
            "n_faces": float(len(self.faces) // FACE),
            "faces": self.faces,
            "sweep": self.sweep,
            "size": self.size,
        }

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Names of the pairs of features: the rim, foot or apex of this contact with each face."""
        return tuple(f"{self.name} and face {i}" for i in range(len(self.faces) // FACE))
