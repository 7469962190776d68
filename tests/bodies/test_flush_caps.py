"""Cylinders that overlap slightly with caps that are almost parallel: a contact faces, however small the angle is."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from bodies import Cylinder
from nonsmooth.interfaces.body import Vector
from tests.bodies.carriers import Rig

SLIM = 0.1
"""Half-length of the cylinders relative to their radius."""


def _reach(center: Vector, axis: Vector, radius: float, n: Vector) -> float:
    """Return how far a cylinder reaches along the unit vector n [m]."""
    sine = np.linalg.norm(np.cross(axis, n))
    return float(center @ n + radius * (SLIM * abs(axis @ n) + sine))


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize("radius", [1e-3, 0.02, 1.0])
@pytest.mark.parametrize("seed", range(4))
def test_a_contact_of_flush_caps_faces_at_any_angle(build: Any, radius: float, seed: int) -> None:
    """The caps are tilted by 1e-9 to 1e-6 rad and shifted; along the better of both normals they overlap slightly."""
    rng = np.random.default_rng(seed)
    shape = Cylinder(radius, SLIM * radius, foot_height=0.0)
    rig = Rig((shape, shape), build.laws())
    for _ in range(100):
        turn, (a, b) = Rotation.random(random_state=rng), rng.uniform(0.0, 6.3, 2)
        tilt = 10.0 ** rng.uniform(-9.0, -6.0) * np.array([np.cos(a), np.sin(a), 0.0])
        tilted = turn * Rotation.from_rotvec(tilt)
        axes = turn.apply([0.0, 0.0, 1.0]), tilted.apply([0.0, 0.0, 1.0])
        shift = turn.apply(rng.uniform(0.0, 0.5) * radius * np.array([np.cos(b), np.sin(b), 0.0]))
        depth, height = radius * 10.0 ** rng.uniform(-7.3, -5.8), 2.0 * SLIM * radius
        for _ in range(30):
            place = shift + height * axes[0]
            gaps = [
                -_reach(np.zeros(3), axes[0], radius, n) - _reach(place, axes[1], radius, -np.asarray(n)) for n in axes
            ]
            height -= max(gaps) + depth
        poses = [(np.zeros(3), np.roll(turn.as_quat(), 1)), (place, np.roll(tilted.as_quat(), 1))]
        rig.put(poses, np.zeros(12))
        facing = rig.geometry[rig.geometry[:, 30] <= 0.0, 0]
        assert np.min(facing, initial=np.inf) <= -0.3 * depth
