"""Bodies that touch in any orientation: a contact on the list of a run has no gap, and none overlaps."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import numpy as np
import pytest

from bodies import BoxBody, CapsuleBody, ConeBody, CylinderBody, DiscBody, EllipsoidBody, HullBody
from nonsmooth.bodies import Ball
from nonsmooth.interfaces import Body
from tests.bodies.pressed import any_turn, brought

SIZE = 0.05
"""Half of the length of the bodies [m]."""
ACCURACY = 1e-9
"""Error of a gap [m]."""
POSES = 40
"""Poses of a pair."""
_RING = [(SIZE * math.cos(k * math.pi / 3.0), SIZE * math.sin(k * math.pi / 3.0)) for k in range(6)]


def _cloud() -> list[tuple[float, ...]]:
    points = np.random.default_rng(3).normal(size=(12, 3))
    points *= SIZE / np.linalg.norm(points, axis=1)[:, None]
    return [tuple(point) for point in points.tolist()]


POLYHEDRA: dict[str, Callable[[], Body]] = {
    "box": lambda: BoxBody(SIZE, 0.6 * SIZE, 0.4 * SIZE),
    "hull": lambda: HullBody(_cloud()),
    "prism": lambda: HullBody([(x, y, z) for x, y in _RING for z in (-SIZE, SIZE)]),
    "rounded box": lambda: BoxBody(SIZE, 0.6 * SIZE, 0.4 * SIZE, rounding=0.1 * SIZE),
    "rounded hull": lambda: HullBody(_cloud(), rounding=0.1 * SIZE),
}
ROUND: dict[str, Callable[[], Body]] = {
    "ball": lambda: Ball(SIZE),
    "capsule": lambda: CapsuleBody(0.5 * SIZE, SIZE),
    "cylinder": lambda: CylinderBody(SIZE, 1.4 * SIZE, foot_height=0.0),
    "cone": lambda: ConeBody(SIZE, 2.0 * SIZE, foot_height=0.0),
    "disc": lambda: DiscBody(SIZE, foot_height=0.0),
    "ellipsoid": lambda: EllipsoidBody(SIZE, 0.7 * SIZE, 0.5 * SIZE),
}
PAIRS = [*itertools.combinations_with_replacement(POLYHEDRA, 2), *itertools.product(POLYHEDRA, ROUND)]


@pytest.mark.fast_cases(6)
@pytest.mark.parametrize(("one", "other"), PAIRS)
def test_the_nearest_contact_of_a_run_has_no_gap(one: str, other: str) -> None:
    """And no contact has a gap below zero.  Rims are set back by the least height of feet."""
    random = np.random.default_rng(PAIRS.index((one, other)))
    bodies = POLYHEDRA[one](), {**POLYHEDRA, **ROUND}[other]()
    set_back = sum(shape.solid.set_back for body in bodies for frame in body.frames for shape in frame if shape.solid)
    for number in range(POSES):
        way, turns = random.normal(size=3), (any_turn(random), any_turn(random))
        contacts = brought(bodies, turns, way / np.linalg.norm(way), 0.0).contacts(of_all=False)
        least = np.min(contacts.gap[contacts.within], initial=math.inf)
        assert -ACCURACY <= least <= ACCURACY + set_back, f"pose {number}: {least:.3g} m"
