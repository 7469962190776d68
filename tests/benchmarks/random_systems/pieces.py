"""What bodies consist of and where they are, read from their data: nothing of the engine is asked."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from bodies import (
    Box,
    Capsule,
    Cone,
    ConstantVelocity,
    ConvexHull,
    Cylinder,
    Disc,
    Ellipsoid,
    Harmonic,
    OpenBox,
    Plane,
    Plate,
    Rest,
    Sphere,
    Superellipsoid,
    TriangleMesh,
)
from nonsmooth.interfaces import Body, Shape
from nonsmooth.interfaces.body import Vector
from tests.benchmarks.random_systems.convex import CORNERS, FRUSTUM, NORM
from tests.benchmarks.random_systems.solids import PIECES


@dataclass(frozen=True)
class Piece:
    """A convex core in the axes of its body, swept by a sphere.

    Attributes
    ----------
    kind : int
        Corners, a frustum about the third axis, or a unit ball of two nested norms.
    numbers : array
        Radii and heights of the frustum's ends, or semi-axes and powers of the support function, shape [5].
    corners : array
        Corners [m], shape [n, 3].
    sweep : float
        Radius of the sphere [m].
    place, axes : array
        Origin [m] and axes as columns in the body.
    slack : float
        How far the body may differ from this by design, as feet stand out and rims are set back [m].
    """

    kind: int
    numbers: Vector
    corners: Vector
    sweep: float
    place: Vector
    axes: Vector
    slack: float = 0.0

    @property
    def flat(self) -> bool:
        """Whether the core is a disc."""
        return self.kind == FRUSTUM and self.numbers[1] == self.numbers[3]

    @property
    def reach(self) -> float:
        """Radius of a ball about ``place`` that holds the piece [m]."""
        if self.kind == CORNERS:
            return float(np.max(np.linalg.norm(self.corners, axis=1))) + self.sweep
        if self.kind == FRUSTUM:
            return float(max(np.hypot(*self.numbers[:2]), np.hypot(*self.numbers[2:4]))) + self.sweep
        return float(np.linalg.norm(self.numbers[:3])) + self.sweep


def rotations(q: Vector) -> Vector:
    """Return the matrices of quaternions, which are brought to unit length, shape [n, 3, 3]."""
    w, x, y, z = (q / np.linalg.norm(q, axis=1)[:, None]).T
    rows = (
        *(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        *(2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
        *(2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
    )
    return np.stack(rows, axis=1).reshape(-1, 3, 3)


def _axes(shape: Any) -> Vector:
    if hasattr(shape, "orientation_w"):
        q = shape.orientation_w, shape.orientation_x, shape.orientation_y, shape.orientation_z
        return np.asarray(rotations(np.array([q]))[0])
    third = np.array([shape.axis_x, shape.axis_y, shape.axis_z])
    first = np.cross(third, np.eye(3)[int(np.argmin(np.abs(third)))])
    first /= np.linalg.norm(first)
    return np.column_stack([first, np.cross(third, first), third])


def _frustum(shape: Any, profile: tuple[float, float, float, float]) -> Piece:
    place = np.array([shape.x, shape.y, shape.z])
    numbers = np.array([*profile, 0.0])
    return Piece(FRUSTUM, numbers, np.zeros((1, 3)), shape.rounding, place, _axes(shape), shape.set_back)


def _solid(corners: Any, sweep: float = 0.0) -> Piece:
    points = np.array(corners, dtype=float)
    middle = points.mean(axis=0)
    return Piece(CORNERS, np.zeros(5), points - middle, sweep, middle, np.eye(3))


def pieces_of_shape(shape: Shape) -> list[Piece]:
    """Return the convex pieces of a shape."""
    s: Any = shape
    if type(s) is Sphere:
        return [_solid([(s.x, s.y, s.z)], s.radius)]
    if type(s) is Capsule:
        return [_solid(s.ends, s.radius)]
    if type(s) is Box:
        half = np.array([s.half_x, s.half_y, s.half_z]) - s.rounding
        signs = np.array([(i, j, k) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
        return [_solid((signs * half) @ _axes(s).T + (s.x, s.y, s.z), s.rounding)]
    if type(s) is ConvexHull:
        return [_solid(np.array(s.points) @ _axes(s).T + (s.x, s.y, s.z), s.rounding)]
    if type(s) is Disc:
        radius = s.radius - s.rounding
        return [_frustum(s, (radius, 0.0, radius, 0.0))]
    if type(s) is Cylinder:
        radius, top = s.radius - s.rounding, s.half_length - s.rounding
        return [_frustum(s, (radius, -top, radius, top))]
    if type(s) is Cone:
        # the inner parallel cone: all its sides are moved in by the rounding
        widest = s.radius * s.height / (s.radius + math.hypot(s.radius, s.height))
        part = 1.0 - s.rounding / widest
        return [_frustum(s, (part * s.radius, s.rounding, 0.0, s.rounding + part * s.height))]
    if type(s) in (Ellipsoid, Superellipsoid):
        along, across = (s.exponent_along, s.exponent_across) if type(s) is Superellipsoid else (1.0, 1.0)
        sweep = s.rounding if type(s) is Superellipsoid else 0.0
        numbers = np.array([s.semi_x, s.semi_y, s.semi_z, 2.0 / (2.0 - along), 2.0 / (2.0 - across)])
        return [Piece(NORM, numbers, np.zeros((1, 3)), sweep, np.array([s.x, s.y, s.z]), _axes(s))]
    if type(s) is TriangleMesh:
        corners, surface = s.drawing()[0], vars(s)["surface"]
        n = len(corners) // 2
        return [_solid(corners[[*row, *(k + n for k in row)]]) for row in PIECES[surface.name]]
    raise TypeError(f"what are the pieces of {type(s).__name__}?")


def pieces_of(body: Body) -> list[Piece]:
    """Return the convex pieces of a body; none of a plate."""
    return [
        piece
        for shapes in body.frames
        for shape in shapes
        if type(shape) is not Plane
        for piece in pieces_of_shape(shape)
    ]


def driven_poses(motion: Any, t: Vector) -> tuple[Vector, Vector]:
    """Return the places [m] and the axes of what a motion carries, shapes [n, 3] and [n, 3, 3]."""
    n = len(t)
    if type(motion) is Harmonic:
        axis = np.array([motion.axis_x, motion.axis_y, motion.axis_z])
        way = motion.amplitude * np.sin(2.0 * np.pi * motion.frequency * t + motion.phase)
        return np.outer(way, axis / np.linalg.norm(axis)), np.tile(np.eye(3), (n, 1, 1))
    axes = rotations(np.array([motion.orientation]))[0]
    if type(motion) is Rest:
        c, s = np.cos(motion.slope), np.sin(motion.slope)
        tilted = axes @ np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
        return np.tile(motion.position, (n, 1)), np.tile(tilted, (n, 1, 1))
    assert type(motion) is ConstantVelocity
    half = 0.5 * motion.rate * t
    turns = rotations(np.column_stack([np.cos(half), np.outer(np.sin(half), motion.axis)]))
    centre = np.array(motion.position if motion.centre is None else motion.centre)
    arms = turns @ (np.array(motion.position) - centre)
    return centre + np.outer(t, motion.velocity) + arms, turns @ axes


def poses_of(body: Body, t: Vector, q: Vector) -> tuple[Vector, Vector]:
    """Return places [m] and axes of a body at times [s] by its coordinates, shape [n, n_q]."""
    if type(body) is OpenBox:
        return np.tile(body.position, (len(t), 1)), np.tile(rotations(np.array([body.orientation]))[0], (len(t), 1, 1))
    if body.n_q == 0:
        return driven_poses(body.motion, t)  # type: ignore[attr-defined]
    return q[:, :3], rotations(q[:, 3:])


def half_spaces(body: Body) -> list[tuple[Vector, Vector]]:
    """Return a point [m] and the outer normal of the planes of a body in its axes; none but of a plate or a box."""
    if type(body) is OpenBox:
        walls = ((-body.half_x, 0), (body.half_x, 0), (-body.half_y, 1), (body.half_y, 1))
        sides = [(half * np.eye(3)[k], -np.sign(half) * np.eye(3)[k]) for half, k in walls]
        return [(np.zeros(3), np.eye(3)[2]), *sides]
    return [(np.zeros(3), np.eye(3)[2])] if type(body) is Plate else []


def is_still(body: Body) -> bool:
    """Return whether a body is held at rest."""
    return type(body) is OpenBox or (body.n_q == 0 and isinstance(body.motion, Rest))  # type: ignore[attr-defined]
