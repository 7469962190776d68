"""Bodies that are pressed into each other: aligned, shifted, turned, tilted or anyhow."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from bodies import BoxBody, CylinderBody, HullBody
from nonsmooth.interfaces import Body
from tests.benchmarks.random_systems.families.aligned import UPRIGHT, about, product
from tests.bodies.pressed import Pressed, any_turn, brought, faults, stacked

SIZE = 0.05
"""Half of the length of the bodies [m]."""
DEPTHS = (1e-9, 1e-7, 1e-5, 1e-3, 1e-2)
"""Depths relative to the size."""
_LEAN = 10.0
"""Edges of faces that are tilted by an angle cross along a normal that leans by a few times as much."""


def _cube() -> Body:
    return BoxBody(SIZE, SIZE, SIZE)


def _brick() -> Body:
    return BoxBody(SIZE, 0.6 * SIZE, 0.4 * SIZE)


def _hull() -> Body:
    signs = itertools.product((-SIZE, SIZE), repeat=3)
    return HullBody([(x, 0.6 * y, 0.4 * z) for x, y, z in signs])


def _prism() -> Body:
    ring = [(SIZE * math.cos(k * math.pi / 3.0), SIZE * math.sin(k * math.pi / 3.0)) for k in range(6)]
    return HullBody([(x, y, z) for x, y in ring for z in (-SIZE, SIZE)])


def _tetrahedron() -> Body:
    return HullBody([(SIZE, SIZE, SIZE), (-SIZE, -SIZE, SIZE), (-SIZE, SIZE, -SIZE), (SIZE, -SIZE, -SIZE)])


def _cylinder() -> Body:
    return CylinderBody(SIZE, 1.4 * SIZE, foot_height=0.0)


ALL = (0, 1, 2)
PAIRS: dict[str, tuple[Callable[[], Body], Callable[[], Body], tuple[int, ...]]] = {
    "cubes": (_cube, _cube, ALL),
    "bricks": (_brick, _brick, ALL),
    "hulls": (_hull, _hull, ALL),
    "brick, hull": (_brick, _hull, ALL),
    "prisms": (_prism, _prism, (1, 2)),
    "tetrahedra": (_tetrahedron, _tetrahedron, ALL),
    "cylinders": (_cylinder, _cylinder, ALL),
    "cube, cylinder": (_cube, _cylinder, ALL),
}
"""What makes the bodies, and the axes along which their faces or generators meet."""


@dataclass(frozen=True)
class Arrangement:
    """Shift relative to the size, turn about the line of the centres and tilt across it [rad] of the second body."""

    shift: float = 0.0
    turn: float = 0.0
    tilt: float = 0.0


ARRANGEMENTS: dict[str, Arrangement | None] = {
    "aligned": Arrangement(),
    "shifted by 1e-6": Arrangement(1e-6),
    "shifted by 1e-3": Arrangement(1e-3),
    "shifted": Arrangement(0.12),
    "turned by 1e-9": Arrangement(0.0, 1e-9),
    "turned by 1e-6": Arrangement(0.0, 1e-6),
    "turned by 1e-3": Arrangement(0.0, 1e-3),
    "turned": Arrangement(0.0, 0.3),
    "turned by a quarter": Arrangement(0.0, 0.5 * math.pi),
    "shifted and turned": Arrangement(0.12, 0.3),
    "tilted by 1e-9": Arrangement(0.0, 0.0, 1e-9),
    "tilted by 1e-6": Arrangement(0.1, 0.0, 1e-6),
    "tilted by 1e-3": Arrangement(0.1, 0.2, 1e-3),
    "anyhow": None,
}
"""How the second body lies to the first; None for any orientation of both, and any direction."""


def _poses(name: str, chosen: Arrangement | None) -> Iterator[tuple[Pressed, float]]:
    make, other, axes = PAIRS[name]
    for number, (depth, axis) in enumerate(itertools.product(DEPTHS, axes)):
        if chosen is None:
            random = np.random.default_rng([3, number])
            way, turns = random.normal(size=3), (any_turn(random), any_turn(random))
            yield brought((make(), other()), turns, way / np.linalg.norm(way), depth * SIZE), 0.0
            continue
        tilt = about(np.eye(3)[(axis + 1) % 3], chosen.tilt)
        turn = product(tilt, about(np.eye(3)[axis], chosen.turn))
        across = chosen.shift * SIZE * np.array([1.0, 0.6])
        yield stacked((make(), other()), axis, depth * SIZE, across, (UPRIGHT, turn)), _LEAN * chosen.tilt


def all_faults(name: str, arrangement: str) -> list[str]:
    """Return what is wrong with the contacts of a pair in an arrangement, at all depths along all axes."""
    return [text for pose, angle in _poses(name, ARRANGEMENTS[arrangement]) for text in faults(pose, angle)]
