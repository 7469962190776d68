"""Pairs of polyhedra, rounded or sharp, and capsules for the table of accuracy: which features are the nearest."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from bodies import Box, Capsule, ConvexHull, Plane, SweptPolytope
from nonsmooth.interfaces import Shape
from tests.bodies.polytopes import random_hull
from tests.bodies.swept_poses import Posed, feature

Array = NDArray[np.float64]
Known = tuple[tuple[Shape, Shape], Any, float, Array, Array, int]
"""Shapes, poses, gap, normal, witness points, and the number of the contact."""
Draw = Callable[[Generator], SweptPolytope]


def _sizes(rng: Generator) -> list[float]:
    return [float(x) for x in rng.uniform(4e-3, 10e-3, 3)]


def _turned(rng: Generator) -> dict[str, float]:
    q = rng.normal(size=4)
    return dict(zip([f"orientation_{c}" for c in "wxyz"], (q / np.linalg.norm(q)).tolist(), strict=True))


def box(rng: Generator) -> Box:
    """Return a sharp box."""
    return Box(*_sizes(rng), **_turned(rng))


def rounded_box(rng: Generator) -> Box:
    """Return a box with a rounding of 0.5 to 2 mm."""
    return replace(box(rng), rounding=float(rng.uniform(5e-4, 2e-3)))


def hull(rng: Generator) -> ConvexHull:
    """Return a sharp hull of ten points."""
    return random_hull(rng, 10, 8e-3)


def rounded_hull(rng: Generator) -> ConvexHull:
    """Return a hull with a rounding of 0.5 to 2 mm."""
    return replace(hull(rng), rounding=float(rng.uniform(5e-4, 2e-3)))


def capsule(rng: Generator) -> Capsule:
    """Return a capsule."""
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    return Capsule(float(rng.uniform(1e-3, 4e-3)), float(rng.uniform(4e-3, 10e-3)), 0.0, 0.0, 0.0, *axis.tolist())


def _of_two(first: Draw, second: Draw, kind: str) -> Callable[[float, Generator], Known]:
    def make(gap: float, rng: Generator) -> Known:
        shapes = first(rng), second(rng)
        posed = Posed(rng, shapes, kind, gap)
        return shapes, posed.poses, gap, posed.normal, np.array(posed.witness), posed.number

    return make


def _on_plane(second: Draw) -> Callable[[float, Generator], Known]:
    def make(gap: float, rng: Generator) -> Known:
        plane, shape = Plane(float(rng.uniform(-0.01, 0.01))), second(rng)
        vertex, out, number = feature(rng, shape, "vertex")
        frame, place = Rotation.random(random_state=rng), rng.uniform(-0.1, 0.1, 3)
        n = frame.apply([0.0, 0.0, 1.0])
        facing, _ = Rotation.align_vectors([-n], [out])
        facing = Rotation.from_rotvec(rng.uniform(0.0, 6.0) * n) * facing
        touched = place + frame.apply([*rng.uniform(-0.1, 0.1, 2), plane.height])
        # where the normal has been turned to but for round-off, a sphere's farthest point is along it
        other = touched + (gap + shape.sweep) * n - facing.apply(vertex)
        poses = [(place, np.roll(frame.as_quat(), 1)), (other, np.roll(facing.as_quat(), 1))]
        return (plane, shape), poses, gap, n, np.array([touched, touched + gap * n]), number

    return make


_EDGES = ("edge-edge", "edge-vertex", "vertex-edge")
_ALL = ("face-vertex", "vertex-face", *_EDGES, "vertex-vertex")
_TWO: dict[str, tuple[Draw, Draw, tuple[str, ...]]] = {
    "box-box": (box, box, ("face-vertex", "edge-edge")),
    "hull-hull": (hull, hull, ("face-vertex", "edge-edge")),
    "rounded box-rounded box": (rounded_box, rounded_box, _ALL),
    "rounded box-box": (rounded_box, box, ("face-vertex", "edge-edge", "edge-vertex")),
    "rounded hull-rounded hull": (rounded_hull, rounded_hull, ("face-vertex", "edge-edge", "vertex-vertex")),
    "box-capsule": (box, capsule, ("face-vertex", *_EDGES, "vertex-vertex")),
    "hull-capsule": (hull, capsule, ("face-vertex", "edge-edge")),
}
SWEPT: dict[str, Callable[[float, Generator], Known]] = {
    "plane-box": _on_plane(box),
    "plane-hull": _on_plane(hull),
    "plane-rounded box": _on_plane(rounded_box),
    "plane-rounded hull": _on_plane(rounded_hull),
    **{f"{name}, {kind}": _of_two(a, b, kind) for name, (a, b, kinds) in _TWO.items() for kind in kinds},
}
"""A pose of the pair at a gap."""
