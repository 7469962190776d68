"""A cylinder, a cone or a disc and a triangle mesh, convex or not: a rim over a patch, and all other contacts."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np

from bodies.contacts.apex_mesh import ApexMesh
from bodies.contacts.curvature import SIDE_A, SIDE_B, write_flat, write_principal, write_sweep
from bodies.contacts.flank_mesh import FlankMesh
from bodies.contacts.frames import point_in_world, vector_in_body, vector_in_world
from bodies.contacts.frustum import axis_in_world
from bodies.contacts.frustum_corner import FrustumCorner
from bodies.contacts.frustum_swept import FrustumSwept
from bodies.contacts.mesh_mesh import check_contacts
from bodies.contacts.mesh_point import Corner, PointMesh
from bodies.contacts.offset import gap_at_distance
from bodies.contacts.plane_rim import FLATTEST
from bodies.contacts.rim_mesh import RimMesh
from bodies.contacts.surface_rim import lowest_on_rim, rim_under
from bodies.contacts.surface_tables import FACE, FACES, Numbers, star_of, surface_numbers
from bodies.contacts.tangents import write_tangent
from bodies.meshes.features import Features
from bodies.meshes.patches import patches_for_body
from bodies.meshes.triangles import Triangles
from bodies.shapes.cylinder import Cylinder
from bodies.shapes.frustum import AXIS, CENTER, COS, SIN, SWEEP, Frustum, Point, frustum_numbers
from bodies.shapes.triangle_mesh import TriangleMesh
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Table, Value
from nonsmooth.types import Floats

_WAYS = 12
"""Lines round a cone, or across a cap, of which none may point far into the face that an apex or a foot touches."""


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    radius: float,
    up: float,
    x: float,
    y: float,
    z: float,
    surface: Floats,
    patch: float,
) -> None:
    ax, ay, az = axis_in_world(a, frustum)
    fx, fy, fz = vector_in_world(a, frustum[AXIS - 2], frustum[AXIS + 1], frustum[AXIS + 4])
    cx, cy, cz = point_in_world(a, x, y, z)
    ux, uy, uz = vector_in_body(b, ax, ay, az)
    vx, vy, vz = vector_in_body(b, fx, fy, fz)
    kx, ky, kz = vector_in_body(b, cx - b[0], cy - b[1], cz - b[2])
    face, gap, past = rim_under(surface, patch, frustum, radius, up, kx, ky, kz, ux, uy, uz, vx, vy, vz)
    sweep = frustum[SWEEP]
    gap = gap_at_distance(gap, past, sweep)
    f = int(surface[FACES]) + FACE * face
    nx, ny, nz = vector_in_world(b, -surface[f], -surface[f + 1], -surface[f + 2])
    _, sine, ex, ey, ez = lowest_on_rim(nx, ny, nz, ax, ay, az, fx, fy, fz)
    out[0], out[29], out[30] = gap, float(face), past
    out[1], out[2], out[3] = nx, ny, nz
    out[7], out[8], out[9] = cx + radius * ex, cy + radius * ey, cz + radius * ez
    for i in range(3):
        out[7 + i] += sweep * out[1 + i]
        out[10 + i] = out[7 + i] + gap * out[1 + i]
    write_tangent(a, out)
    rim_x, rim_y, rim_z = ay * ez - az * ey, az * ex - ax * ez, ax * ey - ay * ex
    write_principal(out, SIDE_A, rim_x, rim_y, rim_z, max(sine, FLATTEST), radius, 1.0, 0.0)
    write_sweep(out, SIDE_A, sweep)
    write_flat(out, SIDE_B)


@final
@dataclass(frozen=True)
class FrustumMesh(ContactKinematics):
    """The lowest point of a rim over a patch of a mesh.

    The others are feet and apex over the patches, corners of the mesh over caps and side, and its convex edges across
    the side and the rims.  Which of them is a contact at present is told by what is next to the points alone, so that
    the mesh need not be convex.  A rounded body touches where its core is the radius away: with the apex as a sphere,
    and under the corners with its rims and its apex, too.

    Attributes
    ----------
    frustum : tuple of float
        The first body (:func:`bodies.shapes.frustum.frustum_numbers`).
    radius : float
        Radius of the rim [m].
    center : tuple of float
        Its centre in the body frame [m].
    up : float
        1 for the upper rim, else -1.
    surface : Table
        The surface (:mod:`bodies.contacts.surface_tables`).
    patch : int
        Number of the patch.
    n_faces : int
        Number of the faces of the mesh.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, TriangleMesh)

    frustum: Numbers
    radius: float
    center: Point
    up: float
    surface: Table
    patch: int
    n_faces: int

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return a cylinder, and a tetrahedron whose faces its rims meet."""
        corners = ((1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0))
        tetrahedron = Triangles(corners, ((0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)), "of the example")
        return {"first": Cylinder(0.1, 0.2), "second": TriangleMesh(tetrahedron)}

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contacts of rims, feet and apex over patches, of corners, and of edges with side and rims.

        Raises
        ------
        InvalidInput
            If there are too many.
        """
        assert isinstance(first, Frustum)
        assert isinstance(second, TriangleMesh)
        own, numbers = second.features, _set_back(first)
        sweep, size = first.frustum[SWEEP], max(own.size, 2.0 * first.extent)
        rims = tuple(itertools.chain(*(cls._of_rim(first, numbers, i, own) for i in range(len(first.standing_rims)))))
        feet = PointMesh.of_vertices(_feet(first), own, sweep)
        crossings = *FlankMesh.of_edges(numbers, own, size), *RimMesh.of_edges(numbers, own, size)
        check_contacts(len(crossings), len(rims))
        vertices = _rounded_vertices if sweep > 0.0 else _sharp_vertices
        return *rims, *feet, *vertices(first, numbers, own, size), *crossings

    @classmethod
    def _of_rim(cls, first: Frustum, numbers: Numbers, number: int, second: Features) -> Iterator[FrustumMesh]:
        radius, center = first.standing_rims[number]
        if radius > 0.0:
            patches = patches_for_body(second, 2.0 * (radius + numbers[SWEEP]))
            surface = surface_numbers(second, patches)
            for patch in range(patches.count):
                yield cls(numbers, radius, center, 2.0 * number - 1.0, surface, patch, len(second.planes))

    def parameters(self) -> dict[str, Value]:
        """Return the numbers of both."""
        x, y, z = self.center
        return {
            "frustum": self.frustum,
            "radius": self.radius,
            "up": self.up,
            "x": x,
            "y": y,
            "z": z,
            "surface": self.surface,
            "patch": float(self.patch),
        }

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """The faces."""
        rim = "rim" if self.up < 0.0 else "upper rim"
        return tuple(f"{rim} and face {i}" for i in range(self.n_faces))


def _sharp_vertices(
    first: Frustum, numbers: Numbers, second: Features, size: float
) -> tuple[PointMesh | FrustumCorner, ...]:
    """Return the contacts of the apex, a point, and of the corners of the second body."""
    return *PointMesh.of_vertices(_apex(first), second, 0.0), *FrustumCorner.of_corners(numbers, second, size)


def _rounded_vertices(
    _: Frustum, numbers: Numbers, second: Features, size: float
) -> tuple[ApexMesh | FrustumSwept, ...]:
    """Return the contacts of the apex, a sphere, and of the corners of the second body."""
    places = second.vertices[list(second.corners)].tolist()
    corners = (
        FrustumSwept(numbers, 0.0, (x, y, z), tuple(star_of(second, i)), size, f"corner {i}")
        for i, (x, y, z) in enumerate(places)
    )
    return *ApexMesh.of_patches(numbers, second, size), *corners


def _set_back(first: Frustum) -> Numbers:
    """Return the numbers of the body within its rims as they are set back, out of which only the feet stand.

    So a rim that rolls over the edge of a face goes on at the same height.
    """
    own = first.frustum
    center, axis = np.array(own[CENTER : CENTER + 3]), np.array(own[AXIS : AXIS + 7 : 3])
    rims = first.standing_rims if len(first.standing_rims) > 1 else 2 * first.standing_rims
    heights = [float((np.array(place) - center) @ axis) for _, place in rims]
    x, y, z = center.tolist()
    return frustum_numbers(
        [radius for radius, _ in rims], heights, (x, y, z), (axis[0], axis[1], axis[2]), 0.0, own[SWEEP]
    )


def _apex(first: Frustum) -> Iterator[Corner]:
    """Yield place, lines of the side and name of the apex of a cone."""
    sine, cosine = first.frustum[SIN], first.frustum[COS]
    for radius, place in first.standing_rims:
        if radius == 0.0:
            yield place, _round(first, sine, -cosine), "apex"


def _feet(first: Frustum) -> Iterator[Corner]:
    """Yield place, lines of the cap about it and name of the feet."""
    for i, foot in enumerate(first.feet):
        yield foot, _round(first, 1.0, 0.0), f"foot {i}"


def _round(first: Frustum, away: float, along: float) -> Numbers:
    """Return unit vectors round the axis, one after the other."""
    axes = np.array(first.frustum[AXIS - 2 : AXIS + 7]).reshape(3, 3)
    angles = [2.0 * math.pi * i / _WAYS for i in range(_WAYS)]
    ways = [axes @ np.array([away * math.cos(angle), away * math.sin(angle), along]) for angle in angles]
    return tuple(float(x) for way in ways for x in way)
