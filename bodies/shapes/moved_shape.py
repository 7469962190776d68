"""Shapes turned and shifted in their body: `moved` for every shape, `MovedShape` for a `SupportShape`."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, final

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter
from nonsmooth.rotations import rotation
from nonsmooth.vectors import UNIT_PART, unit_vector

from ..values import product
from .egg import Egg
from .placement import with_axes
from .smooth import SmoothShape
from .support_shape import SupportShape


@final
@dataclass(frozen=True)
class MovedShape(SmoothShape):
    """A shape turned about the origin of its own frame by a unit quaternion, then shifted to (x, y, z).

    Attributes
    ----------
    shape : SupportShape
        The shape in the frame of its class, before it is turned and shifted.
    """

    shape: SupportShape = field()
    x: float = parameter(0.0, doc="shift, first coordinate", unit="m")
    y: float = parameter(0.0, doc="shift, second coordinate", unit="m")
    z: float = parameter(0.0, doc="shift, third coordinate", unit="m")
    orientation_w: float = parameter(1.0, doc="quaternion from its axes to the body's, scalar part", **UNIT_PART)
    orientation_x: float = parameter(0.0, doc="quaternion, first component", **UNIT_PART)
    orientation_y: float = parameter(0.0, doc="quaternion, second component", **UNIT_PART)
    orientation_z: float = parameter(0.0, doc="quaternion, third component", **UNIT_PART)

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return an egg."""
        return {"shape": Egg()}

    def _check(self) -> None:
        if not isinstance(self.shape, SupportShape):
            raise InvalidInput(
                "MovedShape.shape",
                "must be a shape that is given by its farthest points, a SupportShape",
                type(self.shape).__name__,
                "Other shapes are placed by their own numbers, such as Box(0.1, 0.1, 0.1, x=0.1).",
            )
        orientation = self.orientation_w, self.orientation_x, self.orientation_y, self.orientation_z
        unit_vector("MovedShape orientation", orientation, 4)

    @property
    def _axes(self) -> Vector:
        return with_axes(self.orientation_w, self.orientation_x, self.orientation_y, self.orientation_z)

    def _placed(self, point: Any) -> Vector:
        return np.asarray(np.array([self.x, self.y, self.z]) + self._axes @ np.asarray(point))

    @property
    def core(self) -> tuple[float, ...]:
        """Numbers of the shape's support function, with its centre and its axes turned and shifted."""
        core = self.shape.core
        return (*core[:6], *self._placed(core[6:9]).tolist(), *self._axes.ravel().tolist(), *core[18:])

    @property
    def length(self) -> float:
        """Upper bound of the distance of the farthest point from the origin of the body frame [m]."""
        return self.shape.length + float(np.linalg.norm([self.x, self.y, self.z]))

    def support(self, direction: Vector) -> Vector:
        """Return the point of the moved shape that lies farthest along a direction [m]."""
        return self._placed(self.shape.farthest(np.asarray(direction) @ self._axes))

    @property
    def volume(self) -> float:
        """Volume of the shape [m^3]."""
        return self.shape.volume

    @property
    def centroid(self) -> Vector:
        """Centroid of the moved shape [m]."""
        return self._placed(self.shape.centroid)

    @property
    def inertia(self) -> Vector:
        """Inertia tensor of the turned shape about its centroid, at density 1 [m^5]."""
        return np.asarray(self._axes @ self.shape.inertia @ self._axes.T)

    def drawing(self, fineness: int = 24) -> tuple[Vector, Vector]:
        """Return vertices [m] and triangles of the moved shape."""
        points, triangles = self.shape.drawing(fineness)
        return np.array([self._placed(point) for point in points]), triangles


def moved(shape: Shape, position: Vector, orientation: Vector) -> Shape:
    """Return the shape turned by a unit quaternion about the origin of its frame, then shifted by ``position`` [m].

    The place of a shape is its parameters x, y, z [m] and, unless it is a sphere, a unit axis (axis_x, ...) or a unit
    quaternion (orientation_w, ...) in the axes of its body. A SupportShape has none: it becomes a MovedShape.

    Raises
    ------
    InvalidInput
        The shape has no x, y, z, such as an unbounded plane.
    """
    if isinstance(shape, SupportShape):
        return MovedShape(shape, *position.tolist(), *orientation.tolist())
    numbers = shape.parameters()
    if not {"x", "y", "z"} <= set(numbers):
        raise InvalidInput(
            "shape of a part",
            "must have a centre with parameters x, y, z",
            type(shape).__name__,
            "An unbounded shape cannot be moved within a body.",
        )
    turn = rotation(orientation)
    changed = _vector(numbers, "", turn, position)
    if "axis_x" in numbers:
        changed |= _vector(numbers, "axis_", turn, np.zeros(3))
    if "orientation_w" in numbers:
        own = np.array([numbers[f"orientation_{letter}"] for letter in "wxyz"])
        whole = product(orientation, own)
        whole /= np.linalg.norm(whole)
        changed |= {f"orientation_{letter}": x for letter, x in zip("wxyz", whole.tolist(), strict=True)}
    return dataclasses.replace(shape, **changed)  # type: ignore[type-var]


def _vector(numbers: dict[str, float], prefix: str, turn: Vector, shift: Vector) -> dict[str, float]:
    before = np.array([numbers[prefix + letter] for letter in "xyz"])
    return {prefix + letter: x for letter, x in zip("xyz", (turn @ before + shift).tolist(), strict=True)}
