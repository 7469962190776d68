"""All contact pairs: gaps against support functions, degenerate positions.  Derivatives are the conformance kit's."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from bodies import (
    Box,
    Capsule,
    Cone,
    ConvexHull,
    Cylinder,
    Disc,
    Ellipsoid,
    Frustum,
    Ground,
    HalfSpace,
    Plane,
    Sphere,
    Superellipsoid,
)
from bodies.contacts.features.frames import tangent_of
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.interfaces import Shape
from tests.bodies.carriers import Rig
from tests.bodies.said_again import outside, random_poses, separation

Array = NDArray[np.float64]

PLACE = {"x": 0.1, "y": -0.05, "z": 0.07}
AXIS = {"axis_x": 0.48, "axis_y": -0.6, "axis_z": 0.64}
AXES = {"orientation_w": 0.8, "orientation_x": 0.36, "orientation_y": -0.48}
PLANE = Plane(0.1)
SPHERE = Sphere(0.2, x=-0.05, y=0.1, z=0.02)
BOX = Box(0.3, 0.2, 0.4, **PLACE, **AXES)
CAPSULE = Capsule(0.15, 0.4, **PLACE, **AXIS)
CYLINDER = Cylinder(0.3, 0.25, **PLACE, **AXIS)
DISC = Disc(0.4, **PLACE, **AXIS)
CONE = Cone(0.3, 0.35, **PLACE, **AXIS)
CONE_ON_FEET = Cone(0.3, 0.35, **PLACE, **AXIS, foot_height=0.02)
CYLINDER_ON_FEET = Cylinder(0.3, 0.25, **PLACE, **AXIS, foot_height=0.02)
DISC_ON_FEET = Disc(0.4, **PLACE, **AXIS, foot_height=0.03)
ROUNDED_CYLINDER = Cylinder(0.3, 0.25, **PLACE, **AXIS, foot_height=0.02, rounding=0.05)
ROUNDED_CONE = Cone(0.3, 0.35, **PLACE, **AXIS, foot_height=0.01, rounding=0.04)
ROUNDED_DISC = Disc(0.4, **PLACE, **AXIS, rounding=0.05)
ROUNDED_BOX = Box(0.3, 0.2, 0.4, **PLACE, **AXES, rounding=0.04)
HULL = ConvexHull(
    ((0.0, 0.0, 0.5), (0.4, 0.0, -0.2), (-0.3, 0.4, -0.2), (-0.3, -0.4, -0.1), (0.0, -0.1, -0.4)), **PLACE, **AXES
)
ROUNDED_HULL = ConvexHull(HULL.points, **PLACE, **AXES, rounding=0.06)
ELLIPSOID = Ellipsoid(0.2, 0.35, 0.5, **PLACE, **AXES)
SUPERELLIPSOID = Superellipsoid(0.3, 0.2, 0.4, 1.5, 1.2, **PLACE, **AXES)
BOXY = Superellipsoid(0.3, 0.2, 0.4, 0.4, 0.6, **PLACE, **AXES)
MIXED = Superellipsoid(0.3, 0.2, 0.4, 0.4, 1.3, **PLACE, **AXES)
"""Flat along its third axis, sharp across it."""
SHARP = Superellipsoid(0.2, 0.3, 0.25, 1.4, 0.5, y=0.1)
"""The other way round."""

PAIRS: dict[str, tuple[Shape, Shape, int]] = {
    "plane-sphere": (PLANE, SPHERE, 1),
    "plane-capsule": (PLANE, CAPSULE, 2),
    "half-space-box": (HalfSpace(0.1), BOX, 8),
    "plane-rounded box": (PLANE, ROUNDED_BOX, 8),
    "plane-rounded hull": (PLANE, ROUNDED_HULL, 5),
    "rounded box-sphere": (ROUNDED_BOX, SPHERE, 1),
    "rounded hull-sphere": (ROUNDED_HULL, SPHERE, 1),
    "rounded box-ellipsoid": (ROUNDED_BOX, ELLIPSOID, 1),
    "rounded hull-ellipsoid": (ROUNDED_HULL, ELLIPSOID, 1),
    "plane-box": (PLANE, BOX, 8),
    "plane-disc": (PLANE, DISC, 1),
    "plane-cylinder": (PLANE, CYLINDER, 2),
    "plane-disc on feet": (PLANE, DISC_ON_FEET, 1 + 6),
    "plane-cylinder on feet": (PLANE, CYLINDER_ON_FEET, 2 + 6),
    "plane-cone": (PLANE, CONE, 2),
    "plane-cone on feet": (PLANE, CONE_ON_FEET, 2 + 3),
    "plane-rounded cylinder on feet": (PLANE, ROUNDED_CYLINDER, 2 + 6),
    "plane-rounded cone on feet": (PLANE, ROUNDED_CONE, 2 + 3),
    "plane-rounded disc": (PLANE, ROUNDED_DISC, 1),
    "rounded cylinder-sphere": (replace(ROUNDED_CYLINDER, foot_height=0.0), SPHERE, 1),
    "rounded cone-sphere": (replace(ROUNDED_CONE, foot_height=0.0), SPHERE, 1),
    "rounded cylinder-ellipsoid": (replace(ROUNDED_CYLINDER, foot_height=0.0), ELLIPSOID, 1),
    "rounded cone-superellipsoid": (replace(ROUNDED_CONE, foot_height=0.0), SUPERELLIPSOID, 1),
    "rounded disc-ellipsoid": (ROUNDED_DISC, ELLIPSOID, 1),
    "plane-ellipsoid": (PLANE, ELLIPSOID, 1),
    "plane-hull": (PLANE, HULL, 5),
    "hull-sphere": (HULL, SPHERE, 1),
    "sphere-sphere": (SPHERE, Sphere(0.3, x=0.1), 1),
    "box-sphere": (BOX, SPHERE, 1),
    "capsule-sphere": (CAPSULE, SPHERE, 1),
    "cylinder-sphere": (CYLINDER, SPHERE, 1),
    "cone-sphere": (CONE, SPHERE, 1),
    "disc-sphere": (DISC, SPHERE, 1),
    "ellipsoid-ellipsoid": (ELLIPSOID, Ellipsoid(0.3, 0.1, 0.4, x=0.1), 1),
    "ellipsoid-sphere": (ELLIPSOID, SPHERE, 1),
    "plane-superellipsoid": (PLANE, SUPERELLIPSOID, 1),
    "superellipsoid-superellipsoid": (SUPERELLIPSOID, Superellipsoid(0.2, 0.3, 0.2, 1.3, 1.6, y=0.1), 1),
    "superellipsoid-ellipsoid": (SUPERELLIPSOID, ELLIPSOID, 1),
    "superellipsoid-sphere": (SUPERELLIPSOID, SPHERE, 1),
    "plane-boxy superellipsoid": (PLANE, BOXY, 1),
    "boxy superellipsoid-itself": (BOXY, Superellipsoid(0.2, 0.3, 0.2, 0.7, 0.5, y=0.1), 1),
    "boxy superellipsoid-ellipsoid": (BOXY, ELLIPSOID, 1),
    "boxy superellipsoid-superellipsoid": (BOXY, SUPERELLIPSOID, 1),
    "boxy superellipsoid-sphere": (BOXY, SPHERE, 1),
    "box-boxy superellipsoid": (BOX, BOXY, 1),
    "hull-boxy superellipsoid": (HULL, BOXY, 1),
    "capsule-boxy superellipsoid": (CAPSULE, BOXY, 1),
    "cylinder-boxy superellipsoid": (CYLINDER, BOXY, 1),
    "cone-boxy superellipsoid": (CONE, BOXY, 1),
    "disc-boxy superellipsoid": (DISC, BOXY, 1),
    "plane-mixed superellipsoid": (PLANE, MIXED, 1),
    "mixed superellipsoid-sphere": (SHARP, SPHERE, 1),
    "mixed superellipsoid-ellipsoid": (MIXED, ELLIPSOID, 1),
    "mixed superellipsoid-superellipsoid": (SHARP, SUPERELLIPSOID, 1),
    "mixed superellipsoid-boxy superellipsoid": (SHARP, BOXY, 1),
    "mixed superellipsoid-another": (MIXED, SHARP, 1),
    "box-mixed superellipsoid": (BOX, MIXED, 1),
    "capsule-mixed superellipsoid": (CAPSULE, SHARP, 1),
    "cone-mixed superellipsoid": (CONE, MIXED, 1),
    "box-ellipsoid": (BOX, ELLIPSOID, 1),
    "box-superellipsoid": (BOX, SUPERELLIPSOID, 1),
    "hull-ellipsoid": (HULL, ELLIPSOID, 1),
    "cylinder-ellipsoid": (CYLINDER, ELLIPSOID, 1),
    "cylinder-superellipsoid": (CYLINDER, SUPERELLIPSOID, 1),
    "cone-ellipsoid": (CONE, ELLIPSOID, 1),
    "cone-superellipsoid": (CONE, SUPERELLIPSOID, 1),
    "disc-ellipsoid": (DISC, ELLIPSOID, 1),
    "disc-superellipsoid": (DISC, SUPERELLIPSOID, 1),
    "capsule-ellipsoid": (CAPSULE, ELLIPSOID, 1),
    "capsule-superellipsoid": (CAPSULE, SUPERELLIPSOID, 1),
}
"""Pairs of shapes, and how many contacts they have."""
SMOOTH = "ellipsoid"
"""Who is in whose name has, deep in another body, several ways out, of which the pair need not give the shortest."""
SHALLOW = -0.02
"""Gap above which it is the shortest [m]."""

_rigs: dict[str, Rig] = {}


def _rig(build: Any, name: str) -> Rig:
    if name not in _rigs:
        _rigs[name] = Rig(PAIRS[name][:2], build.laws())
    return _rigs[name]


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("name", PAIRS)
def test_gap_is_the_widest_empty_slab(build: Any, name: str) -> None:
    """The witness points lie on the surfaces, the gap apart, and a slab that wide is empty: there is no other gap."""
    rig, shapes = _rig(build, name), PAIRS[name][:2]
    rng = np.random.default_rng(3)
    directions = rng.normal(size=(200, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    flat = isinstance(shapes[0], Ground)
    # rims of frustums are set back by their feet, and those of a disc stand out
    back = 1e-12 + sum(shape.set_back for shape in shapes if isinstance(shape, Frustum))
    seen = set()
    for _ in range(400):
        poses = random_poses(rng, 1.2)
        rig.put(poses, np.zeros(12))
        blocks = rig.geometry
        seen |= {int(block[29]) for block in blocks}
        matrices = [Rotation.from_quat(np.roll(o, -1)).as_matrix() for _, o in poses]
        for block in blocks:
            gap, n, t = block[0], block[1:4], block[4:7]
            # as plain numbers: for so many poses assert_allclose takes longer than all else
            assert max(abs(n @ n - 1.0), abs(t @ t - 1.0), abs(n @ t)) <= 1e-13
            assert np.max(np.abs(block[10:13] - block[7:10] - gap * n)) <= 1e-13
            for shape, witness, pose, axes in zip(shapes, (block[7:10], block[10:13]), poses, matrices, strict=True):
                height = outside(shape, axes.T @ (witness - pose[0]))
                assert height <= back
                # only of several contacts the farther ones may lie inside the whole shape
                assert height >= -back or gap > np.min(blocks[:, 0])
        nearest = blocks[np.argmin(blocks[:, 0])]
        widest = matrices[0][:, 2] if flat else nearest[1:4]
        assert separation(shapes, poses, widest) == pytest.approx(nearest[0], abs=back)
        if flat or SMOOTH not in name or nearest[0] > SHALLOW:
            assert np.max(separation(shapes, poses, directions)) <= nearest[0] + back
    # every feature was met
    assert seen == set(range(len(rig.contacts[0].kinematics.features)))


def test_tangent_of_a_face_that_looks_down_stays_with_it(build: Any) -> None:
    """The normal (0, 0, -1) of the body has no tangent of its own; round-off must not choose one as the body turns."""
    rig = Rig((Box(0.3, 0.2, 0.4), Sphere(0.1)), build.laws())
    for i in range(30):
        turn = Rotation.from_rotvec([0.3 * i, -0.2 * i, 0.5])
        q = np.roll(turn.as_quat(), 1)
        rig.put([(np.zeros(3), q), (turn.apply([0.01 * i, 0.05, -0.6]), q)], np.zeros(12))
        np.testing.assert_allclose(rig.geometry[0, 4:7], turn.apply([1.0, 0.0, 0.0]), rtol=0, atol=1e-12)


@settings(max_examples=50)
@given(x=st.floats(-1.0, 1.0), y=st.floats(-1.0, 1.0), far=st.floats(-16.0, 0.0))
def test_tangent_is_one_and_next_to_the_pole_stays(x: float, y: float, far: float) -> None:
    """Unit and across to round-off everywhere; what round-off leaves of a normal that looks down does not turn it."""
    n = np.array([10.0**far * x, 10.0**far * y, -1.0])
    n /= np.linalg.norm(n)
    tangent = np.array(tangent_of(n.tolist()))
    assert abs(tangent @ n) <= 4e-15
    assert np.linalg.norm(tangent) == pytest.approx(1.0, abs=4e-15)
    if np.hypot(n[0], n[1]) < 1e-9:
        np.testing.assert_allclose(tangent, [1.0, 0.0, 0.0], rtol=0, atol=2e-9)


AT_ORIGIN = (np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]))
LEVEL_X = {"axis_x": 1.0, "axis_z": 0.0}
DEGENERATE: dict[str, tuple[tuple[Shape, Shape], Any, float]] = {
    "flat disc": ((Plane(), Disc(0.3, foot_height=1e-3)), (0.0, 0.0, 0.1), 0.099),
    "flat cylinder": ((Plane(), Cylinder(0.3, 0.2)), (0.0, 0.0, 0.3), 0.1),
    "concentric spheres": ((Sphere(0.1), Sphere(0.2)), (0.0, 0.0, 0.0), -0.3),
    "sphere in the middle of a box": ((Box(0.3, 0.2, 0.4), Sphere(0.1)), (0.0, 0.0, 0.0), -0.3),
    "sphere on a vertex of a box": ((Box(0.3, 0.2, 0.4), Sphere(0.1)), (0.3, 0.2, 0.4), -0.1),
    "sphere in the middle of a capsule": ((Capsule(0.2, 0.3), Sphere(0.1)), (0.0, 0.0, 0.0), -0.3),
    "sphere in the middle of a long cylinder": ((Cylinder(0.2, 0.3), Sphere(0.1)), (0.0, 0.0, 0.0), -0.3),
    "sphere in the middle of a flat cylinder": ((Cylinder(0.3, 0.2), Sphere(0.1)), (0.0, 0.0, 0.0), -0.3),
    "sphere on the rim of a cylinder": ((Cylinder(0.3, 0.2), Sphere(0.1)), (0.3, 0.0, 0.2), -0.1),
    "sphere in the middle of a cone": ((Cone(0.3, 0.4), Sphere(0.1)), (0.0, 0.0, 0.1), -0.2),
    "sphere on the apex of a cone": ((Cone(0.3, 0.4), Sphere(0.1)), (0.0, 0.0, 0.4), -0.1),
    "sphere over the apex of a cone": ((Cone(0.3, 0.4), Sphere(0.1)), (0.0, 0.0, 0.6), 0.1),
    "flat cone": ((Plane(), Cone(0.3, 0.2)), (0.0, 0.0, 0.1), 0.1),
    "sphere in the middle of a disc": ((Disc(0.3), Sphere(0.1)), (0.0, 0.0, 0.0), -0.1),
    "parallel capsules": ((Capsule(0.1, 0.3), Capsule(0.1, 0.3)), (0.5, 0.0, 0.1), 0.3),
    "opposite capsules": ((Capsule(0.1, 0.3), Capsule(0.1, 0.3, axis_z=-1.0)), (0.5, 0.0, 0.1), 0.3),
    "capsules in a row": ((Capsule(0.1, 0.3), Capsule(0.1, 0.3)), (0.0, 0.0, 1.0), 0.2),
    "capsules that cross": ((Capsule(0.1, 0.3), Capsule(0.1, 0.3, **LEVEL_X)), (0.0, 0.0, 0.0), -0.2),
}


MEETING = (
    "concentric spheres",
    "sphere in the middle of a capsule",
    "capsules that cross",
    "sphere on the apex of a cone",
)
"""Where the cores meet, the normal turns infinitely fast and the bias has no value."""


@pytest.mark.parametrize("name", DEGENERATE)
def test_degenerate_positions_give_finite_numbers(build: Any, name: str) -> None:
    """Where normal or witness is not unique, one is taken; all that follows is finite, also at a high speed."""
    shapes, place, gap = DEGENERATE[name]
    rig = Rig(shapes, build.laws())
    u = np.array([1.0, 2.0, -3.0, 10.0, -5.0, 7.0, -2.0, 1.0, 0.5, 3.0, 20.0, -4.0])
    rig.put([AT_ORIGIN, (np.array(place), AT_ORIGIN[1])], u)
    assert np.min(rig.geometry[:, 0]) == pytest.approx(gap, abs=1e-15)
    # two edges that are parallel do not cross
    bias = np.zeros(1) if name in MEETING else rig.bias[rig.geometry[:, 30] <= 0.0]
    for numbers in (rig.geometry, rig.axes, rig.rate, bias):
        assert np.all(np.isfinite(numbers))
    np.testing.assert_allclose(rig.axes @ rig.axes.transpose(0, 2, 1) - np.eye(3), 0.0, atol=1e-14)


@pytest.mark.parametrize("along", [0.0, 0.2, -0.3, 0.45])
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_parallel_capsules_touch_at_both_ends_of_the_overlap(build: Any, along: float, sign: float) -> None:
    """Segments of half-lengths 0.3 and 0.2, shifted along each other: one contact for each end."""
    rig = Rig((Capsule(0.1, 0.3), Capsule(0.05, 0.2, axis_z=sign)), build.laws())
    rig.put([AT_ORIGIN, (np.array([0.0, 0.5, along]), AT_ORIGIN[1])], np.zeros(12))
    touching = rig.geometry[rig.geometry[:, 30] <= 0.0]
    nearest = touching[np.isclose(touching[:, 0], 0.35, rtol=0, atol=1e-12)]
    ends = [0.1 * np.array([0.0, 1.0, 0.0]) + [0.0, 0.0, z] for z in (max(-0.3, along - 0.2), min(0.3, along + 0.2))]
    np.testing.assert_allclose(nearest[np.argsort(nearest[:, 9]), 7:10], ends, rtol=0, atol=1e-15)


def test_nearly_parallel_capsules_lose_no_digits(build: Any) -> None:
    """The gap of capsules tilted by 1e-12 to 1e-2 is that at the lower end, or at the crossing of the lines."""
    rig = Rig((Capsule(0.1, 0.3), Capsule(0.05, 0.2)), build.laws())
    for tilt in 10.0 ** np.arange(-12.0, -1.5):
        lean = np.array([np.cos(tilt / 2.0), np.sin(tilt / 2.0), 0.0, 0.0])
        rig.put([AT_ORIGIN, (np.array([0.0, 0.5, 0.0]), lean)], np.zeros(12))
        assert np.min(rig.geometry[:, 0]) == pytest.approx(0.35 - 0.2 * np.sin(tilt), abs=1e-12)
        twist = np.array([np.cos(tilt / 2.0), 0.0, np.sin(tilt / 2.0), 0.0])
        rig.put([AT_ORIGIN, (np.array([0.0, 0.5, 0.0]), twist)], np.zeros(12))
        assert np.min(rig.geometry[:, 0]) == pytest.approx(0.35, abs=1e-12)


@pytest.mark.slow
def test_tangents_follow_the_normal_without_a_jump(build: Any) -> None:
    """A small ball led round a box, over all faces but the lowest, sees its first tangent turn with the normal."""
    rig = Rig((Box(0.3, 0.3, 0.3), Sphere(0.1)), build.laws())
    before: Any = None
    for angle in np.linspace(-1.1, 4.2, 2001 if PLAIN else 20001):
        place = 0.8 * np.array([np.cos(angle), 0.1, np.sin(angle)])
        rig.put([AT_ORIGIN, (place, AT_ORIGIN[1])], np.zeros(12))
        axes = rig.axes[0]
        if before is not None:
            turned_by = np.linalg.norm(axes[0] - before[0])
            assert np.linalg.norm(axes[1] - before[1]) <= 3.0 * turned_by + 1e-12
        before = axes


@pytest.mark.parametrize("shape", [Disc(0.3), Cylinder(0.3, 0.2, z=0.2)], ids=["disc", "cylinder"])
def test_a_nearly_flat_rim_loses_no_digits(build: Any, shape: Disc | Cylinder) -> None:
    """The least gap of a rim and its feet, tilted by 1e-20 to 1e-1 rad over a plane, in any orientation of both."""
    rig = Rig((Plane(), shape), build.laws())
    rng = np.random.default_rng(5)
    for tilt in 10.0 ** np.arange(-20.0, -0.5, 0.5):
        frame = rng.normal(size=4)
        frame /= np.linalg.norm(frame)
        up = Rotation.from_quat(np.roll(frame, -1)).apply([0.0, 0.0, 1.0])
        leaning = np.array([np.cos(tilt / 2.0), np.sin(tilt / 2.0), 0.0, 0.0])
        lean = Rotation.from_quat(np.roll(frame, -1)) * Rotation.from_quat(np.roll(leaning, -1))
        for turning in (np.ones(3), -np.ones(3)):
            spins = np.concatenate([np.ones(9), turning])
            rig.put([(np.zeros(3), frame), (0.5 * up, np.roll(lean.as_quat(), 1))], spins)
            rims = [place[2] * np.cos(tilt) - radius * np.sin(tilt) for radius, place in shape.standing_rims]
            feet = [x[2] * np.cos(tilt) + x[1] * np.sin(tilt) for x in shape.feet]
            assert np.min(rig.geometry[:, 0]) == pytest.approx(0.5 + min(*rims, *feet), abs=2e-15)
            assert np.all(np.isfinite(rig.bias))
