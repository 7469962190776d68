"""Pairs of cylinders, cones and discs with rounded bodies for the table of accuracy, by the nearest features."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from laws import EnergeticImpact, Frictionless, Unilateral
from nonsmooth.interfaces import Shape
from tests.benchmarks.touches import ROUND, box, on, on_round, rounded
from tests.bodies.carriers import Rig
from tests.bodies.rounds import PosedRound, tangent

Array = NDArray[np.float64]
Known = tuple[tuple[Shape, Shape], Any, float, Array, Array, int]
"""Shapes, poses, gap, normal, witness points, and the number of the contact."""


def _edge_at(shape: Any, point: Array, normal: Array) -> Array | None:
    """Return the direction of the edge of the core that a point is on, if it is on one."""
    vertices, point = np.array(shape.core.vertices), point - shape.sweep * normal
    for one, two, *_ in shape.core.edges:
        way = vertices[two] - vertices[one]
        ends = [float(np.linalg.norm(point - end)) for end in (vertices[one], vertices[two])]
        if min(ends) > 1e-9 and sum(ends) < np.linalg.norm(way) + 1e-12:
            return np.asarray(way / np.linalg.norm(way))
    return None


def _known(gap: float, rng: Generator, one: str, part: str, touch: Any) -> Known:
    first, second = on_round(ROUND[one][0], part)(rng), touch(rng)
    posed = PosedRound(rng, first, second, (tangent(first[0], part, first[2]), _edge_at(*second)), gap)
    shapes: tuple[Any, Any] = first[0], second[0]
    laws = {"normal": Unilateral(), "friction": Frictionless(), "impact": EnergeticImpact(restitution=1.0)}
    rig = Rig(shapes, laws)
    rig.put(posed.poses, np.zeros(12))
    blocks = rig.geometry
    nearest = int(np.argmin(np.where(blocks[:, 30] <= 0.0, blocks[:, 0], np.inf)))
    return shapes, posed.poses, gap, posed.normal, np.array(posed.witness), nearest


def _line(one: str, part: str, touch: Callable[[Generator], Any]) -> Callable[[float, Generator], Known]:
    return lambda gap, rng: _known(gap, rng, one, part, touch)


_ROUNDED_BOX = {
    "cylinder": ("rim-face", "rim-edge", "rim-vertex", "side-edge", "side-vertex", "cap-vertex"),
    "cone": ("side-edge", "apex-face", "apex-edge", "apex-vertex"),
    "disc": ("rim-edge", "cap-vertex"),
}
ROUND_PAIRS: dict[str, Callable[[float, Generator], Known]] = {
    f"{one}-rounded box, {kind}": _line(one, kind.split("-")[0], on(rounded(box), kind.split("-")[1]))
    for one, kinds in _ROUNDED_BOX.items()
    for kind in kinds
}
"""A pose of the pair at a gap."""
