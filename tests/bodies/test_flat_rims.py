"""The lowest point of a rim that lies nearly flat moves round the rim while the bodies hardly move."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from bodies import Box, Cylinder
from bodies.contacts.frustum.frustum_frustum import evaluate_rim_over_cap
from bodies.contacts.frustum.frustum_surface import RIM
from nonsmooth.interfaces import FeaturePair
from tests.bodies.carriers import Rig
from tests.bodies.every_pair import pairs_of

RADIUS = 0.02
"""Radius of the rim [m]."""
FOOT = 2e-6
"""Height of feet [m]."""
UNDER: dict[str, Any] = {
    "cylinder": (Cylinder(0.03, 0.01, foot_height=FOOT), 0.01 - FOOT),
    "box": (Box(0.03, 0.03, 0.01), 0.01),
}
"""What the rim lies on: shape, and height of its face where rims touch it [m]."""
MOST = 2.0
"""Largest rate of a gap past the border of the face, relative to the largest speed of a point of the bodies."""


def _is_of_rim(pair: FeaturePair) -> bool:
    """True if a contact is that of a rim of the first body and a flat face."""
    if pair.evaluator is evaluate_rim_over_cap:
        rim = pair.values["rim"]
        return isinstance(rim, tuple) and rim[0] == RADIUS and pair.values["swap"] == 0.0
    candidate = pair.values.get("candidate", (0.0,))
    return isinstance(candidate, tuple) and candidate[0] == RIM


@pytest.mark.parametrize("name", UNDER)
@pytest.mark.parametrize("seed", range(3))
def test_no_rim_comes_over_a_border_before_the_bodies_have_moved_by_its_gap(build: Any, name: str, seed: int) -> None:
    """The engine relies on it: a contact past its border, whose gap is larger than any motion, is not evaluated."""
    rng = np.random.default_rng(seed)
    under, height = UNDER[name]
    shape = Cylinder(RADIUS, RADIUS, foot_height=FOOT)
    rig = Rig((shape, under), build.laws())
    rims = [i for i, pair in enumerate(pairs_of(shape, under)) if _is_of_rim(pair)]
    n_begun = 0
    for _ in range(300):
        # the whole rim is above the face
        sine, around = 10.0 ** rng.uniform(-5.5, -3.0), rng.uniform(0.0, 6.3)
        axis = np.array([np.cos(around), np.sin(around), 0.0])
        place = np.array([*rng.uniform(-0.04, 0.04, 2), height + RADIUS - FOOT + RADIUS * sine * rng.uniform(1.0, 2.0)])
        turning, shift = sine * rng.uniform(-1.0, 1.0, 2), RADIUS * sine * rng.uniform(-1.0, 1.0, 3)
        blocks = []
        for part in (0.0, 1.0):
            turned = Rotation.from_rotvec([*(sine * axis[:2] + part * turning), 0.0])
            pose = place + part * shift, np.roll(turned.as_quat(), 1)
            rig.put([pose, (np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]))], np.zeros(12))
            blocks.append(rig.geometry[rims])
        before, after = blocks
        moved = np.linalg.norm(shift) + np.hypot(RADIUS, RADIUS) * np.linalg.norm(turning)
        begun = (before[:, 30] > 0.0) & (after[:, 30] <= 0.0)
        n_begun += int(np.count_nonzero(begun))
        # the gap holds the distance past the border
        assert np.all(before[begun, 0] - np.maximum(after[begun, 0], 0.0) <= MOST * moved)
    assert n_begun > 20
