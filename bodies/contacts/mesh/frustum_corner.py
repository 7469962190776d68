"""A corner of a mesh over the caps and the side of a cylinder, a cone or a disc."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, POSITION, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import SharedNumbers, Value
from nonsmooth.types import Floats

from ...meshes.features import Features
from ...meshes.patches import patches_for_body
from ...shapes.frustum import COS, HIGH, LOW, SIDE, SIN, Frustum
from ...shapes.triangle_mesh import TriangleMesh
from ...vectors import put
from ..features.edge_crossing import ASTRAY
from ..features.frames import across, point_in_world, vector_in_body, write_tangent
from ..features.vertex_face import CLOSED, REACH
from ..features.writing import write_round
from ..frustum.frustum import (
    FLANK,
    HIGH_CAP,
    LOW_CAP,
    axis_in_world,
    center_in_world,
    part_names,
    part_number,
    tip_past_rim,
    write_part,
)
from ..surface.surface_search import depth_inside
from ..surface.surface_tables import Numbers, star_lengths, star_of, surface_numbers


@compiled
def over_part(frustum: Floats, part: int, along: float, away: float) -> tuple[float, float, float, float]:
    """Return height of a point over a cap's plane or the side's cone, distance past its border [m], and the normal.

    The point has the coordinate ``along`` on the axis, from the frustum's centre, and the distance ``away`` from the
    axis [m].  The normal is returned as its radial and its axial component.
    """
    if part == LOW_CAP:
        return frustum[LOW] - along, away - frustum[0], 0.0, -1.0
    if part == HIGH_CAP:
        return along - frustum[HIGH], away - frustum[1], 0.0, 1.0
    cosine, sine = frustum[COS], frustum[SIN]
    dr, dz = away - frustum[0], along - frustum[LOW]
    up = cosine * dz - sine * dr
    return cosine * dr + sine * dz, max(-up, up - frustum[SIDE]), cosine, sine


@compiled
def _leaning(b: Floats, n_star: float, star: Floats, nx: float, ny: float, nz: float) -> float:
    """Return the sine of the largest angle at which an edge of a corner leads below the plane with the normal n.

    It is negative if all edges lead above the plane.
    """
    nx, ny, nz = vector_in_body(b, (nx, ny, nz))
    down = -1.0
    for i in range(int(n_star)):
        down = max(down, -(nx * star[3 * i] + ny * star[3 * i + 1] + nz * star[3 * i + 2]))
    return down


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    corner_x: float,
    corner_y: float,
    corner_z: float,
    n_star: float,
    star: Floats,
    lengths: Floats,
    surface: Floats,
    size: float,
) -> None:
    """Write the geometry block of a corner; parameters as the attributes of :class:`FrustumCorner`."""
    ax, ay, az = axis_in_world(a, frustum)
    cx, cy, cz = center_in_world(a, frustum)
    px, py, pz = point_in_world(b, (corner_x, corner_y, corner_z))
    along, away, (ex, ey, ez) = across((px - cx, py - cy, pz - cz), (ax, ay, az))
    flat, margin = frustum[SIDE] == 0.0, REACH * size
    deepest = -math.inf
    for part in (LOW_CAP, FLANK, HIGH_CAP):
        height, _, _, _ = over_part(frustum, part, along, away)
        if not ((part == FLANK and flat) or (part == HIGH_CAP and frustum[1] == 0.0)):
            deepest = max(deepest, height)
    best, found, gap, past = math.inf, LOW_CAP, 0.0, math.inf
    for part in (LOW_CAP, FLANK, HIGH_CAP):
        if (part == FLANK and flat) or (part == HIGH_CAP and frustum[1] == 0.0):
            continue
        height, beyond, radial, axial = over_part(frustum, part, along, away)
        nx, ny, nz = radial * ex + axial * ax, radial * ey + axial * ay, radial * ez + axial * az
        if height < 0.0 and not flat:
            # a corner below a cap's plane or the side's cone touches it only if the corner is inside of the frustum
            beyond = max(beyond, deepest)
        beyond = max(beyond - margin, size * (_leaning(b, n_star, star, nx, ny, nz) - ASTRAY))
        if flat and height < -CLOSED * size and beyond <= 0.0:
            # a corner behind a disc touches it only if its edges go through the disc, or if the corner's body encloses
            # the point of the disc nearest to the corner
            past_rim = tip_past_rim(
                b, n_star, star, lengths, (px - cx, py - cy, pz - cz), (nx, ny, nz), -height, frustum[0]
            )
            x, y, z = (
                px - height * nx - b[POSITION],
                py - height * ny - b[POSITION + 1],
                pz - height * nz - b[POSITION + 2],
            )
            x, y, z = vector_in_body(b, (x, y, z))
            if past_rim > 0.0 and depth_inside(surface, x, y, z) == 0.0:
                beyond = min(-height, past_rim)
        key = height * height + max(beyond, 0.0) * max(beyond, 0.0)
        if key < best:
            best, found, gap, past = key, part, height, beyond
    if past > 0.0:
        gap = math.hypot(gap, past)
    _, _, radial, axial = over_part(frustum, found, along, away)
    out[GAP], out[FEATURE], out[PAST_END] = gap, part_number(frustum, found), past
    put(out, NORMAL, (radial * ex + axial * ax, radial * ey + axial * ay, radial * ez + axial * az))
    put(out, POINT_B, (px, py, pz))
    for i in range(3):
        out[POINT_A + i] = out[POINT_B + i] - gap * out[NORMAL + i]
    write_tangent(a, out)
    write_part(out, SIDE_A, found, (ax, ay, az), (ex, ey, ez), radial, max(away - gap * radial, 0.0))
    write_round(out, SIDE_B, 0.0)


write_corner = compiled(_evaluate)
"""Compiled function that writes the geometry block of a corner and a frustum; other contacts call it, too."""


@final
@dataclass(frozen=True)
class FrustumCorner(ContactKinematics):
    """The contact of a corner of the second body with the nearest part of the first, cap or side.

    A cap or the side touches the corner only if no edge of the corner leads below the cap's plane or the side's tangent
    plane; otherwise the edge touches it first.

    Attributes
    ----------
    frustum : tuple of float
        The first body (:func:`bodies.shapes.frustum.frustum_numbers`).
    place : tuple of float
        The corner in its body frame [m].
    star, lengths : tuple of float
        Unit vectors along its edges, and their lengths [m].
    surface : SharedNumbers
        The surface (:mod:`bodies.contacts.surface.surface_tables`).
    size : float
        Size of the larger body [m].
    corner : int
        Number of the corner.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, TriangleMesh)

    frustum: Numbers
    place: tuple[float, float, float]
    star: Numbers
    lengths: Numbers
    surface: SharedNumbers
    size: float
    corner: int

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FrustumCorner, ...]:
        """Return one contact for each corner of the second body."""
        assert isinstance(first, Frustum)
        assert isinstance(second, TriangleMesh)
        return cls.of_corners(first.frustum, second.features, max(second.features.size, 2.0 * first.extent))

    @classmethod
    def of_corners(cls, first: Numbers, second: Features, size: float) -> tuple[FrustumCorner, ...]:
        """Return one contact of each corner of a mesh with a frustum.

        ``first`` are the numbers of the frustum, ``size`` is the size of the larger body [m].
        """
        surface = surface_numbers(second, patches_for_body(second, 0.0))
        places = second.vertices[list(second.corners)].tolist()
        return tuple(
            cls(first, (x, y, z), tuple(star_of(second, i)), tuple(star_lengths(second, i)), surface, size, i)
            for i, (x, y, z) in enumerate(places)
        )

    def parameters(self) -> dict[str, Value]:
        """Return the numbers of the frustum and of the corner with its surface."""
        x, y, z = self.place
        return {
            "frustum": self.frustum,
            "corner_x": x,
            "corner_y": y,
            "corner_z": z,
            "n_star": float(len(self.star) // 3),
            "star": self.star,
            "lengths": self.lengths,
            "surface": self.surface,
            "size": self.size,
        }

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Names of the corner with each part of the frustum; in this contact, the corner never touches a rim.

        Rims have names only so that the numbers of the features agree with those of the parts.
        """
        return tuple(f"{part} and corner {self.corner}" for part in part_names(self.frustum))
