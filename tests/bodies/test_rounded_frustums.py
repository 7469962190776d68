"""Rounded cylinders, cones and discs, and bodies at a distance from sharp ones: sizes, volumes, contacts."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from bodies import Cone, ConeBody, Cylinder, CylinderBody, Disc, DiscBody
from nonsmooth import InvalidInput
from nonsmooth.engine.native.kernel import PLAIN
from tests.benchmarks.touches import ROUND, hull, on, rounded
from tests.bodies.carriers import Rig
from tests.bodies.rounds import PosedRound, tangent, touch_round
from tests.bodies.test_frustum_pairs import differences, pose_of

GAPS = (1e-3, -1e-4) if PLAIN else (1e-1, 1e-3, 1e-6, 0.0, -1e-7, -1e-4)
OVER = {
    "rim": ("face", "edge", "vertex"),
    "side": ("edge", "vertex"),
    "cap": ("vertex",),
    "apex": ("face", "edge", "vertex"),
}
HULLS = {"rounded": hull, "": rounded(hull)}
"""One of the two is rounded."""
KINDS = [
    (f"{kind} {name}".strip(), part, other, kind)
    for kind in HULLS
    for name, (_, parts) in ROUND.items()
    for part in parts
    for other in OVER[part]
]


def _check(rig: Rig, pose: PosedRound, rng: np.random.Generator) -> None:
    """One contact has the gap, none other is as near, and rates are derivatives."""
    rig.put(pose.poses, np.zeros(12))
    blocks = rig.geometry
    found = pose.found_in(blocks)
    # next to the line of centres both halves of rims see the same crossing
    assert 1 <= len(found) <= 2
    np.testing.assert_allclose(blocks[found[-1], 7:13], blocks[found[0], 7:13], rtol=0, atol=1e-12)
    others = np.delete(blocks, found, axis=0)
    past = others[:, 30] > 0.0
    assert np.min(others[~past, 0], initial=1.0) > pose.gap + 1e-9
    assert pose.gap < 0.0 or np.min(others[past, 0], initial=1.0) > 1e-10
    if pose.gap > 1e-2:
        return
    u = np.concatenate([rng.normal(size=3) * scale for scale in (0.02, 1.0, 0.02, 1.0)])
    rate, second_rate = differences(rig, pose, u, found[0])
    assert rig.rate[found[0], 0] == pytest.approx(rate, rel=1e-8, abs=1e-10)
    assert rig.bias[found[0], 0] == pytest.approx(second_rate, rel=1e-6, abs=1e-7)


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize(("name", "part", "other", "kind"), KINDS)
def test_polyhedra_at_constructed_poses(build: Any, name: str, part: str, other: str, kind: str) -> None:
    """Anywhere from 0.1 m apart to 0.1 mm deep."""
    rng = np.random.default_rng(14)
    for gap in GAPS:
        first, second = touch_round(rng, name, part), on(HULLS[kind], other)(rng)
        rig = Rig((first[0], second[0]), build.laws())
        _check(rig, pose_of(rng, first, part, second, other, gap), rng)


BETWEEN = [
    (one, part, two, other)
    for one in ROUND
    for two in ROUND
    for part, other in (
        ("rim", "cap"),
        ("apex", "cap"),
        ("side", "side"),
        ("rim", "side"),
        ("apex", "side"),
        ("rim", "rim"),
        ("apex", "rim"),
        ("apex", "apex"),
        ("side", "apex"),
    )
    if part in ROUND[one][1] and other in ROUND[two][1]
]


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize(("one", "part", "two", "other"), BETWEEN)
def test_round_bodies_at_constructed_poses(build: Any, one: str, part: str, two: str, other: str) -> None:
    """The first is rounded, and where both are of one kind the second, too; rims may be parallel where they touch."""
    rng = np.random.default_rng(15)
    for gap in GAPS:
        # a rounded apex touches other bodies as without feet
        is_on_feet = "apex" not in (part, other)
        first = touch_round(rng, f"rounded {one}", part, is_on_feet)
        second = touch_round(rng, two if one != two else f"rounded {two}", other, is_on_feet)
        ways = tangent(first[0], part, first[2]), tangent(second[0], other, second[2])
        pose = PosedRound(rng, first, second, ways if part == other == "side" else (None, None), gap)
        _check(Rig((first[0], second[0]), build.laws()), pose, rng)


def test_parallel_rims_touch_at_a_point(build: Any) -> None:
    """Two coins on a table, edge to edge, are the thickness apart of which their rims are round."""
    rig = Rig((Disc(0.02, rounding=0.002), Disc(0.03, rounding=0.001)), build.laws())
    rig.put([(np.zeros(3), [1.0, 0.0, 0.0, 0.0]), (np.array([0.06, 0.0, 0.0]), [1.0, 0.0, 0.0, 0.0])], np.zeros(12))
    blocks = rig.geometry
    block = blocks[np.argmin(np.where(blocks[:, 30] <= 0.0, blocks[:, 0], np.inf))]
    np.testing.assert_allclose(block[:4], [0.01, 1.0, 0.0, 0.0], rtol=0, atol=1e-15)
    np.testing.assert_allclose(block[7:13], [0.02, 0.0, 0.0, 0.03, 0.0, 0.0], rtol=0, atol=1e-15)


def _steiner(volume: float, surface: float, curvature: float, r: float) -> float:
    """Return the volume at a distance r round a convex body, by J. Steiner's formula."""
    return volume + surface * r + curvature * r**2 + 4.0 / 3.0 * math.pi * r**3


def test_volumes_are_those_of_steiner() -> None:
    """With the integral of the mean curvature of cylinder, cone and disc."""
    r, p, h = 0.02, 0.1, 0.3
    cylinder = Cylinder(p + r, 0.5 * h + r, rounding=r)
    surface = 2.0 * math.pi * p * (p + h)
    expected = _steiner(math.pi * p**2 * h, surface, math.pi * (h + math.pi * p), r)
    assert cylinder.volume == pytest.approx(expected, rel=1e-14)
    disc = Disc(p + r, rounding=r)
    assert disc.volume == pytest.approx(_steiner(0.0, 2.0 * math.pi * p**2, math.pi**2 * p, r), rel=1e-14)
    cone = Cone(0.2, 0.3, rounding=r)
    p, h = cone.core_sizes
    slant = math.hypot(p, h)
    curvature = math.pi * (h + p * (math.pi - math.atan2(h, p)))
    expected = _steiner(math.pi * p**2 * h / 3.0, math.pi * p * (p + slant), curvature, r)
    assert cone.volume == pytest.approx(expected, rel=1e-14)


def test_they_are_as_large_as_sharp_ones() -> None:
    """A cylinder in all directions along and across, a cone by its base and the plane of its side."""
    np.testing.assert_allclose(Cylinder(0.1, 0.2, rounding=0.05).bounds, Cylinder(0.1, 0.2).bounds, rtol=0, atol=1e-15)
    pointed, cone = Cone(0.1, 0.2), Cone(0.1, 0.2, rounding=0.02)
    for direction in (np.array([0.2, 0.0, 0.1]), np.array([0.0, 0.0, -1.0])):
        assert cone.support(direction) @ direction == pytest.approx(pointed.support(direction) @ direction, rel=1e-14)
    assert cone.support(np.array([0.0, 0.0, 1.0]))[2] < 0.2 - 0.02
    low, high = Disc(0.1, rounding=0.01).bounds
    np.testing.assert_allclose([low, high], [[-0.1, -0.1, -0.01], [0.1, 0.1, 0.01]], rtol=0, atol=1e-15)


def test_almost_a_ball() -> None:
    """As the core shrinks, volume and inertia are those of the ball within, and the mass centre is in its middle."""
    for body, radius in (
        (CylinderBody(0.1, 0.1, rounding=0.1 - 2e-6), 0.1),
        (ConeBody(0.3, 0.4, rounding=0.15 - 8e-6), 0.15),
        (DiscBody(0.1, rounding=0.1 - 2e-6), 0.1),
    ):
        moment = 0.4 * body.total_mass * radius**2
        np.testing.assert_allclose(body.inertia, [moment, moment, moment], rtol=1e-4)
        (shape,) = body.shapes
        assert np.max(np.abs(shape.centroid)) < 1e-15  # type: ignore[attr-defined]
        assert shape.length == pytest.approx(radius, rel=1e-3)


def test_feet_stand_in_the_plane_of_the_whole() -> None:
    """They are round tips about the feet of the core, two thirds of its radius from the axis."""
    for shape, faces in ((Cylinder(0.1, 0.2, foot_height=1e-3, rounding=0.02), (-0.2, 0.2)), (Cone(0.1, 0.2), (0.0,))):
        feet = np.array(replace(shape, foot_height=1e-3, rounding=0.02).feet)
        heights = feet[:, 2] + np.sign(feet[:, 2] - 0.05) * 0.02
        np.testing.assert_allclose(np.unique(np.round(heights, 12)), faces, rtol=0, atol=1e-12)
        core = replace(shape, rounding=0.02).frustum[0]
        np.testing.assert_allclose(np.hypot(feet[:, 0], feet[:, 1]), 2.0 / 3.0 * core, rtol=1e-12)


@pytest.mark.parametrize(
    ("kind", "sizes", "rounding", "words"),
    [
        (Cylinder, (1.0, 2.0), -0.1, ("Cylinder.rounding", ">= 0", "-0.1")),
        (Cylinder, (1.0, 2.0), 1.0, ("Cylinder.rounding", "at most 0.99998", "of the whole")),
        (Cone, (3.0, 4.0), 1.5, ("Cone.rounding", "at most 1.49996")),
        (Disc, (1.0,), 1.0, ("Disc.rounding", "largest ball")),
        (CylinderBody, (1.0, 2.0), 1.5, ("CylinderBody.rounding", "less than")),
        (ConeBody, (3.0, 4.0), 1.5, ("ConeBody.rounding", "less than")),
        (DiscBody, (1.0,), 1.5, ("DiscBody.rounding", "less than")),
    ],
)
def test_bad_roundings(kind: type, sizes: tuple[float, ...], rounding: float, words: tuple[str, ...]) -> None:
    with pytest.raises(InvalidInput) as caught:
        kind(*sizes, rounding=rounding)
    assert all(word in str(caught.value) for word in words)
