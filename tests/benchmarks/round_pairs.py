"""Pairs of cylinders, cones and discs with rounded bodies for the table of accuracy, by the nearest features."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from bodies import Frustum
from laws import EnergeticImpact, Frictionless, Unilateral
from nonsmooth.interfaces import Shape
from tests.benchmarks.touches import ROUND, ROUNDED_ROUND, Touch, box, on, on_plane, on_round, rounded
from tests.bodies.carriers import Rig
from tests.bodies.rounds import PosedRound, tangent

Array = NDArray[np.float64]
Known = tuple[tuple[Shape, Shape], Any, float, Array, Array, int]
"""Shapes, poses, gap, normal, witness points, and the number of the contact."""
Touching = Callable[[Generator], Touch]
SOLIDS = {"box": box, "rounded box": rounded(box)}


def _edge_at(shape: Any, point: Array, normal: Array) -> Array | None:
    """Return the direction of the edge of the core that a point is on, if it is on one."""
    vertices, point = np.array(shape.core.vertices), point - shape.sweep * normal
    for one, two, *_ in shape.core.edges:
        way = vertices[two] - vertices[one]
        ends = [float(np.linalg.norm(point - end)) for end in (vertices[one], vertices[two])]
        if min(ends) > 1e-9 and sum(ends) < np.linalg.norm(way) + 1e-12:
            return np.asarray(way / np.linalg.norm(way))
    return None


def _tangent(touch: Touch, part: str) -> Array | None:
    shape, point, normal = touch
    return tangent(shape, part, normal) if isinstance(shape, Frustum) else _edge_at(shape, point, normal)


def _known(gap: float, rng: Generator, one: Touching, part: str, two: Touching, other: str) -> Known:
    first, second = one(rng), two(rng)
    crossing = part != "plane" and (part == other == "side" or "edge" in other)
    ways = (_tangent(first, part), _tangent(second, other)) if crossing else (None, None)
    posed = PosedRound(rng, first, second, ways, gap)
    shapes = first[0], second[0]
    laws = {"normal": Unilateral(), "friction": Frictionless(), "impact": EnergeticImpact(restitution=1.0)}
    rig = Rig(shapes, laws)
    rig.put(posed.poses, np.zeros(12))
    blocks = rig.geometry
    nearest = int(np.argmin(np.where(blocks[:, 30] <= 0.0, blocks[:, 0], np.inf)))
    return shapes, posed.poses, gap, posed.normal, np.array(posed.witness), nearest


def _touching(name: str, part: str, is_on_feet: bool) -> Touching:
    if name == "plane":
        return on_plane
    if name in SOLIDS:
        return on(SOLIDS[name], part)
    return on_round({**ROUND, **ROUNDED_ROUND}[name][0], part, is_on_feet)


def _line(one: str, two: str, parts: str) -> Callable[[float, Generator], Known]:
    part, other = parts.split("-")
    # a rounded apex touches a cap as without feet
    is_on_feet = "apex" not in (part, other)
    touches = _touching(one, part, is_on_feet), _touching(two, other, is_on_feet)
    return lambda gap, rng: _known(gap, rng, touches[0], part, touches[1], other)


_LINES = {
    ("cylinder", "rounded box"): ("rim-face", "rim-edge", "rim-vertex", "side-edge", "side-vertex", "cap-vertex"),
    ("cone", "rounded box"): ("side-edge", "apex-face", "apex-edge", "apex-vertex"),
    ("disc", "rounded box"): ("rim-edge", "cap-vertex"),
    ("plane", "rounded cylinder"): ("plane-rim",),
    ("plane", "rounded cone"): ("plane-apex",),
    ("rounded cylinder", "box"): ("rim-face", "rim-edge", "side-edge", "cap-vertex"),
    ("rounded cone", "rounded box"): ("rim-edge", "side-edge", "apex-edge"),
    ("rounded cylinder", "rounded cone"): ("rim-rim", "rim-side", "side-side", "side-rim", "cap-rim", "cap-apex"),
    ("rounded cone", "rounded cone"): ("apex-side", "apex-rim", "apex-apex"),
    ("rounded disc", "rounded disc"): ("rim-rim", "rim-cap"),
}
"""Features of every two shapes."""
ROUND_PAIRS: dict[str, Callable[[float, Generator], Known]] = {
    f"{one}-{two}, {kind}": _line(one, two, kind) for (one, two), kinds in _LINES.items() for kind in kinds
}
"""A pose of the pair at a gap."""
