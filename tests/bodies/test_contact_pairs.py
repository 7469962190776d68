"""All contact pairs: gaps against support functions, degenerate positions.  Derivatives are the conformance kit's."""

from __future__ import annotations

import itertools
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
    Ground,
    HalfSpace,
    Plane,
    Sphere,
    Superellipsoid,
)
from bodies.contacts.tangents import tangent_of
from nonsmooth.interfaces import Shape
from tests.bodies.carriers import Rig

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
    "capsule-capsule": (CAPSULE, Capsule(0.1, 0.3, x=0.02, axis_y=-0.6, axis_z=0.8), 1),
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


# what the shapes are, said a second time and in another way: by support function and by membership


def _local(shape: Any, x: Array) -> Array:
    return np.asarray(x - np.array([shape.x, shape.y, shape.z]))


def _own_axes(shape: Any) -> Array:
    parts = [shape.orientation_x, shape.orientation_y, shape.orientation_z, shape.orientation_w]
    return np.asarray(Rotation.from_quat(parts).as_matrix())


def _axis(shape: Any) -> Array:
    return np.array([shape.axis_x, shape.axis_y, shape.axis_z])


def _across(shape: Any, x: Array) -> Any:
    axis = _axis(shape)
    return np.linalg.norm(x - np.multiply.outer(x @ axis, axis), axis=-1)


def _feet(shape: Any) -> Array:
    """Return the tips of the feet from the centre, three on either face, a third of a turn apart [6, 3]."""
    own = getattr(shape, "half_length", shape.foot_height)
    first = np.cross(_axis(shape), [0.0, -1.0, 0.0])
    first *= 2.0 / 3.0 * shape.radius / np.linalg.norm(first)
    thirds = [Rotation.from_rotvec(2.0 * np.pi / 3.0 * i * _axis(shape)).apply(first) for i in range(3)]
    return np.array([away * _axis(shape) + third for away in (-own, own) for third in thirds])


def _with_feet(shape: Any, n: Array, round_body: Any) -> Any:
    """Return the support of a body that stands on feet, whose rims are set back."""
    if shape.foot_height == 0.0:
        return round_body
    return np.maximum(round_body - shape.foot_height * _set_back(shape, n), np.max(n @ _feet(shape).T, axis=-1))


def _set_back(shape: Any, n: Array) -> Any:
    return np.abs(n @ _axis(shape)) if isinstance(shape, Cylinder) else 0.0


def _off_feet(shape: Any, x: Array, outside: Any) -> Any:
    """Return how far a point is outside of the round body or, if that is nearer, of the tip of a foot."""
    if shape.foot_height == 0.0:
        return outside
    return min(outside, np.min(np.linalg.norm(_feet(shape) - _local(shape, x), axis=-1)))


def _cone_feet(shape: Cone) -> Array:
    """Return the tips of the feet from the centre of the base."""
    return _feet(replace(shape, foot_height=0.0))[:3]


def _cone_support(shape: Cone, n: Array) -> Any:
    """Return the larger of rim and apex, or of the feet; the rim is set back along the side."""
    along, back = n @ _axis(shape), shape.foot_height / shape.height
    rim = (1.0 - back) * shape.radius * _across(shape, n) + shape.foot_height * along
    body = np.maximum(rim, shape.height * along)
    return np.maximum(body, np.max(n @ _cone_feet(shape).T, axis=-1)) if shape.foot_height else body


def _off_cone(shape: Cone, x: Array) -> Any:
    own = _local(shape, x)
    height, away = own @ _axis(shape), _across(shape, own)
    steep = (away * shape.height + (height - shape.height) * shape.radius) / np.hypot(shape.height, shape.radius)
    outside = max(shape.foot_height - height, steep)
    if shape.foot_height:
        outside = min(outside, np.min(np.linalg.norm(_cone_feet(shape) - own, axis=-1)))
    return outside


def _norm(shape: Superellipsoid, x: Array) -> float:
    """Return the number that is 1 on the surface, linear along rays from the centre."""
    along, across = shape.exponent_along, shape.exponent_across
    a, b, c = np.abs(x) / np.array([shape.semi_x, shape.semi_y, shape.semi_z])
    r = (a ** (2.0 / across) + b ** (2.0 / across)) ** (across / 2.0)
    return float((r ** (2.0 / along) + c ** (2.0 / along)) ** (along / 2.0))


def _dual_norm(shape: Superellipsoid, n: Array) -> Any:
    """Return the largest value of n . x where that number is 1, by Hoelder's inequality."""
    p, q = 2.0 / (2.0 - shape.exponent_along), 2.0 / (2.0 - shape.exponent_across)
    m = np.abs(n) * np.array([shape.semi_x, shape.semi_y, shape.semi_z])
    return ((m[..., 0] ** q + m[..., 1] ** q) ** (p / q) + m[..., 2] ** p) ** (1.0 / p)


def _outside_hull(shape: Any, x: Array) -> Any:
    """Return the height over the highest plane through three points that has all others on one side."""
    points, own = np.array(shape.points), _own_axes(shape).T @ _local(shape, x)
    highest = -np.inf
    for i, j, k in itertools.combinations(range(len(points)), 3):
        normal = np.cross(points[j] - points[i], points[k] - points[i])
        normal /= np.linalg.norm(normal)
        heights = (points - points[i]) @ normal
        for sign in (1.0, -1.0):
            if np.all(sign * heights <= 1e-12):
                highest = max(highest, sign * float((own - points[i]) @ normal))
    return highest


def _core(shape: Any) -> Any:
    return np.array([shape.half_x, shape.half_y, shape.half_z]) - shape.rounding


def _off_core(shape: Any, over: Array) -> Any:
    """Return how far a point is outside, given how far it is over the sides of the core."""
    outside = float(np.linalg.norm(np.maximum(over, 0.0)))
    return (outside if outside > 0.0 else float(np.max(over))) - shape.rounding


def _outside_rounded_hull(shape: Any, x: Array) -> Any:
    """Return how far a point is outside, by a search for the nearest point of the core over its triangles."""
    points, own = np.array(shape.points), _own_axes(shape).T @ _local(shape, x)
    inside = _outside_hull(shape, x)
    if inside <= 0.0:
        return inside - shape.rounding
    nearest = np.inf
    for corners in itertools.combinations(points, 3):
        # shares of the corners of the nearest point of the plane, of each line, and the corners themselves
        for some in itertools.chain([corners], itertools.combinations(corners, 2), ((c,) for c in corners)):
            ways = np.array(some[1:]) - some[0] if len(some) > 1 else np.zeros((0, 3))
            shares = np.linalg.lstsq(ways.T, own - some[0], rcond=None)[0] if len(some) > 1 else np.zeros(0)
            if np.all(shares >= 0.0) and np.sum(shares) <= 1.0:
                nearest = min(nearest, float(np.linalg.norm(own - some[0] - shares @ ways)))
    return nearest - shape.rounding


def _is_round(shape: Any) -> bool:
    return isinstance(shape, (Cylinder, Cone, Disc)) and shape.rounding > 0.0


def _core_of(shape: Any) -> Any:
    """Return the sharp body of which the rounded one is all that is near to it."""
    r = shape.rounding
    if isinstance(shape, Disc):
        return replace(shape, radius=shape.radius - r, rounding=0.0)
    if isinstance(shape, Cylinder):
        return replace(shape, radius=shape.radius - r, half_length=shape.half_length - r, rounding=0.0)
    # side and base go inwards by the radius, so that a cone of the same slope is left
    part = 1.0 - r / (shape.radius * shape.height / (shape.radius + np.hypot(shape.radius, shape.height)))
    base = dict(zip("xyz", ([shape.x, shape.y, shape.z] + r * _axis(shape)).tolist(), strict=True))
    return replace(shape, radius=part * shape.radius, height=part * shape.height, rounding=0.0, **base)


def _outside_rounded(shape: Any, x: Array) -> Any:
    """Return how far a point is outside of a core with a radius, by its profile, and of the tips of its feet."""
    core = _core_of(shape)
    own, back = _local(core, x), core.foot_height
    if isinstance(core, Cone):
        rim = core.radius * (1.0 - back / core.height)
        profile, feet = [(0.0, back), (rim, back), (0.0, core.height)], _cone_feet(core)
    elif isinstance(core, Cylinder):
        half = core.half_length - back
        profile, feet = [(0.0, -half), (core.radius, -half), (core.radius, half), (0.0, half)], _feet(core)
    else:
        profile, feet = [(0.0, 0.0), (core.radius, 0.0)], _feet(core)
    point, nearest = np.array([_across(core, own), own @ _axis(core)]), np.inf
    for one, two in itertools.pairwise(np.array(profile)):
        share = np.clip((point - one) @ (two - one) / ((two - one) @ (two - one)), 0.0, 1.0)
        nearest = min(nearest, float(np.linalg.norm(point - one - share * (two - one))))
    if back:
        nearest = min(nearest, float(np.min(np.linalg.norm(feet - own, axis=-1))))
    return nearest - shape.rounding


SUPPORT: dict[type[Shape], Any] = {
    Sphere: lambda s, n: s.radius,
    Capsule: lambda s, n: s.radius + s.half_length * np.abs(n @ _axis(s)),
    Cylinder: lambda s, n: _with_feet(s, n, s.radius * _across(s, n) + s.half_length * np.abs(n @ _axis(s))),
    Cone: lambda s, n: _cone_support(s, n),
    Disc: lambda s, n: _with_feet(s, n, s.radius * _across(s, n)),
    Box: lambda s, n: np.abs(n @ _own_axes(s)) @ _core(s) + s.rounding,
    ConvexHull: lambda s, n: np.max((n @ _own_axes(s)) @ np.array(s.points).T, axis=-1) + s.rounding,
    Ellipsoid: lambda s, n: np.linalg.norm(n @ _own_axes(s) * np.array([s.semi_x, s.semi_y, s.semi_z]), axis=-1),
    Superellipsoid: lambda s, n: _dual_norm(s, n @ _own_axes(s)),
}
"""max n . x over a shape, from its centre."""

OUTSIDE: dict[type[Shape], Any] = {
    Plane: lambda s, x: x[2] - s.height,
    HalfSpace: lambda s, x: x[2] - s.height,
    Sphere: lambda s, x: np.linalg.norm(_local(s, x)) - s.radius,
    Capsule: lambda s, x: (
        np.linalg.norm(_local(s, x) - np.clip(_local(s, x) @ _axis(s), -s.half_length, s.half_length) * _axis(s))
        - s.radius
    ),
    Cylinder: lambda s, x: _off_feet(
        s, x, max(abs(_local(s, x) @ _axis(s)) - s.half_length + s.foot_height, _across(s, _local(s, x)) - s.radius)
    ),
    Cone: lambda s, x: _off_cone(s, x),
    Disc: lambda s, x: _off_feet(s, x, max(abs(_local(s, x) @ _axis(s)), _across(s, _local(s, x)) - s.radius)),
    Box: lambda s, x: _off_core(s, np.abs(_local(s, x) @ _own_axes(s)) - _core(s)),
    ConvexHull: lambda s, x: _outside_hull(s, x) if s.rounding == 0.0 else _outside_rounded_hull(s, x),
    Ellipsoid: lambda s, x: (
        np.linalg.norm(_local(s, x) @ _own_axes(s) / np.array([s.semi_x, s.semi_y, s.semi_z])) - 1.0
    ),
    Superellipsoid: lambda s, x: _norm(s, _local(s, x) @ _own_axes(s)) - 1.0,
}
"""Zero on the surface, positive outside, negative inside."""


def _outside(shape: Any, x: Array) -> Any:
    return _outside_rounded(shape, x) if _is_round(shape) else OUTSIDE[type(shape)](shape, x)


def _support(shape: Any, n: Array) -> Any:
    if isinstance(shape, Ground):
        return np.where(n[..., 2] > 1.0 - 1e-12, shape.height, np.inf)
    if _is_round(shape):
        return _support(_core_of(shape), n) + shape.rounding
    return SUPPORT[type(shape)](shape, n) + n @ np.array([shape.x, shape.y, shape.z])


def _separation(shapes: Any, poses: Any, n: Array) -> Any:
    """Width of the empty slab across n between the shapes; the gap is its largest value over all n."""
    (p, a), (q, b) = [(position, Rotation.from_quat(np.roll(o, -1)).as_matrix()) for position, o in poses]
    return n @ (q - p) - _support(shapes[1], -(n @ b)) - _support(shapes[0], n @ a)


def _random_poses(rng: np.random.Generator, reach: float) -> Any:
    direction = rng.normal(size=3)
    place = direction / np.linalg.norm(direction) * reach * rng.uniform(0.05, 1.0)
    quaternions = rng.normal(size=(2, 4))
    quaternions /= np.linalg.norm(quaternions, axis=1)[:, None]
    position = rng.normal(size=3)
    return [(position, quaternions[0]), (position + place, quaternions[1])]


@pytest.mark.parametrize("name", PAIRS)
def test_gap_is_the_widest_empty_slab(build: Any, name: str) -> None:
    """The witness points lie on the surfaces, the gap apart, and a slab that wide is empty: there is no other gap."""
    rig, shapes = _rig(build, name), PAIRS[name][:2]
    rng = np.random.default_rng(3)
    directions = rng.normal(size=(200, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    flat = isinstance(shapes[0], Ground)
    seen = set()
    for _ in range(400):
        poses = _random_poses(rng, 1.2)
        rig.put(poses, np.zeros(12))
        blocks = rig.geometry
        seen |= {int(block[29]) for block in blocks}
        matrices = [Rotation.from_quat(np.roll(o, -1)).as_matrix() for _, o in poses]
        for block in blocks:
            gap, n, t = block[0], block[1:4], block[4:7]
            np.testing.assert_allclose([n @ n, t @ t, n @ t], [1.0, 1.0, 0.0], rtol=0, atol=1e-13)
            np.testing.assert_allclose(block[10:13] - block[7:10], gap * n, rtol=0, atol=1e-13)
            for shape, witness, pose, axes in zip(shapes, (block[7:10], block[10:13]), poses, matrices, strict=True):
                outside = _outside(shape, axes.T @ (witness - pose[0]))
                assert outside <= 1e-12
                # only of several contacts the farther ones may lie inside the whole shape
                assert outside >= -1e-12 or gap > np.min(blocks[:, 0])
        nearest = blocks[np.argmin(blocks[:, 0])]
        widest = matrices[0][:, 2] if flat else nearest[1:4]
        assert _separation(shapes, poses, widest) == pytest.approx(nearest[0], abs=1e-12)
        if flat or SMOOTH not in name or nearest[0] > SHALLOW:
            assert np.max(_separation(shapes, poses, directions)) <= nearest[0] + 1e-12
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
    tangent = np.array(tangent_of(*n.tolist()))
    assert abs(tangent @ n) <= 4e-15
    assert np.linalg.norm(tangent) == pytest.approx(1.0, abs=4e-15)
    if np.hypot(n[0], n[1]) < 1e-9:
        np.testing.assert_allclose(tangent, [1.0, 0.0, 0.0], rtol=0, atol=2e-9)


AT_ORIGIN = (np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]))
LEVEL_X = {"axis_x": 1.0, "axis_z": 0.0}
DEGENERATE: dict[str, tuple[tuple[Shape, Shape], Any, float]] = {
    "flat disc": ((Plane(), Disc(0.3)), (0.0, 0.0, 0.1), 0.1),
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
    bias = np.zeros(1) if name in MEETING else rig.bias
    for numbers in (rig.geometry, rig.axes, rig.rate, bias):
        assert np.all(np.isfinite(numbers))
    np.testing.assert_allclose(rig.axes @ rig.axes.transpose(0, 2, 1) - np.eye(3), 0.0, atol=1e-14)


@pytest.mark.parametrize(("along", "overlap"), [(0.0, 0.0), (0.2, 0.1), (-0.3, -0.1), (0.45, 0.225)])
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_parallel_capsules_touch_in_the_middle_of_the_overlap(
    build: Any, along: float, overlap: float, sign: float
) -> None:
    """Segments of half-lengths 0.3 and 0.2, shifted along each other; past the overlap the nearest ends."""
    rig = Rig((Capsule(0.1, 0.3), Capsule(0.05, 0.2, axis_z=sign)), build.laws())
    rig.put([AT_ORIGIN, (np.array([0.0, 0.5, along]), AT_ORIGIN[1])], np.zeros(12))
    low, high = max(-0.3, along - 0.2), min(0.3, along + 0.2)
    np.testing.assert_allclose(rig.geometry[0, 7:10], [0.0, 0.1, 0.5 * (low + high)], rtol=0, atol=1e-15)
    assert rig.geometry[0, 0] == pytest.approx(0.35)


def test_nearly_parallel_capsules_lose_no_digits(build: Any) -> None:
    """The gap of capsules tilted by 1e-12 to 1e-2 is that at the lower end, or at the crossing of the lines."""
    rig = Rig((Capsule(0.1, 0.3), Capsule(0.05, 0.2)), build.laws())
    for tilt in 10.0 ** np.arange(-12.0, -1.5):
        lean = np.array([np.cos(tilt / 2.0), np.sin(tilt / 2.0), 0.0, 0.0])
        rig.put([AT_ORIGIN, (np.array([0.0, 0.5, 0.0]), lean)], np.zeros(12))
        assert rig.geometry[0, 0] == pytest.approx(0.35 - 0.2 * np.sin(tilt), abs=1e-12)
        twist = np.array([np.cos(tilt / 2.0), 0.0, np.sin(tilt / 2.0), 0.0])
        rig.put([AT_ORIGIN, (np.array([0.0, 0.5, 0.0]), twist)], np.zeros(12))
        assert rig.geometry[0, 0] == pytest.approx(0.35, abs=1e-15)


def test_tangents_follow_the_normal_without_a_jump(build: Any) -> None:
    """A small ball led round a box, over all faces but the lowest, sees its first tangent turn with the normal."""
    rig = Rig((Box(0.3, 0.3, 0.3), Sphere(0.1)), build.laws())
    before: Any = None
    for angle in np.linspace(-1.1, 4.2, 20001):
        place = 0.8 * np.array([np.cos(angle), 0.1, np.sin(angle)])
        rig.put([AT_ORIGIN, (place, AT_ORIGIN[1])], np.zeros(12))
        axes = rig.axes[0]
        if before is not None:
            turned_by = np.linalg.norm(axes[0] - before[0])
            assert np.linalg.norm(axes[1] - before[1]) <= 3.0 * turned_by + 1e-12
        before = axes


@pytest.mark.parametrize("shape", [Disc(0.3), Cylinder(0.3, 0.2, z=0.2)], ids=["disc", "cylinder"])
def test_a_nearly_flat_rim_loses_no_digits(build: Any, shape: Shape) -> None:
    """The lowest point of a rim tilted by 1e-20 to 1e-1, on planes and discs turned together in any way."""
    rig = Rig((Plane(), shape), build.laws())
    rng = np.random.default_rng(5)
    for tilt in 10.0 ** np.arange(-20.0, -0.5, 0.5):
        frame = rng.normal(size=4)
        frame /= np.linalg.norm(frame)
        up = Rotation.from_quat(np.roll(frame, -1)).apply([0.0, 0.0, 1.0])
        leaning = np.array([np.cos(tilt / 2.0), np.sin(tilt / 2.0), 0.0, 0.0])
        lean = Rotation.from_quat(np.roll(frame, -1)) * Rotation.from_quat(np.roll(leaning, -1))
        rig.put([(np.zeros(3), frame), (0.5 * up, np.roll(lean.as_quat(), 1))], np.ones(12))
        assert np.min(rig.geometry[:, 0]) == pytest.approx(0.5 - 0.3 * np.sin(tilt), abs=2e-15)
        assert np.all(np.isfinite(rig.bias))
