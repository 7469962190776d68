"""Smooth bodies that overlap, and a frustum under its cap: no direction is a shorter way out than the answer."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from bodies import Box, Cone, Cylinder, Disc, Ellipsoid, Superellipsoid
from bodies.contacts.smooth.inscribed import is_least_overlap as _is_least_overlap
from bodies.contacts.smooth.smooth_core import Cores as _Cores
from bodies.contacts.smooth.smooth_newton import largest_gap
from bodies.contacts.smooth.smooth_starts import gap_along, local_maximum, starts_of
from bodies.shapes.frustum import CENTER
from bodies.shapes.support_function import support_of as _support_of
from nonsmooth.engine.memory.blocks import GAP
from nonsmooth.engine.native.kernel import PLAIN
from tests.bodies.carriers import Rig

# called with arrays in place of tuples
Cores: Any = _Cores
is_least_overlap: Any = _is_least_overlap
support_of: Any = _support_of

Array = NDArray[np.float64]
SAME = 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0
EXPONENTS: dict[str, tuple[tuple[float, float], tuple[float, float]]] = {
    "ellipsoid": ((1.0, 1.0), (1.0, 1.0)),
    "round": ((1.05, 1.6), (1.05, 1.6)),
    "boxy": ((0.2, 0.9), (0.2, 0.9)),
    "flat along": ((0.2, 0.9), (1.1, 1.6)),
    "flat across": ((1.1, 1.6), (0.2, 0.9)),
}


def _core(rng: np.random.Generator, kind: str, low: float = 0.004) -> Any:
    exponents = [float(rng.uniform(*bounds)) for bounds in EXPONENTS[kind]]
    return np.array(Superellipsoid(*rng.uniform(low, 0.01, 3).tolist(), *exponents).core)


def _directions(rng: np.random.Generator, count: int) -> Array:
    n = rng.normal(size=(count, 3))
    # next to flat and sharp places as well
    n[::2] *= 10.0 ** rng.uniform(-6.0, 0.0, (len(n[::2]), 3))
    return np.asarray(n / np.linalg.norm(n, axis=1)[:, None])


def _heights(core: Array, n: Array) -> Array:
    """Return the support function along rows of unit vectors, by its definition."""
    a, b, c, p, q = core[:5]
    r = ((a * np.abs(n[:, 0])) ** q + (b * np.abs(n[:, 1])) ** q) ** (1.0 / q)
    return np.asarray((r**p + (c * np.abs(n[:, 2])) ** p) ** (1.0 / p))


def _pose(rng: np.random.Generator, kinds: Any, gap: float) -> tuple[Array, Array, Array, Array, Array]:
    """Return two cores, rotation and centre of the second, and a normal along which their gap is stationary."""
    one, two = _core(rng, kinds[0]), _core(rng, kinds[1])
    turn, n = Rotation.random(random_state=rng).as_matrix(), _directions(rng, 2)[int(rng.integers(2))]
    p, q = np.array(support_of(one, n)[1]), np.array(support_of(two, (-turn.T @ n))[1])
    return one, two, turn, p + gap * n - turn @ q, n


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize("first", EXPONENTS)
@pytest.mark.parametrize("second", EXPONENTS)
def test_no_direction_is_a_shorter_way_out(first: str, second: str) -> None:
    """Overlaps up to a fifth of the bodies: of many directions and of those near the best; proofs are right."""
    rng, proofs, count = np.random.default_rng(5), 0, 2 if PLAIN else 8
    for gap in (-1e-5, -1e-4, -5e-4, -2e-3):
        for _ in range(count):
            one, two, turn, x, n = _pose(rng, (first, second), gap)
            g, _, normal = largest_gap(Cores(one, two, tuple(turn.ravel()), tuple(x)))
            assert g >= gap - 1e-12
            ways = np.vstack([_directions(rng, 2000), np.array(normal) + 0.1 * rng.normal(size=(200, 3))])
            ways /= np.linalg.norm(ways, axis=1)[:, None]
            most = np.max(ways @ x - _heights(one, ways) - _heights(two, -ways @ turn))
            assert g >= most - 1e-12
            # the pose's own answer, whether or not it is the shortest
            stationary = gap, x + turn @ np.array(support_of(two, (-turn.T @ n))[1]), n
            proved = is_least_overlap(Cores(one, two, tuple(turn.ravel()), x), stationary)
            proofs += proved
            assert not proved or most <= gap + 1e-12
    assert proofs >= count


def test_a_long_way_out_is_not_proved() -> None:
    """Through the middle of an ellipsoid along any of its axes but the shortest; half a micrometre deep it is."""
    large, small = np.array(Superellipsoid(0.03, 0.02, 0.01).core), np.array(Superellipsoid(0.003, 0.002, 0.001).core)
    for n in np.eye(3):
        reach = float(support_of(large, n)[0])
        inside = -reach - float(support_of(small, n)[0])
        assert not is_least_overlap(Cores(large, small, SAME, (0.0, 0.0, 0.0)), (inside, -(reach + inside) * n, n))
        deep = -5e-7
        x = -(inside - deep) * n
        assert is_least_overlap(Cores(large, small, SAME, x), (deep, (reach + deep) * n, n))


def test_tips_against_tips() -> None:
    """Poses of known gaps at which Newton's method fails from everywhere but right next to the top."""
    for gap, sizes, exponents, others, powers, turned, way in (
        (
            1e-7,
            (0.0075241, 0.0097565, 0.0097698),
            (1.6631, 1.5859),
            (0.0091397, 0.0070767, 0.0078155),
            (1.7919, 0.22574),
            (0.7158, 0.065808, -0.19123, 0.66838),
            (0.019094, 0.99506, 0.097384),
        ),
        (
            1e-9,
            (0.0044563, 0.0099504, 0.0053246),
            (1.7576, 0.25982),
            (0.0078857, 0.0042377, 0.0053751),
            (0.64967, 1.7402),
            (0.32081, 0.90874, 0.071378, -0.25725),
            (0.22701, 3.0605e-05, -0.97389),
        ),
    ):
        one, two = (np.array(Superellipsoid(*s, *e).core) for s, e in ((sizes, exponents), (others, powers)))
        turn, n = Rotation.from_quat(turned).as_matrix(), np.array(way) / np.linalg.norm(way)
        p, q = np.array(support_of(one, n)[1]), np.array(support_of(two, (-turn.T @ n))[1])
        g, _, normal = largest_gap(Cores(one, two, tuple(turn.ravel()), tuple(p + gap * n - turn @ q)))
        assert abs(g - gap) <= 1e-12
        np.testing.assert_allclose(normal, n, rtol=0, atol=1e-9)


def test_a_local_maximum_is_larger_than_its_start() -> None:
    """From every start, and none nearby is larger at the end; the starts are apart from each other."""
    rng = np.random.default_rng(6)
    for kinds in (("boxy", "round"), ("flat along", "flat across")):
        one, two, turn, x, _ = _pose(rng, kinds, -1e-3)
        given = Cores(one, two, tuple(turn.ravel()), tuple(x))
        starts = starts_of(given)
        ways = np.array([way for _, way in starts])
        assert np.max(ways @ ways.T - np.eye(4)) <= 0.95
        for start in starts:
            assert gap_along(given, start[1]) == pytest.approx(start[0], abs=1e-15)
            top = local_maximum(given, start, 1e-4)
            assert top[0] >= start[0]
            nearby = np.array(top[1]) + 1e-4 * rng.normal(size=(20, 3))
            nearby /= np.linalg.norm(nearby, axis=1)[:, None]
            assert max(gap_along(given, n) for n in nearby) <= top[0] + 1e-6


@pytest.mark.fast_cases(6)
@pytest.mark.parametrize("kind", EXPONENTS)
@pytest.mark.parametrize(
    "frustum", [Cylinder(0.006, 0.005), Cone(0.007, 0.01), Disc(0.008)], ids=lambda f: type(f).__name__
)
def test_no_direction_is_a_shorter_way_out_of_a_frustum(build: Any, frustum: Any, kind: str) -> None:
    """Of bodies that are apart, touch or overlap by up to half of their thickness; coaxial ones are among them."""
    rng, numbers = np.random.default_rng(8), np.array(frustum.frustum)
    ends = ((numbers[0], numbers[2]), (numbers[1], numbers[3]))
    for trial in range(8 if PLAIN else 60):
        core = _core(rng, kind, 0.002)
        shape = Superellipsoid(*core[:3].tolist(), *(2.0 - 2.0 / core[3:5]).tolist())
        rotation = Rotation.random(random_state=rng) if trial % 4 else Rotation.identity()
        x = rng.uniform(-0.01, 0.01, 3) * (rng.uniform(size=3) < (1.0 if trial % 4 else 0.4))
        rig, turn, center = Rig((frustum, shape), build.laws()), rotation.as_matrix(), numbers[CENTER : CENTER + 3]
        poses = [(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])), (x + center, np.roll(rotation.as_quat(), 1))]
        rig.put(poses, np.zeros(12))
        block = rig.geometry[0]
        if block[0] < -0.5 * np.min(core[:3]):
            continue
        ways = np.vstack([_directions(rng, 2000), np.array(block[1:4]) + 0.1 * rng.normal(size=(200, 3))])
        ways /= np.linalg.norm(ways, axis=1)[:, None]
        radial = np.hypot(ways[:, 0], ways[:, 1])
        height = np.max([r * radial + h * ways[:, 2] for r, h in ends], axis=0)
        assert np.max(ways @ x - height - _heights(core, -ways @ turn)) <= block[0] + 1e-12


def test_an_ellipsoid_deep_in_a_box_leaves_by_the_shortest_way(build: Any) -> None:
    """Of directions between any two faces, over the edge that they share, none separates the bodies sooner."""
    halves, rng = np.array([0.01, 0.008, 0.006]), np.random.default_rng(1)
    rig = Rig((Box(*halves), Ellipsoid(*halves)), build.laws())
    angles, axes = np.linspace(0.0, 2.0 * np.pi, 72, endpoint=False)[:, None], np.eye(3)
    ways = np.vstack([np.cos(angles) * axes[i] + np.sin(angles) * axes[i - 1] for i in range(3)])
    for _ in range(150):
        turn, x = Rotation.random(random_state=rng), rng.uniform(-1.0, 1.0, 3) * halves
        rig.put([(np.zeros(3), [1.0, 0.0, 0.0, 0.0]), (x, np.roll(turn.as_quat(), 1))], np.zeros(12))
        apart = ways @ x - np.abs(ways) @ halves - np.linalg.norm(ways @ turn.as_matrix() * halves, axis=1)
        assert rig.geometry[0, GAP] >= np.max(apart) - 1e-12
