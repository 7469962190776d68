"""Contacts of polyhedra: against poses made from their nearest points, and what a manifold must be."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from nonsmooth.engine.native.kernel import PLAIN
from tests.bodies.carriers import Rig
from tests.bodies.polytopes import Posed, random_shapes

NAMES = tuple(random_shapes(np.random.default_rng(7)))
GAPS = (1e-1, 1e-3, 1e-5, 1e-7, 1e-9, 0.0, -1e-9, -1e-7, -1e-5, -1e-4)
_POSES, _MOTIONS = (2, 1) if PLAIN else (20, 5)
"""Of each gap; in plain mode a query takes hundreds of times as long."""
KINDS = ("edge-edge", "face-vertex", "vertex-face")


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", NAMES)
def test_gap_normal_and_witness_of_constructed_poses(build: Any, name: str, kind: str) -> None:
    """The contact of the nearest features has the gap, normal and witness points they were made with.

    None other that faces its partner is nearer, and those that do not are open.
    """
    rng = np.random.default_rng(7)
    shapes = random_shapes(rng)[name]
    rig = Rig(shapes, build.laws())
    # a knife has no depth to speak of
    for gap in GAPS[:-3] if name == "slivers" else GAPS:
        for _ in range(_POSES):
            posed = Posed(rng, shapes, kind, gap)
            rig.put(posed.poses, np.zeros(12))
            block = rig.geometry[posed.number]
            assert block[30] < 0.0
            assert block[0] == pytest.approx(gap, abs=1e-15)
            np.testing.assert_allclose(block[1:4], posed.normal, rtol=0, atol=1e-12)
            np.testing.assert_allclose(block[7:10], posed.witness[0], rtol=0, atol=1e-14)
            np.testing.assert_allclose(block[10:13], posed.witness[1], rtol=0, atol=1e-14)
            if gap >= 0.0:
                others, past = rig.geometry[:, 0], rig.geometry[:, 30] > 0.0
                assert np.min(others[~past]) >= gap - 1e-15
                assert np.min(others[past]) > 1e-10


_STEP = 2.5e-4
_WEIGHTS = {1: 3.0 / 4.0, 2: -3.0 / 20.0, 3: 1.0 / 60.0}
"""Central differences of sixth order."""


@pytest.mark.fast_cases(6)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", NAMES)
def test_rates_are_derivatives(build: Any, name: str, kind: str) -> None:
    """Gap rate against differences of the gap to 1e-8, second-order term against those of the rate to 1e-6."""
    rng = np.random.default_rng(8)
    shapes = random_shapes(rng)[name]
    rig, compared = Rig(shapes, build.laws()), 0
    for gap in (1e-3, 1e-5, 1e-9):
        for _ in range(_MOTIONS):
            posed, past = Posed(rng, shapes, kind, gap), list[float]()
            u = np.concatenate([rng.normal(size=3) * scale for scale in (0.05, 3.0, 0.05, 3.0)])

            def at(t: float, posed: Posed = posed, u: Any = u, past: Any = past) -> tuple[float, float]:
                poses = []
                for i, (place, q) in enumerate(posed.poses):
                    v, spin = u[6 * i : 6 * i + 3], u[6 * i + 3 : 6 * i + 6]
                    turn = Rotation.from_quat(np.roll(q, -1)) * Rotation.from_rotvec(t * spin)
                    poses.append((place + t * v, np.roll(turn.as_quat(), 1)))
                rig.put(poses, u)
                past.append(rig.geometry[posed.number, 30])
                return rig.geometry[posed.number, 0], rig.rate[posed.number, 0]

            near = {i: np.subtract(at(i * _STEP), at(-i * _STEP)) / _STEP for i in _WEIGHTS}
            rate, second = np.sum([weight * near[i] for i, weight in _WEIGHTS.items()], axis=0)
            at(0.0)
            assert past[-1] < 0.0
            if max(past) > 0.0:
                # the vertex comes over the border of the face on the way
                continue
            compared += 1
            assert rig.rate[posed.number, 0] == pytest.approx(rate, rel=1e-8, abs=1e-10)
            assert rig.bias[posed.number, 0] == pytest.approx(second, rel=1e-6, abs=1e-8)
    assert compared >= 2 * _MOTIONS
