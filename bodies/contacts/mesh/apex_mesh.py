"""The apex of a rounded cone, a sphere, against a triangle mesh, convex or not."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import SharedNumbers, Value
from nonsmooth.types import Floats

from ...meshes.features import Features
from ...meshes.patches import patches_for_ball
from ...shapes.frustum import HIGH, SIDE, SWEEP, Frustum
from ...shapes.triangle_mesh import TriangleMesh
from ...vectors import put
from ..features.frames import point_in_body, write_tangent
from ..features.swept_vertex import END, NEAR, OPEN
from ..features.writing import write_round
from ..frustum.apex_swept import past_apex
from ..frustum.frustum import axis_in_world, center_in_world
from ..surface.surface_ball import out_of_surface, write_feature
from ..surface.surface_search import FAR, ON_CORNER, ON_EDGE, Found, nearest_in_patch
from ..surface.surface_tables import EDGE, EDGES, N_PATCHES, Numbers, surface_numbers


@compiled
def _within(surface: Floats, found: Found) -> float:
    """Return the distance of a nearest point from the nearer end of its edge [m]: 0 at a corner, infinite on a face."""
    _, _, kind, number, x, y, z = found
    if kind == ON_CORNER:
        return 0.0
    if kind != ON_EDGE:
        return math.inf
    e = int(surface[EDGES]) + EDGE * number
    x, y, z = x - surface[e], y - surface[e + 1], z - surface[e + 2]
    along = x * surface[e + 3] + y * surface[e + 4] + z * surface[e + 5]
    return float(min(along, surface[e + 6] - along))


def _evaluate(a: Floats, b: Floats, out: Floats, first: Floats, surface: Floats, patch: float, size: float) -> None:
    write_apex(a, b, out, first, surface, patch, size, FAR)


@compiled
def write_apex(
    a: Floats, b: Floats, out: Floats, first: Floats, surface: Floats, patch: float, size: float, reach: float
) -> None:
    """Write the geometry block of a round apex and a patch of the second body, searched up to ``reach`` [m]."""
    ax, ay, az = axis_in_world(a, first)
    px, py, pz = center_in_world(a, first)
    px, py, pz = px + first[HIGH] * ax, py + first[HIGH] * ay, pz + first[HIGH] * az
    x, y, z = point_in_body(b, (px, py, pz))
    found = nearest_in_patch(surface, patch, x, y, z, reach)
    # if there is one patch only, it is the whole surface, which has no end
    past = found[1] if surface[N_PATCHES] > 1.0 else 0.0
    nx, ny, nz = out_of_surface(b, surface, found, past, x, y, z)
    radius = first[SWEEP]
    gap = found[0] - radius
    beyond = past_apex(first, found[0], -nx * ax - ny * ay - nz * az, size)
    past = max(past, min(beyond, -END * size) if gap > NEAR * size else beyond)
    # a corner has a contact of its own
    shared = END * size - _within(surface, found)
    past = max(past, shared)
    if past > 0.0:
        # write a large gap for a small distance past the end, so that the contact is not taken for a closed one
        gap = math.hypot(max(gap, 0.0), max(past, OPEN * shared))
    put(out, NORMAL, (-nx, -ny, -nz))
    put(out, POINT_A, (px - radius * nx, py - radius * ny, pz - radius * nz))
    out[GAP], out[PAST_END] = gap, past
    for i in range(3):
        out[POINT_B + i] = out[POINT_A + i] + gap * out[NORMAL + i]
    write_tangent(a, out)
    write_round(out, SIDE_A, radius)
    write_feature(b, out, SIDE_B, surface, found[2], found[3])


@final
@dataclass(frozen=True)
class ApexMesh(ContactKinematics):
    """The contact of the round apex of a cone with the nearest face or edge of one patch of a mesh.

    Corners of the mesh have contacts of their own.

    Attributes
    ----------
    first : tuple of float
        The cone (:func:`bodies.shapes.frustum.frustum_numbers`).
    surface : SharedNumbers
        The surface (:mod:`bodies.contacts.surface.surface_tables`).
    patch : int
        Number of the patch.
    size : float
        Size of the larger body [m].
    counts : tuple of int
        Numbers of faces, convex edges and corners.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, TriangleMesh)

    first: Numbers
    surface: SharedNumbers
    patch: int
    size: float
    counts: tuple[int, int, int]

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ApexMesh, ...]:
        """Return the contacts of a cone's apex; empty for other frustums, which have no apex."""
        assert isinstance(first, Frustum)
        assert isinstance(second, TriangleMesh)
        return cls.of_patches(first.frustum, second.features, max(second.features.size, 2.0 * first.extent))

    @classmethod
    def of_patches(cls, first: Numbers, second: Features, size: float) -> tuple[ApexMesh, ...]:
        """Return the contacts of the apex of a cone, given by its numbers ``first``, with all patches of a mesh.

        The result is empty for other frustums, which have no apex.  ``size`` is the size of the larger body [m].
        """
        if first[SIDE] == 0.0 or first[1] > 0.0:
            return ()
        patches = patches_for_ball(second, first[SWEEP])
        surface = surface_numbers(second, patches)
        counts = len(second.planes), len(second.edges), len(second.corners)
        return tuple(cls(first, surface, patch, size, counts) for patch in range(patches.count))

    def parameters(self) -> dict[str, Value]:
        """Return the numbers of both bodies by the names of the evaluator's arguments."""
        return {"first": self.first, "surface": self.surface, "patch": float(self.patch), "size": self.size}

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Names of the apex with each face, convex edge and corner of the mesh; two points have no contact here.

        Corners have names only so that the numbers of the features agree with the tables.
        """
        kinds = zip(("face", "edge", "corner"), self.counts, strict=True)
        return tuple(f"apex and {part} {i}" for part, n in kinds for i in range(n))
