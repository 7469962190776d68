"""Bodies that springs let into each other by a hundredth of their size: some contact of theirs holds them apart.

An edge that crosses another one, or a rim, next to its end is a contact even where it is deeper than a quarter of the
way to there, as long as a point of it is inside of the other body: else nothing keeps the bodies from passing.
"""

from __future__ import annotations

import numpy as np
import pytest

from bodies import BoxBody, ConeBody, CylinderBody, HullBody
from laws import Frictionless, LinearCompliant
from nonsmooth.engine.memory.blocks import GAP, PAST_END
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.interfaces import Body
from tests.benchmarks.random_systems.gaps import distance
from tests.benchmarks.random_systems.pieces import rotations
from tests.bodies.carriers import Rig

CORNERS = ((0.0, 0.0, 0.01), (0.01, 0.0, -0.005), (-0.006, 0.008, -0.004), (-0.005, -0.009, -0.003))
BODIES: dict[str, Body] = {
    "box": BoxBody(0.01, 0.008, 0.006),
    "cone": ConeBody(0.01, 0.02, foot_height=0.0),
    "cylinder": CylinderBody(0.01, 0.008, foot_height=0.0),
    "hull": HullBody(CORNERS),
}
DEPTH = 1e-4


def _touching(one: Body, two: Body, axes: np.ndarray, off: np.ndarray, way: np.ndarray) -> float:
    """Return how far along a way from an offset the second body is to be for the two to touch [m]."""
    low, high = 0.0, 0.1
    while high - low > 1e-9:
        middle = 0.5 * (low + high)
        poses = (np.zeros((1, 3)), axes[:1]), ((off + middle * way)[None], axes[1:])
        if distance(one, two, poses) > 0.0:
            high = middle
        else:
            low = middle
    return low


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="a minute in plain mode")
@pytest.mark.parametrize(
    "names",
    [
        ("box", "box"),
        ("cylinder", "box"),
        ("hull", "box"),
        ("cylinder", "hull"),
        ("cylinder", "cylinder"),
        ("cylinder", "cone"),
    ],
)
def test_some_contact_tells_of_a_shallow_overlap(names: tuple[str, str]) -> None:
    """Of 300 poses every one has a contact whose features face each other, with a negative gap."""
    one, two = (BODIES[name] for name in names)
    rig = Rig(
        (one.frames[0][0], two.frames[0][0]),
        {"normal": LinearCompliant(1e4), "friction": Frictionless(), "impact": None},
    )
    rng = np.random.default_rng(1)
    for number in range(300):
        turns = rng.normal(size=(2, 4))
        turns /= np.linalg.norm(turns, axis=1)[:, None]
        way, off = rng.normal(size=3), rng.uniform(-0.006, 0.006, 3)
        way /= np.linalg.norm(way)
        place = _touching(one, two, rotations(turns), off, way) - DEPTH
        rig.put(((np.zeros(3), turns[0]), (off + place * way, turns[1])), np.zeros(12))
        faces = rig.geometry[:, PAST_END] <= 0.0
        assert np.any(faces & (rig.geometry[:, GAP] < 0.0)), number
