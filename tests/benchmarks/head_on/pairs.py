"""Pairs of bodies that meet head on, with the axes about which both are symmetric."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass

import trimesh

from bodies import (
    Ball,
    BoxBody,
    CapsuleBody,
    Compound,
    ConeBody,
    CylinderBody,
    DiscBody,
    EllipsoidBody,
    HullBody,
    MeshBody,
    Part,
    SuperellipsoidBody,
    SupportBody,
    Triangles,
)
from nonsmooth.interfaces import Body
from tests.benchmarks.random_systems.solids import prism, upright
from tests.bodies.given_shapes import SameEllipsoid

Corner = tuple[float, float, float]
Make = Callable[[], Body]
ALL = (0, 1, 2)
WALL = (-0.04, 0.04)
"""Places of the middles of the walls of the hollow box [m]."""


@dataclass(frozen=True)
class Pair:
    """Two bodies that meet.

    Attributes
    ----------
    one, two : callable
        Make the bodies.
    central : tuple of int
        Axes about which half a turn changes neither body: their impact is central.
    seen : tuple of callable
        Bodies of the same solids, whose convex pieces the independent measurement knows.
    """

    one: Make
    two: Make
    central: tuple[int, ...]
    seen: tuple[Make, Make]


def _pair(one: Make, two: Make | None = None, central: tuple[int, ...] = ALL, seen: Make | None = None) -> Pair:
    other = one if two is None else two
    return Pair(one, other, central, (one, other) if seen is None else (seen, seen))


def _corners(x: float, y: float, z: float) -> list[Corner]:
    return [(i, j, k) for i, j, k in itertools.product((-x, x), (-y, y), (-z, z))]


def _prism(n: int) -> Body:
    angles = [2.0 * math.pi * k / n for k in range(n)]
    return HullBody([(0.05 * math.cos(a), 0.05 * math.sin(a), z) for a in angles for z in (-0.05, 0.05)])


def _mesh(made: trimesh.Trimesh) -> Body:
    return MeshBody(Triangles(made.vertices.tolist(), made.faces.tolist()))


def _boxes(*rows: tuple[Corner, Corner]) -> Body:
    """Return boxes of given halves at given places as one body."""
    return Compound(tuple(Part(BoxBody(*halves), place) for halves, place in rows))


def _cube() -> Body:
    return BoxBody(0.05, 0.05, 0.05)


def _brick() -> Body:
    return BoxBody(0.05, 0.03, 0.02)


def _hull_brick() -> Body:
    return HullBody(_corners(0.05, 0.03, 0.02))


def _cylinder() -> Body:
    return CylinderBody(0.05, 0.07)


def _smooth_cylinder() -> Body:
    return CylinderBody(0.05, 0.07, foot_height=0.0)


def _ellipsoid() -> Body:
    return EllipsoidBody(0.05, 0.03, 0.02)


def _hollow() -> Body:
    """Return a square tube along the third axis out of four walls."""
    across = [((0.01, 0.05, 0.05), (x, 0.0, 0.0)) for x in WALL]
    return _boxes(*across, *(((0.03, 0.01, 0.05), (0.0, y, 0.0)) for y in WALL))


def _hollow_mesh() -> Body:
    made = trimesh.creation.annulus(0.03 * math.sqrt(2.0), 0.05 * math.sqrt(2.0), 0.1, sections=4)
    made.apply_transform(trimesh.transformations.rotation_matrix(0.25 * math.pi, (0.0, 0.0, 1.0)))
    return _mesh(made)


def _outline(name: str) -> Body:
    return MeshBody(prism(name, 0.08 * upright(name, 0.5)))


def _u() -> Body:
    """Return a U out of three boxes that opens along the second axis."""
    arms = [((0.01, 0.03, 0.02), (x, 0.04, 0.0)) for x in WALL]
    return _boxes(((0.05, 0.01, 0.02), (0.0, 0.0, 0.0)), *arms)


def _l() -> Body:
    """Return an L out of two boxes."""
    return _boxes(((0.05, 0.01, 0.02), (0.0, 0.0, 0.0)), ((0.01, 0.03, 0.02), (-0.04, 0.04, 0.0)))


def _bar() -> Body:
    """Return two cubes side by side as one body."""
    return _boxes(((0.03, 0.03, 0.03), (0.0, 0.0, 0.0)), ((0.03, 0.03, 0.03), (0.06, 0.0, 0.0)))


PAIRS: dict[str, Pair] = {
    "ball": _pair(lambda: Ball(0.05)),
    "cube": _pair(_cube),
    "brick": _pair(_brick),
    "flat brick": _pair(lambda: BoxBody(0.05, 0.04, 0.02)),
    "rounded brick": _pair(lambda: BoxBody(0.05, 0.03, 0.02, rounding=0.004)),
    "hull": _pair(_hull_brick),
    "mesh": _pair(lambda: _mesh(trimesh.creation.box((0.1, 0.06, 0.04)))),
    "tetrahedron": _pair(
        lambda: HullBody([(x * 0.05, y * 0.05, x * y * 0.05) for x, y in itertools.product((-1, 1), repeat=2)])
    ),
    "prism of 6": _pair(lambda: _prism(6)),
    "prism of 8": _pair(lambda: _prism(8)),
    "cylinder": _pair(_cylinder),
    "cylinder without feet": _pair(_smooth_cylinder),
    "cylinder without feet, box": _pair(_smooth_cylinder, lambda: BoxBody(0.06, 0.06, 0.07)),
    "rounded cylinder without feet": _pair(lambda: CylinderBody(0.05, 0.07, rounding=0.005, foot_height=0.0)),
    "rounded cylinder": _pair(lambda: CylinderBody(0.05, 0.07, rounding=0.005)),
    "coin": _pair(lambda: CylinderBody(0.012, 0.001)),
    "cone": _pair(lambda: ConeBody(0.05, 0.05), central=(2,)),
    "disc": _pair(lambda: DiscBody(0.05)),
    "rounded disc": _pair(lambda: DiscBody(0.05, rounding=0.003)),
    "capsule": _pair(lambda: CapsuleBody(0.03, 0.05)),
    "ellipsoid": _pair(_ellipsoid),
    "superellipsoid": _pair(lambda: SuperellipsoidBody(0.05, 0.04, 0.03, 0.5, 0.5)),
    "support": _pair(lambda: SupportBody(SameEllipsoid(0.05, 0.03, 0.02)), seen=_ellipsoid),
    "hollow box": _pair(_hollow),
    "hollow mesh": _pair(_hollow_mesh, seen=_hollow),
    "U": _pair(_u, central=(1,)),
    "U of a mesh": _pair(lambda: _outline("U"), central=()),
    "L": _pair(_l, central=()),
    "L of a mesh": _pair(lambda: _outline("L"), central=()),
    "compound": _pair(_bar),
    "cube, U": _pair(_cube, _u, central=(1,)),
    "cube, longer": _pair(_cube, lambda: BoxBody(0.2, 0.05, 0.05)),
    "cube, wider": _pair(_cube, lambda: BoxBody(0.05, 0.06, 0.05)),
    "cube, wider twice": _pair(_cube, lambda: BoxBody(0.05, 0.06, 0.06)),
    "cube, half as wide": _pair(_cube, lambda: BoxBody(0.05, 0.025, 0.05)),
    "brick, hull": _pair(_brick, _hull_brick),
    "brick, mesh": _pair(_brick, lambda: _mesh(trimesh.creation.box((0.1, 0.06, 0.04)))),
    "cube, prism of 6": _pair(_cube, lambda: _prism(6)),
    "box, cylinder": _pair(lambda: BoxBody(0.05, 0.05, 0.07), _cylinder),
    "cylinder, wider": _pair(_cylinder, lambda: CylinderBody(0.06, 0.07)),
    "cylinder, longer": _pair(_smooth_cylinder, lambda: CylinderBody(0.05, 0.1, foot_height=0.0)),
    "cylinder, cone": _pair(lambda: CylinderBody(0.05, 0.05), lambda: ConeBody(0.05, 0.1), central=(2,)),
    "cube, rounded cube": _pair(_cube, lambda: BoxBody(0.05, 0.05, 0.05, rounding=0.005)),
    "cube, capsule": _pair(_cube, lambda: CapsuleBody(0.02, 0.05)),
    "cube, disc": _pair(_cube, lambda: DiscBody(0.05)),
    "cylinder, disc": _pair(lambda: CylinderBody(0.05, 0.05), lambda: DiscBody(0.05)),
}
"""The pairs by their names."""
