"""Contacts of a cylinder, cone or disc with a triangle mesh: a rim with a patch, and the list of all contacts.

The mesh need not be convex.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, final

from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...meshes.features import Features
from ...meshes.patches import patches_for_ball, patches_for_body
from ...meshes.triangles import Triangles
from ...shapes.cylinder import Cylinder
from ...shapes.frustum import HIGH_RADIUS, SIDE, SWEEP, Frustum
from ...shapes.triangle_mesh import TriangleMesh
from ...vectors import vector_at
from ..frustum.frustum import apex_of, feet_of, part_names, rims_of, set_back
from ..frustum.frustum_swept import rounded_vertex
from ..surface.mesh_point import vertices_over_surface
from ..surface.surface_tables import Numbers, star_lengths, star_of, surface_numbers
from .apex_mesh import evaluate_apex_over_patch
from .frustum_corner import evaluate_corner_over_frustum
from .frustum_pairs import frustum_pairs
from .mesh_crossing import crossings_of
from .mesh_mesh import are_many
from .surface_rim import rim_in_surface, rim_under, write_rim


def evaluate_rim_over_patch(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    radius: float,
    up: float,
    center: Floats,
    surface: Floats,
    patch: float,
) -> None:
    """Write the geometry block of a rim of the first body, at its lowest point, and a patch of the second body's mesh.

    Parameters
    ----------
    a, b, out : Floats
        Frame blocks of both bodies, and the geometry block.
    frustum : Floats
        Dimensions of the first body (:func:`bodies.shapes.frustum.frustum_numbers`).
    radius : float
        Radius of the rim [m].
    up : float
        1 for the upper rim, else -1.
    center : Floats
        Centre of the rim in the body frame [m].
    surface, patch : Floats, float
        Tables of the mesh (:mod:`bodies.contacts.surface.surface_tables`), and number of the patch.
    """
    place = vector_at(center, 0)
    face, gap, past = rim_under(surface, patch, frustum, radius, up, rim_in_surface(a, b, frustum, place))
    write_rim(a, b, out, frustum, radius, place, surface, face, gap, past)


@final
class FrustumMesh(ContactKinematics):
    """Contacts of a cylinder, cone or disc with a triangle mesh.

    A patch is a group of faces of which the body can touch only one at a time (:mod:`bodies.meshes.patches`).  A
    cylinder, cone or disc has flat faces, the caps, with small feet.  The contacts are:

    - rims, at their lowest points, feet, and the apex of a cone, over the patches;
    - corners of the mesh over the caps and the side;
    - convex edges of the mesh across the side and the rims.

    Whether a contact exists depends only on the mesh next to its points, so the mesh need not be convex.  The surface
    of a rounded body is at a constant distance, the radius of rounding, from a smaller core.  Its apex is a sphere,
    and corners of the mesh also touch its rims and its apex.

    If these contacts are too many, only features that are near each other become contacts
    (:mod:`bodies.contacts.mesh.frustum_pairs`).
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, TriangleMesh)

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return a cylinder, and a tetrahedron whose faces its rims meet."""
        corners = ((1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0))
        tetrahedron = Triangles(corners, ((0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)), "of the example")
        return {"first": Cylinder(0.1, 0.2), "second": TriangleMesh(tetrahedron)}

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the contacts of rims, feet and apex over patches, of corners, and of edges with side and rims."""
        assert isinstance(first, Frustum)
        assert isinstance(second, TriangleMesh)
        own, numbers = second.features, set_back(first)
        sweep, size = first.frustum[SWEEP], max(own.size, 2.0 * first.extent)
        n_crossings = 2 * len(rims_of(numbers)) + (1 if numbers[SIDE] > 0.0 else 0)
        if are_many(len(own.edges) * n_crossings + len(own.corners)):
            return frustum_pairs(first, second)
        feet = vertices_over_surface(1.0, feet_of(first), own, sweep)
        tips = _of_apex(numbers, own, size) if sweep > 0.0 else vertices_over_surface(1.0, apex_of(first), own, 0.0)
        others = _of_corners(numbers, own, size), crossings_of(numbers, own, size)
        return tuple(itertools.chain(_of_rims(first, numbers, own), feet, tips, *others))


def _of_rims(first: Frustum, numbers: Numbers, second: Features) -> Iterator[FeaturePair]:
    """Yield the contacts of rims with patches.

    A rim touches faces here; edges and corners have contacts of their own, so patches without faces are left out.  The
    patches are made for a sphere as large as the rim.
    """
    for number, (radius, center) in enumerate(first.standing_rims):
        if radius > 0.0:
            patches = patches_for_body(second, 2.0 * (radius + numbers[SWEEP]))
            values: dict[str, Value] = {"frustum": numbers, "radius": radius, "center": center}
            values |= {"up": 2.0 * number - 1.0, "surface": surface_numbers(second, patches, 0.0)}
            names = tuple(f"{'upper rim' if number else 'rim'} and face {i}" for i in range(len(second.planes)))
            for patch in sorted(set(patches.of_faces)):
                yield FeaturePair(evaluate_rim_over_patch, {**values, "patch": float(patch)}, names)


def _of_apex(numbers: Numbers, second: Features, size: float) -> Iterator[FeaturePair]:
    """Yield the contacts of the round apex of a cone with the nearest face or edge of each patch of a mesh.

    Corners of the mesh have contacts of their own.  They have names only so that the numbers of the features agree with
    the tables.
    """
    if numbers[SIDE] > 0.0 and numbers[HIGH_RADIUS] == 0.0:
        patches = patches_for_ball(second, numbers[SWEEP])
        values: dict[str, Value] = {"first": numbers, "surface": surface_numbers(second, patches, 0.0), "size": size}
        counts = ("face", len(second.planes)), ("edge", len(second.edges)), ("corner", len(second.corners))
        names = tuple(f"apex and {part} {i}" for part, n in counts for i in range(n))
        for patch in range(patches.count):
            yield FeaturePair(evaluate_apex_over_patch, {**values, "patch": float(patch)}, names)


def _of_corners(numbers: Numbers, second: Features, size: float) -> Iterator[FeaturePair]:
    """Yield the contacts of the corners of a mesh with a frustum.

    A corner never touches a rim of a sharp frustum.  Rims have names only so that the numbers of the features agree
    with those of the parts.
    """
    surface = surface_numbers(second, patches_for_body(second, 0.0), 0.0)
    for i, place in enumerate(second.vertices[list(second.corners)].tolist()):
        star, name = tuple(star_of(second, i)), f"corner {i}"
        if numbers[SWEEP] > 0.0:
            yield rounded_vertex(numbers, 0.0, tuple(place), star, size, name)
            continue
        values: dict[str, Value] = {"frustum": numbers, "place": tuple(place), "n_star": float(len(star) // 3)}
        values |= {"star": star, "lengths": tuple(star_lengths(second, i)), "surface": surface, "size": size}
        names = tuple(f"{part} and {name}" for part in part_names(numbers))
        yield FeaturePair(evaluate_corner_over_frustum, values, names)
