"""What the shapes are, said a second time and in another way: by support function and by membership."""

from __future__ import annotations

import functools
import itertools
from dataclasses import replace
from typing import Any

import numpy as np
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
from nonsmooth.interfaces import Shape

Array = NDArray[np.float64]


def _local(shape: Any, x: Array) -> Array:
    return np.asarray(x - np.array([shape.x, shape.y, shape.z]))


@functools.cache
def _own_axes(shape: Any) -> Array:
    parts = [shape.orientation_x, shape.orientation_y, shape.orientation_z, shape.orientation_w]
    return np.asarray(Rotation.from_quat(parts).as_matrix())


def _axis(shape: Any) -> Array:
    return np.array([shape.axis_x, shape.axis_y, shape.axis_z])


def _across(shape: Any, x: Array) -> Any:
    axis = _axis(shape)
    return np.linalg.norm(x - np.multiply.outer(x @ axis, axis), axis=-1)


@functools.cache
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


@functools.cache
def _planes(shape: Any) -> tuple[Array, Array]:
    """Return the outward normals of all planes through three points that have all others on one side, and a point."""
    points, planes = np.array(shape.points), []
    for i, j, k in itertools.combinations(range(len(points)), 3):
        normal = np.cross(points[j] - points[i], points[k] - points[i])
        normal /= np.linalg.norm(normal)
        heights = (points - points[i]) @ normal
        planes += [(sign * normal, points[i]) for sign in (1.0, -1.0) if np.all(sign * heights <= 1e-12)]
    normals, through = zip(*planes, strict=True)
    return np.array(normals), np.array(through)


def _outside_hull(shape: Any, x: Array) -> Any:
    """Return the height over the highest plane through three points that has all others on one side."""
    normals, through = _planes(shape)
    own = _own_axes(shape).T @ _local(shape, x)
    return float(np.max(np.sum((own - through) * normals, axis=1)))


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


def outside(shape: Any, x: Array) -> Any:
    """Return what is negative inside of a shape only, at points [n, 3] of the frame of its body."""
    return _outside_rounded(shape, x) if _is_round(shape) else OUTSIDE[type(shape)](shape, x)


def _support(shape: Any, n: Array) -> Any:
    if isinstance(shape, Ground):
        return np.where(n[..., 2] > 1.0 - 1e-12, shape.height, np.inf)
    if _is_round(shape):
        return _support(_core_of(shape), n) + shape.rounding
    return SUPPORT[type(shape)](shape, n) + n @ np.array([shape.x, shape.y, shape.z])


def separation(shapes: Any, poses: Any, n: Array) -> Any:
    """Width of the empty slab across n between the shapes; the gap is its largest value over all n."""
    (p, a), (q, b) = [(position, Rotation.from_quat(np.roll(o, -1)).as_matrix()) for position, o in poses]
    return n @ (q - p) - _support(shapes[1], -(n @ b)) - _support(shapes[0], n @ a)


def random_poses(rng: np.random.Generator, reach: float) -> Any:
    """Return places and quaternions of two bodies, up to ``reach`` apart [m]."""
    direction = rng.normal(size=3)
    place = direction / np.linalg.norm(direction) * reach * rng.uniform(0.05, 1.0)
    quaternions = rng.normal(size=(2, 4))
    quaternions /= np.linalg.norm(quaternions, axis=1)[:, None]
    position = rng.normal(size=3)
    return [(position, quaternions[0]), (position + place, quaternions[1])]
