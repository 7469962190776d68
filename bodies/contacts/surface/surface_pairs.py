"""Contacts of two boxes, hulls, capsules or meshes, and of these with points and spheres.

The contacts are corners over patches, and edges across edges.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, final

import numpy as np

from nonsmooth.compiled import compiled
from nonsmooth.interfaces import CandidateSearch, ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...meshes.features import Features
from ...meshes.patches import patches_for_ball, patches_of_faces
from ...shapes.point import Point
from ...shapes.sphere import Sphere
from ...shapes.surface_shape import SurfaceShape
from ..features.bounds import edges_bound
from ..features.edge_vertex import Edge
from ..features.frames import point_seen_from
from ..features.writing import NO_CANDIDATE, write_apart
from .overlap_corners import Over
from .surface_ball import write_round_corner, write_sharp_corner
from .surface_edges import write_edges
from .surface_near import EDGE_ACROSS, NARROW, OVER_FIRST, OVER_SECOND, find_near_features
from .surface_search import FAR, nearest_in_patch, signed_distance
from .surface_tables import N_FACES, SWEEP, Solid, corner_at, edge_at, part_names, surface_numbers

MOST_NEAR = 256
"""Largest number of pairs of features of two bodies that may be near each other at a time."""
_MOST_EACH = 8
"""Largest number of pairs of features for which each pair is a contact, without a search."""


@compiled
def _write_corner(out: Floats, over: Over, margin: float) -> None:
    """Write the geometry block of a corner over a patch; ``margin`` is the largest gap of a pair of features [m].

    If both bodies are sharp, the corner touches faces only.  Else it is a ball, or a point near a round surface.
    """
    radius = over.solid.surface[SWEEP] + over.other.surface[SWEEP]
    if radius > 0.0:
        write_round_corner(out, over, margin + radius)
    else:
        write_sharp_corner(out, over, margin)


def evaluate_surfaces(
    a: Floats, b: Floats, out: Floats, candidate: Floats, surface_a: Floats, surface_b: Floats, size: float
) -> None:
    """Write the geometry block of a corner over a patch, or of two edges.

    ``candidate`` holds the kind of the pair, the numbers of its two features, and the gap up to which it is valid [m].
    Without a candidate, the contact is written as wide open.  The surfaces are those of
    :mod:`bodies.contacts.surface.surface_tables`; ``size`` is the size of the larger body [m].
    """
    kind, i, j, margin = candidate[0], int(candidate[1]), int(candidate[2]), candidate[3]
    first, second = Solid(a, surface_a), Solid(b, surface_b)
    if kind == OVER_FIRST:
        _write_corner(out, Over(first, float(i), second, corner_at(surface_b, j), False, size), margin)
    elif kind == OVER_SECOND:
        _write_corner(out, Over(second, float(i), first, corner_at(surface_a, j), True, size), margin)
    elif kind == EDGE_ACROSS:
        write_edges(out, first, i, second, j, size)
    else:
        write_apart(a, out, size)


@compiled
def _distance(solid: Solid, other: Solid, corner: int) -> float:
    """Return the distance of a corner of the other body from a surface [m], negative inside."""
    point = point_seen_from(solid.frame, other.frame, corner_at(other.surface, corner).place)
    # a segment or a point has no inside
    if solid.surface[N_FACES] == 0.0:
        return nearest_in_patch(solid.surface, 0.0, point, FAR).distance
    return signed_distance(solid.surface, point)


def bound_of_surfaces(
    a: Floats, b: Floats, out: Floats, candidate: Floats, surface_a: Floats, surface_b: Floats, size: float
) -> None:
    """Write by how much the bodies must move before a pair of features touches [m]."""
    kind, i, j = candidate[0], int(candidate[1]), int(candidate[2])
    first, second = Solid(a, surface_a), Solid(b, surface_b)
    if kind == OVER_FIRST:
        distance = _distance(first, second, j)
    elif kind == OVER_SECOND:
        distance = _distance(second, first, j)
    else:
        distance = edges_bound(Edge(a, edge_at(surface_a, i)), Edge(b, edge_at(surface_b, j)))
    out[0] = distance - surface_a[SWEEP] - surface_b[SWEEP]


_ROOM = 16
"""Contacts of two convex surfaces for each side of their largest face, or each edge of a corner.

Convex bodies touch in one area at a time.  Equal prisms that lie flush and aligned have 6 pairs of features near each
other at each corner of the area, which is the most; a search that finds more than there is room for looks less far.
"""


class Swept(NamedTuple):
    """A surface with a radius about it, as one side of a contact."""

    features: Features
    """Faces, edges and corners of the surface."""
    sweep: float
    """The radius [m]."""
    extent: float
    """Radius of a ball about the frame of the body, which contains the shape [m]."""
    corner: str = "corner"
    """Name of a corner."""

    def corner_name(self, number: int) -> str:
        """Return the name of a corner; a single one, of a ball, has no number."""
        return f"{self.corner} {number}" if len(self.features.corners) > 1 else self.corner


def contacts_of(one: Swept, two: Swept) -> tuple[FeaturePair, ...]:
    """Return the contacts of two surfaces.

    Few pairs of features have a contact each, in this order: edges across edges, corners of the second surface over
    patches of the first, corners of the first one over patches of the second.  Of many, a search assigns those that are
    near to equal contacts.  If the second one is a ball, it has the contacts of its centre only.
    """
    patches = [
        patches_of_faces(own.features)
        if own.sweep + other.sweep == 0.0 and own.features.is_convex
        else patches_for_ball(own.features, other.sweep)
        for own, other in ((one, two), (two, one))
    ]
    surfaces = [surface_numbers(s.features, p, s.sweep) for s, p in zip((one, two), patches, strict=True)]
    size = max(s.features.size + 2.0 * s.sweep for s in (one, two))
    values: dict[str, Value] = {"surface_a": surfaces[0], "surface_b": surfaces[1], "size": size}
    counts = {
        EDGE_ACROSS: (len(one.features.edges), len(two.features.edges)),
        OVER_FIRST: (patches[0].count, len(two.features.corners)),
        OVER_SECOND: (patches[1].count, len(one.features.corners)),
    }
    if not two.features.edges:
        counts = {OVER_FIRST: counts[OVER_FIRST]}
    n_pairs = sum(m * n for m, n in counts.values())
    if n_pairs <= _MOST_EACH:
        pairs = [(kind, i, j) for kind, (m, n) in counts.items() for i in range(m) for j in range(n)]
        return tuple(_fixed({**values, "candidate": (*map(float, pair), FAR)}, pair, one, two) for pair in pairs)
    if all(own.features.is_convex for own in (one, two)):
        n_pairs = min(n_pairs, _ROOM * max(_sides(own.features) for own in (one, two)))
    sought = {key: values[key] for key in ("surface_a", "surface_b")}
    search = CandidateSearch(
        find_near_features, {**sought, **limits(n_pairs, [s.extent for s in (one, two) if s.features.edges])}, counts
    )
    names = tuple(f"feature {i}" for i in range(max(len(part_names(s.features)) for s in (one, two))))
    made = FeaturePair(evaluate_surfaces, {**values, "candidate": NO_CANDIDATE}, names, search, bound_of_surfaces)
    return (made,) * min(n_pairs, MOST_NEAR)


def _sides(features: Features) -> int:
    """Return the largest number of sides of a face or of edges of a corner."""
    faces = np.array(features.edges, dtype=int).reshape(-1, 4)[:, 2:].ravel()
    return max(int(np.max(np.bincount(faces[faces >= 0]), initial=1)), max(map(len, features.stars)))


def limits(n_pairs: int, extents: Sequence[float]) -> dict[str, Value]:
    """Return the numbers that limit a search (:mod:`bodies.contacts.surface.surface_near`), by their names.

    ``most`` is the largest number of candidates; they may fill it up to a margin of ``narrow`` [m].  ``turning`` is the
    largest relative rotation per margin [rad/m]: a body turns by at most the displacement of its points over its extent
    [m], and both bodies together move by at most the margin.  ``extents`` are those of the bodies that have edges, one
    or two; a ball does not turn.
    """
    most = float(min(n_pairs, MOST_NEAR))
    return {"most": most, "turning": 1.0 / min(extents), "narrow": NARROW * min(extents)}


def _fixed(values: dict[str, Value], pair: tuple[float, int, int], one: Swept, two: Swept) -> FeaturePair:
    """Return the contact of a pair of features that never changes, by its kind and its numbers."""
    kind, i, j = pair
    if kind == EDGE_ACROSS:
        names = [f"{part_names(one.features, 'edge')[i]} and {part_names(two.features, 'edge')[j]}"]
    elif kind == OVER_FIRST:
        names = [f"{part} and {two.corner_name(j)}" for part in part_names(one.features)]
    else:
        names = [f"{one.corner_name(j)} and {part}" for part in part_names(two.features)]
    return FeaturePair(evaluate_surfaces, values, tuple(names), None, bound_of_surfaces)


def _swept(shape: Shape) -> Swept:
    """Return a surface, with the radius about it, as one side of a contact."""
    assert isinstance(shape, SurfaceShape)
    return Swept(shape.features, shape.sweep, shape.extent)


def _ball(shape: Point | Sphere, radius: float, name: str) -> Swept:
    """Return a ball as a surface: a single corner, without edges, and a radius about it [m]."""
    nothing, place = np.zeros((0, 3)), np.array([[shape.x, shape.y, shape.z]])
    whole = nothing.astype(np.int64)
    features = Features(place, whole, whole[:, 0], np.zeros((0, 4)), nothing > 0.0, (), (0,), ((),))
    return Swept(features, radius, shape.extent, name)


@final
class SurfaceSurface(ContactKinematics):
    """Contacts of two surfaces: edges that cross, and corners of either body over patches of the other.

    A surface is a box, a hull, a capsule or a mesh, convex or not.  A face on a face is several such contacts at once.
    Which contacts can close depends only on the surfaces next to the contact points, so that the bodies need not be
    convex.

    A corner touches a patch, faces of which it touches only one at a time (:mod:`bodies.meshes.patches`).  A convex
    surface is one patch.  If one of the bodies is rounded, a corner is a ball or a point, and touches the nearest face,
    edge or corner.  If there are more than a few pairs of features, a search assigns near pairs to the contacts.
    """

    pair = SurfaceShape, SurfaceShape

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the contacts of pairs of edges, then of the second body's corners, then of the first's corners."""
        return contacts_of(_swept(first), _swept(second))


@final
class SurfacePoint(ContactKinematics):
    """Contacts of a point with the patches of a surface; in an inner corner, a point touches two faces at once."""

    pair = SurfaceShape, Point

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return a contact for each patch, or for near ones if there are many."""
        assert isinstance(second, Point)
        return contacts_of(_swept(first), _ball(second, 0.0, "point"))


@final
class SurfaceSphere(ContactKinematics):
    """The contact of a sphere with the nearest face, convex edge or corner of each patch of a surface.

    The surface is divided into patches, so that a sphere of this size touches one feature of a patch at a time
    (:mod:`bodies.meshes.patches`).  A convex surface is one patch; a mesh with inner corners has two or more.
    """

    pair = SurfaceShape, Sphere

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return a contact for each patch, or for near ones if there are many."""
        assert isinstance(second, Sphere)
        return contacts_of(_swept(first), _ball(second, second.radius, "sphere"))
