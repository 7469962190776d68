"""Contacts of rounded polyhedra and capsules: against poses made from their nearest points, and at transitions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from bodies import Capsule
from nonsmooth.engine.native.kernel import PLAIN
from tests.bodies.carriers import Rig
from tests.bodies.swept_poses import KINDS, Posed, random_shapes

GAPS = (1e-1, 1e-3, 1e-5, 1e-7, 1e-9, 0.0, -1e-9, -1e-7, -1e-5, -1e-4)
CASES = [
    (name, kind)
    for name, shapes in random_shapes(np.random.default_rng(7)).items()
    for kind in KINDS
    if not any(isinstance(s, Capsule) and kind.split("-")[i] == "face" for i, s in enumerate(shapes))
]


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize(("name", "kind"), CASES)
def test_gap_normal_and_witness_of_constructed_poses(build: Any, name: str, kind: str) -> None:
    """The contact of the nearest features has the gap, normal and witness points they were made with.

    None other is nearer, and none is as near: nothing is counted twice.
    """
    rng = np.random.default_rng(7)
    shapes = random_shapes(rng)[name]
    rig = Rig(shapes, build.laws())
    for gap in GAPS[::3] if PLAIN else GAPS:
        for _ in range(1 if PLAIN else 20):
            posed = Posed(rng, shapes, kind, gap)
            rig.put(posed.poses, np.zeros(12))
            block = rig.geometry[posed.number]
            assert block[30] < 0.0
            assert block[0] == pytest.approx(gap, abs=1e-15)
            np.testing.assert_allclose(block[1:4], posed.normal, rtol=0, atol=1e-11)
            np.testing.assert_allclose(block[7:10], posed.witness[0], rtol=0, atol=1e-13)
            np.testing.assert_allclose(block[10:13], posed.witness[1], rtol=0, atol=1e-13)
            others = np.delete(rig.geometry, posed.number, axis=0)
            past = others[:, 30] > 0.0
            assert np.min(others[~past, 0], initial=np.inf) > gap + 1e-9
            assert np.min(others[past, 0], initial=np.inf) > 1e-10


_STEP, _ROUND = 2.5e-4, 2e-3
_WEIGHTS = {1: 3.0 / 4.0, 2: -3.0 / 20.0, 3: 1.0 / 60.0}
"""Central differences of sixth order, in shorter steps where the radii are below the second number [m]."""


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize(("name", "kind"), CASES)
def test_rates_are_derivatives(build: Any, name: str, kind: str) -> None:
    """Gap rate against differences of the gap to 1e-8, second-order term against those of the rate to 1e-6."""
    rng = np.random.default_rng(8)
    shapes = random_shapes(rng)[name]
    rig = Rig(shapes, build.laws())
    step = _STEP * min(1.0, (shapes[0].sweep + shapes[1].sweep) / _ROUND)
    for gap in (1e-3, 1e-9) if PLAIN else (1e-3, 1e-5, 1e-9):
        for _ in range(1 if PLAIN else 5):
            posed = Posed(rng, shapes, kind, gap)
            u = np.concatenate([rng.normal(size=3) * scale for scale in (0.05, 1.0, 0.05, 1.0)])

            def at(t: float, posed: Posed = posed, u: Any = u) -> tuple[float, float]:
                poses = []
                for i, (place, q) in enumerate(posed.poses):
                    v, spin = u[6 * i : 6 * i + 3], u[6 * i + 3 : 6 * i + 6]
                    turn = Rotation.from_quat(np.roll(q, -1)) * Rotation.from_rotvec(t * spin)
                    poses.append((place + t * v, np.roll(turn.as_quat(), 1)))
                rig.put(poses, u)
                assert rig.geometry[posed.number, 30] < 0.0
                return rig.geometry[posed.number, 0], rig.rate[posed.number, 0]

            near = {i: np.subtract(at(i * step), at(-i * step)) / step for i in _WEIGHTS}
            rate, second = np.sum([weight * near[i] for i, weight in _WEIGHTS.items()], axis=0)
            at(0.0)
            assert rig.rate[posed.number, 0] == pytest.approx(rate, rel=1e-8, abs=1e-10)
            assert rig.bias[posed.number, 0] == pytest.approx(second, rel=1e-6, abs=1e-7)


_CLOSE = 1e-11
"""Gap at which bodies are moved past each other [m]."""


def _segments(one: Any, two: Any) -> float:
    """Return the distance of two segments, by the ends against the other and the crossing of the lines."""
    (p, a), (q, b) = ((x[0], x[1] - x[0]) for x in (one, two))

    def to_segment(x: Any, start: Any, way: Any) -> float:
        s = np.clip((x - start) @ way / (way @ way), 0.0, 1.0)
        return float(np.linalg.norm(x - start - s * way))

    found = min(*(to_segment(x, q, b) for x in one), *(to_segment(x, p, a) for x in two))
    across = np.cross(a, b)
    if across @ across > 0.0:
        s, t = (np.cross(q - p, way) @ across / (across @ across) for way in (b, a))
        if 0.0 <= s <= 1.0 and 0.0 <= t <= 1.0:
            found = min(found, abs(float((q - p) @ across)) / float(np.linalg.norm(across)))
    return found


def _distance(shapes: Any, poses: Any) -> float:
    """Return the distance of two cores that are apart: over all edges, and vertices over the insides of faces."""
    cores = [shape.core for shape in shapes]
    turns = [Rotation.from_quat(np.roll(q, -1)) for _, q in poses]
    points = [turn.apply(core.vertices) + place for turn, core, (place, _) in zip(turns, cores, poses, strict=True)]
    edges = [[points[i][list(edge[:2])] for edge in core.edges] for i, core in enumerate(cores)]
    found = min(_segments(one, two) for one in edges[0] for two in edges[1])
    for i in (0, 1):
        if not cores[i].faces:
            continue
        planes = np.array(cores[i].planes)
        for x in turns[i].inv().apply(points[1 - i] - poses[i][0]):
            for n in planes:
                height = float(n[:3] @ x - n[3])
                if height > 0.0 and np.max(planes[:, :3] @ (x - height * n[:3]) - planes[:, 3]) <= 1e-15:
                    found = min(found, height)
    return found


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="a minute in plain mode")
@pytest.mark.parametrize("name", dict.fromkeys(name for name, _ in CASES))
def test_features_hand_over_without_a_hole_and_without_a_double(build: Any, name: str) -> None:
    """Past each other, all but touching: at every place exactly one contact has the distance of the bodies.

    Where it changes, which is looked at to 1e-12 of the way, the gap and its normal do not jump.
    """
    rng = np.random.default_rng(9)
    shapes = random_shapes(rng)[name]
    rig = Rig(shapes, build.laws())
    radii = shapes[0].sweep + shapes[1].sweep
    changes = 0
    for _ in range(6):
        start = rng.normal(size=3)
        start *= 1.0 / np.linalg.norm(start)
        turns, spin = Rotation.random(2, random_state=rng), rng.normal(size=3)
        way = np.cross(start, rng.normal(size=3))

        def put(
            t: float, start: Any = start, turns: Any = turns, spin: Any = spin, way: Any = way
        ) -> tuple[int, Any, Any]:
            turned = Rotation.from_rotvec(t * spin) * turns[1]
            poses = [
                (np.zeros(3), np.roll(turns[0].as_quat(), 1)),
                (0.035 * start + 0.01 * t * way, np.roll(turned.as_quat(), 1)),
            ]
            for _ in range(2):
                rig.put(poses, np.zeros(12))
                facing = rig.geometry[:, 30] <= 0.0
                nearest = int(np.argmin(np.where(facing, rig.geometry[:, 0], np.inf)))
                block = rig.geometry[nearest]
                # moved along the normal the bodies keep their nearest points
                shifted = poses[1][0] + (_CLOSE - block[0]) * block[1:4]
                before, poses = poses, [poses[0], (shifted, poses[1][1])]
            return nearest, rig.geometry, before

        before, times = -1, np.linspace(-1.0, 1.0, 40)
        for i, t in enumerate(times):
            nearest, blocks, poses = put(t)
            gap = blocks[nearest, 0]
            if i % 8 == 0:
                assert gap == pytest.approx(_distance(shapes, poses) - radii, abs=1e-14)
            assert np.min(np.delete(blocks[:, 0], nearest)) > gap + 1e-11
            if before not in (-1, nearest):
                changes += 1
                low, high = times[i - 1], t
                while high - low > 1e-12:
                    middle = 0.5 * (low + high)
                    low, high = (middle, high) if put(middle)[0] == before else (low, middle)
                one, two = put(low)[1][before], put(high)
                assert two[1][two[0], 0] == pytest.approx(one[0], abs=1e-12)
                # the edge gives its contact to the vertex a little before its end, and the normals differ by that
                np.testing.assert_allclose(two[1][two[0], 1:4], one[1:4], rtol=0, atol=1e-5)
            before = nearest
    assert changes > 5
