"""A crossing of an edge nearly along the side of a cylinder, past its end: it runs faster than the bodies do."""

from __future__ import annotations

import numpy as np
import pytest

from bodies import Capsule, Cylinder
from laws import EnergeticImpact, Frictionless, Unilateral
from tests.bodies.carriers import Rig

RADIUS, CAPSULE, HALF, GAP = 1e-2, 5e-3, 1e-2, 1e-4
UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])


@pytest.mark.parametrize("angle", [0.02, 0.05, 0.3])
def test_gaps_past_ends_close_no_faster_than_bodies_move(angle: float) -> None:
    """Where features do not face each other, how soon they are looked at again goes by that."""
    laws = {"normal": Unilateral(), "friction": Frictionless(), "impact": EnergeticImpact(0.5)}
    rig = Rig((Cylinder(RADIUS, HALF), Capsule(CAPSULE, HALF)), laws)
    turned = np.array([np.cos(0.5 * angle), -np.sin(0.5 * angle), 0.0, 0.0])
    ways = np.linspace(0.9 * RADIUS, 0.0, 200)
    gaps, past = [], []
    for way in ways:
        aside = np.array([RADIUS + CAPSULE + GAP, way, 0.0])
        rig.put(((np.zeros(3), UPRIGHT), (aside, turned)), np.zeros(12))
        gaps.append(rig.geometry[:, 0])
        past.append(rig.geometry[:, 30])
    are_past = np.minimum(past[1:], past[:-1]) > 0.0
    assert np.sum(are_past) > 100
    closing = np.abs(np.diff(gaps, axis=0))[are_past]
    assert np.max(closing) <= (1.0 + 1e-9) * abs(ways[1] - ways[0])
