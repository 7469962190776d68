"""Pairs of a mesh that is not convex for the table of accuracy: which features are the nearest.

The mesh is a bracket, an L.  It is touched where its convex hull is, so that nothing else is near; spheres touch it
anywhere, if they fit there.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from bodies import Box, Ellipsoid, Sphere, Superellipsoid, SweptPolytope, TriangleMesh, Triangles
from bodies.contacts.frustum.frustum_surface import (
    ACROSS_BACK,
    ACROSS_FLANK,
    ACROSS_FRONT,
    APEX,
    POINT,
    RIM,
    UNDER,
)
from bodies.meshes.features import Features
from bodies.meshes.patches import Patches, patches_for_ball, patches_for_body, patches_of_faces
from bodies.shapes.smooth import extent
from nonsmooth.interfaces import Shape
from nonsmooth.testing.puck import ContactRig
from tests.benchmarks.swept_pairs import capsule, rounded_box, rounded_hull
from tests.bodies.every_pair import pairs_of
from tests.bodies.meshes.parts import bracket
from tests.bodies.rounds import PosedRound, tangent, touch_round
from tests.bodies.surfaces import distances, is_inside
from tests.bodies.swept_poses import feature

Array = NDArray[np.float64]
Known = tuple[tuple[Shape, Shape], Any, float, Array, Array, int]
"""Shapes, poses, gap, normal, witness points, and the number of the contact."""
Round = Sphere | Ellipsoid | Superellipsoid


def any_mesh(rng: Generator) -> TriangleMesh:
    """Return a bracket of any size and proportions, turned."""
    points, triangles = bracket(float(rng.uniform(8e-3, 15e-3)))
    q = rng.normal(size=4)
    stretched = (points - np.mean(points, axis=0)) * rng.uniform(0.4, 0.7, 3)
    return TriangleMesh(Triangles(stretched, triangles, "bracket"), 0.0, 0.0, 0.0, *(q / np.linalg.norm(q)).tolist())


def _outer(features: Features) -> list[int]:
    """Return the faces of which the whole body is on one side."""
    heights = features.vertices @ features.planes[:, :3].T - features.planes[:, 3]
    return [int(i) for i in np.flatnonzero(np.max(heights, axis=0) < 1e-9)]


def _feature(rng: Generator, features: Features, part: str, only_outer: bool) -> tuple[int, Array, Array]:
    """Return number, a point and a normal of a face, edge or vertex."""
    outer = set(_outer(features)) if only_outer else set(range(len(features.planes)))
    normals = features.planes[:, :3]
    while True:
        if part == "face":
            triangle = int(rng.integers(len(features.triangles)))
            number = int(features.face_of[triangle])
            corners, faces = features.triangles[triangle].tolist(), [number]
        elif part == "edge":
            number = int(rng.integers(len(features.edges)))
            corners, faces = list(features.edges[number][:2]), list(features.edges[number][2:])
        else:
            number = int(rng.integers(len(features.corners)))
            corners = [features.corners[number]]
            faces = sorted(features.faces_at[corners[0]])
        n = rng.uniform(0.2, 1.0, len(faces)) @ normals[faces]
        n /= np.linalg.norm(n)
        shares = rng.uniform(0.2, 1.0, len(corners))
        ways = [] if part != "vertex" else features.vertices[list(features.stars[number])] - features.vertices[corners]
        if outer.issuperset(faces) and all(n @ way < -0.1 * np.linalg.norm(way) for way in ways):
            return number, shares @ features.vertices[corners] / np.sum(shares), n


def _known(rng: Generator, shapes: tuple[Shape, Shape], gap: float, own: Any, other: Any, contact: int) -> Known:
    """Return what is known of two shapes with a point and a normal each, put the gap apart."""
    (point, n), (touching, m) = own, other
    first = Rotation.random(random_state=rng)
    axis = np.cross(m, -n)
    angle = np.arctan2(np.linalg.norm(axis), -(m @ n))
    facing = Rotation.from_rotvec(angle * axis / np.linalg.norm(axis))
    second = first * Rotation.from_rotvec(rng.uniform(-3.0, 3.0) * n) * facing
    place, normal = rng.uniform(-0.1, 0.1, 3), first.apply(n)
    witness = place + first.apply(point)
    poses = (
        (place, np.roll(first.as_quat(), 1)),
        (witness + gap * normal - second.apply(touching), np.roll(second.as_quat(), 1)),
    )
    return shapes, poses, gap, normal, np.array([witness, witness + gap * normal]), contact


def _round(rng: Generator, kind: str) -> Round:
    sizes = [float(x) for x in rng.uniform(4e-3, 10e-3, 3)]
    if kind == "sphere":
        return Sphere(float(rng.uniform(5e-4, 4e-3)), *rng.uniform(-2e-3, 2e-3, 3).tolist())
    if kind == "ellipsoid":
        return Ellipsoid(*sizes)
    low, high = rng.uniform(0.2, 0.9, 2).tolist(), rng.uniform(1.1, 1.5, 2).tolist()
    exponents = {"superellipsoid": high, "boxy": low, "mixed": [low[0], high[0]]}[kind]
    return Superellipsoid(*sizes, *exponents)


def _least_radius(shape: Round, n: Array) -> float:
    """Return the least radius of curvature where ``n`` is the normal [m], by differences."""
    first = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
    first /= np.linalg.norm(first)
    tangents, e = (first, np.cross(n, first)), 1e-4
    rows = [[t @ (shape.support(n + e * s) - shape.support(n - e * s)) / (2.0 * e) for s in tangents] for t in tangents]
    return float(np.linalg.eigvalsh(np.array(rows))[0])


def _patch(patches: Patches, part: str, number: int) -> int:
    return {"face": patches.of_faces, "edge": patches.of_edges, "vertex": patches.of_corners}[part][number]


def _with_round(kind: str, part: str) -> Callable[[float, Generator], Known]:
    def draw(gap: float, rng: Generator) -> Known:
        while True:
            mesh, second = any_mesh(rng), _round(rng, kind)
            features = mesh.features
            if isinstance(second, Sphere):
                patches = patches_for_ball(features, second.radius)
            else:
                patches = patches_for_body(features, 2.0 * extent(second.core))
            # not where a slight overlap is more than the body is round
            number, point, n = _feature(rng, features, part, kind != "sphere" or gap > 1e-2)
            m = rng.normal(size=3)
            m /= np.linalg.norm(m)
            if gap < 0.0 and _least_radius(second, m) < -4.0 * gap:
                continue
            if isinstance(second, Sphere):
                center = (point + (gap + second.radius) * n)[None]
                corners = features.vertices[features.triangles]
                if is_inside(center, corners)[0] or distances(center, corners)[0] < gap + second.radius - 1e-12:
                    continue
            touching = np.asarray(second.support(m))
            return _known(rng, (mesh, second), gap, (point, n), (touching, m), _patch(patches, part, number))

    return draw


def _with_box(part: str, other_part: str) -> Callable[[float, Generator], Known]:
    def draw(gap: float, rng: Generator) -> Known:
        mesh, box = any_mesh(rng), Box(*[float(x) for x in rng.uniform(4e-3, 10e-3, 3)])
        one, two = mesh.features, box.features
        number, point, n = _feature(rng, one, part, True)
        other, touching, m = _feature(rng, two, other_part, True)
        crossings = len(one.edges) * len(two.edges)
        patches = patches_of_faces(one) if one.is_convex else patches_for_ball(one, 0.0)
        if part == "edge":
            contact = number * len(two.edges) + other
        elif part == "face":
            contact = crossings + patches.of_faces[number] * len(two.corners) + other
        else:
            contact = crossings + patches.count * len(two.corners) + other * len(one.corners) + number
        known = _known(rng, (mesh, box), gap, (point, n), (touching, m), contact)
        if part != "edge":
            return known
        ways = one.vertices[list(one.edges[number][:2])], two.vertices[list(two.edges[other][:2])]
        return known if _cross(known, *ways) else draw(gap, rng)

    return draw


def _cross(known: Known, first: Array, second: Array) -> bool:
    """Return whether edges of the two shapes are at more than 0.1 rad to each other."""
    turns = [Rotation.from_quat(np.roll(q, -1)) for _, q in known[1]]
    ways = [turn.apply(ends[1] - ends[0]) for turn, ends in zip(turns, (first, second), strict=True)]
    across = np.linalg.norm(np.cross(*ways))
    return bool(across > 0.1 * np.linalg.norm(ways[0]) * np.linalg.norm(ways[1]))


def _with_swept(shape: Callable[[Generator], SweptPolytope], part: str, other_part: str) -> Callable[..., Known]:
    def draw(gap: float, rng: Generator) -> Known:
        mesh, second = any_mesh(rng), shape(rng)
        own, core = mesh.features, second.core
        number, point, n = _feature(rng, own, part, True)
        touching, m, other = feature(rng, second, other_part)
        patches, crossings = patches_for_ball(own, second.sweep), len(own.edges) * len(core.edges)
        if other_part == "vertex":
            contact = crossings + _patch(patches, part, number) * len(core.vertices) + other
        elif part == "vertex":
            contact = crossings + len(core.vertices) * patches.count + number
        else:
            contact = number * len(core.edges) + other
        known = _known(rng, (mesh, second), gap, (point, n), (touching + second.sweep * m, m), contact)
        if part != "edge" or other_part != "edge":
            return known
        ends = np.array(core.vertices)[list(core.edges[other][:2])]
        return known if _cross(known, own.vertices[list(own.edges[number][:2])], ends) else draw(gap, rng)

    return draw


def _with_frustum(name: str, part: str, other: str) -> Callable[[float, Generator], Known]:
    def draw(gap: float, rng: Generator) -> Known:
        mesh, first = any_mesh(rng), touch_round(rng, name, part)
        number, point, n = _feature(rng, mesh.features, other, True)
        along = None
        if other == "edge":
            along = np.subtract(*mesh.features.vertices[list(mesh.features.edges[number][:2])])
            along /= np.linalg.norm(along)
        posed = PosedRound(rng, first, (mesh, point, n), (tangent(first[0], part, first[2]), along), gap)
        shapes = first[0], mesh
        # which half of a rim it is, only the contacts know
        for contact, one in enumerate(pairs_of(*shapes)):
            candidate = one.values["candidate"]
            assert isinstance(candidate, tuple)
            if candidate[0] in _FRUSTUM_KINDS[part, other] and (
                candidate[0] in (POINT, APEX) or candidate[1] == number
            ):
                rig = ContactRig(one, shapes)
                rig.put(posed.poses, np.zeros(12))
                if posed.found_in(rig.geometry[None]):
                    return shapes, posed.poses, gap, posed.normal, np.array(posed.witness), contact
        raise LookupError(f"no contact of {part} and {other} at {posed.poses}")

    return draw


_FRUSTUM_KINDS = {
    ("rim", "face"): (RIM,),
    ("apex", "face"): (POINT, APEX),
    ("apex", "edge"): (APEX,),
    ("side", "edge"): (ACROSS_FLANK,),
    ("rim", "edge"): (ACROSS_BACK, ACROSS_FRONT),
    **{(part, "vertex"): (UNDER,) for part in ("cap", "side", "rim", "apex")},
}
"""Kinds of the contacts of a part of a frustum and a feature of a mesh."""
PARTS = "face", "edge", "vertex"
_OVER_EDGES = (("edge", "edge"), ("vertex", "edge"))
_OVER_ROUND = (("rim", PARTS), ("cap", ("vertex",)), ("side", ("edge", "vertex")))
MESHES: dict[str, Callable[[float, Generator], Known]] = {
    **{
        f"mesh-{kind}, {part}": _with_round(kind, part)
        for kind in ("sphere", "ellipsoid", "superellipsoid", "boxy", "mixed")
        for part in PARTS
    },
    "mesh-box, face and vertex": _with_box("face", "vertex"),
    "mesh-box, edges": _with_box("edge", "edge"),
    "mesh-box, vertex and face": _with_box("vertex", "face"),
    **{
        f"mesh-{name}, {part} and {other}": _with_swept(shape, part, other)
        for name, shape, kinds in (
            ("rounded box", rounded_box, [*((part, "vertex") for part in PARTS), ("vertex", "face"), *_OVER_EDGES]),
            ("rounded hull", rounded_hull, [("edge", "edge")]),
            ("capsule", capsule, _OVER_EDGES),
        )
        for part, other in kinds
    },
    **{
        f"{name}-mesh, {part} and {other}": _with_frustum(name, part, other)
        for name, part, other in (
            ("cylinder", "rim", "face"),
            ("cylinder", "cap", "vertex"),
            ("cylinder", "side", "vertex"),
            ("cylinder", "side", "edge"),
            ("cylinder", "rim", "edge"),
            ("cone", "apex", "face"),
            ("cone", "side", "vertex"),
            ("cone", "side", "edge"),
            ("disc", "rim", "face"),
            ("disc", "rim", "edge"),
            *(("rounded cylinder", part, other) for part, others in _OVER_ROUND for other in others),
            *(("rounded cone", "apex", other) for other in PARTS),
            *(("rounded disc", "rim", other) for other in ("face", "edge")),
        )
    },
}
"""By name, how to draw a pose for a gap."""
