"""Upright cylinders, cones and discs one above the other of which hardly anything covers the other."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from bodies import Cone, Cylinder
from bodies.shapes.frustum import FEET
from tests.bodies.carriers import Rig

SHAPES = {"cylinder": Cylinder(0.016, 0.014), "cone": Cone(0.01, 0.02)}


@pytest.mark.parametrize("upper", SHAPES)
@pytest.mark.parametrize("inner", [False, True])
def test_rims_cross_at_both_tips_of_a_crescent(build: Any, upper: str, inner: bool) -> None:
    """Bases that face each other: the rims cross twice, and the gap is the height of the one over the other.

    Only feet are nearer, by their height.
    """
    rng = np.random.default_rng(5)
    one, lower = SHAPES[upper], Cylinder(0.02, 0.018)
    (radius, (_, _, low)), (_, (_, _, high)) = one.standing_rims[0], lower.standing_rims[1]
    feet = one.frustum[FEET] + lower.frustum[FEET]
    rig = Rig((one, lower), build.laws())
    # of a narrower crescent the rims count as parallel, and most of the one cap lies over the other
    for width in (5e-3, 1e-3, 1e-4, 1e-5) if inner else (5e-3, 1e-3, 1e-4, 1e-5, 2e-6):
        for gap in (1e-3, 1e-6, 1e-9, 0.0, -1e-9, -1e-7):
            turn, place = Rotation.random(random_state=rng), rng.uniform(-0.1, 0.1, 3)
            # the one covers the other but for a crescent, or nothing but a lens
            off = (0.02 - radius + width) if inner else (0.02 + radius - width)
            angle = rng.uniform(0.0, 6.0)
            down = turn.apply([off * np.cos(angle), off * np.sin(angle), low - gap - high])
            spun = turn * Rotation.from_rotvec([0.0, 0.0, rng.uniform(0.0, 6.0)])
            rig.put([(place, np.roll(turn.as_quat(), 1)), (place + down, np.roll(spun.as_quat(), 1))], np.zeros(12))
            facing = rig.geometry[rig.geometry[:, 30] <= 0.0, 0]
            assert np.sum(np.abs(facing - gap) <= 1e-13) >= 2
            if gap >= 0.0:
                assert np.min(facing) >= gap - feet - 1e-13
