"""Round bodies at any pose: the least gap of the contacts is that of the bodies, proved by their support functions.

The slab between two bodies across any normal is no wider than they are apart, and two points of theirs are no nearer:
where the slab across the contact's normal is as wide as its gap, the gap is right.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from bodies import Box, Capsule, Cone, ConvexHull, Cylinder, Disc
from nonsmooth.engine.kernel import PLAIN
from tests.bodies.carriers import Rig
from tests.bodies.polytopes import random_hull

AXIS = {"axis_x": 0.48, "axis_y": -0.6, "axis_z": 0.64}
HULL = random_hull(np.random.default_rng(4), 9, 8e-3)
ROUND = {
    "cylinder": Cylinder(6e-3, 8e-3, x=1e-3, **AXIS),
    "flat cylinder": Cylinder(9e-3, 2e-3, x=1e-3, **AXIS),
    "cone": Cone(7e-3, 1.2e-2, x=1e-3, **AXIS),
    "flat cone": Cone(9e-3, 4e-3, x=1e-3, **AXIS),
    "disc": Disc(8e-3, x=1e-3, **AXIS),
}
SWEPT = {
    "rounded box": Box(8e-3, 5e-3, 4e-3, rounding=1e-3),
    "rounded hull": ConvexHull(HULL.points, rounding=2e-3),
    "capsule": Capsule(2e-3, 7e-3),
}
PAIRS: dict[str, tuple[Any, Any]] = {f"{one}-{two}": (ROUND[one], SWEPT[two]) for one in ROUND for two in SWEPT}


def _slab(shapes: Any, poses: Any, n: Any) -> float:
    (p, a), (q, b) = [(place, Rotation.from_quat(np.roll(turn, -1))) for place, turn in poses]
    own = p + a.apply(shapes[0].support(a.inv().apply(n)))
    other = q + b.apply(shapes[1].support(b.inv().apply(-n)))
    return float(n @ (other - own))


@pytest.mark.parametrize("name", PAIRS)
def test_the_least_gap_is_that_of_the_bodies(build: Any, name: str) -> None:
    """Anywhere apart, from far to all but touching."""
    shapes, rng = PAIRS[name], np.random.default_rng(5)
    rig = Rig(shapes, build.laws())
    for i in range(20 if PLAIN else 150):
        way = rng.normal(size=3)
        turns = [np.roll(q, 1) for q in Rotation.random(2, random_state=rng).as_quat()]
        poses = [(np.zeros(3), turns[0]), (0.04 * way / np.linalg.norm(way), turns[1])]
        for gap in (None, 1e-3, 1e-6, 1e-9):
            rig.put(poses, np.zeros(12))
            blocks = rig.geometry
            block = blocks[np.argmin(np.where(blocks[:, 30] <= 0.0, blocks[:, 0], np.inf))]
            assert block[0] == pytest.approx(_slab(shapes, poses, block[1:4]), abs=1e-14), (i, gap)
            assert np.min(blocks[:, 0]) > 0.0
            if gap is not None:
                # moved along the normal they keep their nearest points
                poses = [poses[0], (poses[1][0] + (gap - block[0]) * block[1:4], turns[1])]
