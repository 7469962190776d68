"""Compound: bodies joined into one."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.interfaces.look import Look
from nonsmooth.rotations import rotation

from .ball import Ball
from .free import FreeBody, TensorBody
from .inertia import parallel_axis, tensor_of, without_round_off
from .shapes.moved_shape import moved
from .values import check_fields


@final
@dataclass(frozen=True)
class Part:
    """A body and its pose in a compound.

    Attributes
    ----------
    body : FreeBody
        Gives mass, inertia and shapes.
    position : tuple of float
        Its mass centre in the axes of the compound, from an origin of the user's choice [m, shape (3)].
    orientation : tuple of float
        Unit quaternion (scalar first) from the axes of the body to the axes of the compound.
    """

    body: FreeBody
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    orientation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if not isinstance(self.body, FreeBody):
            raise InvalidInput("Part.body", "must be a free body", self.body, "For example Ball(0.01).")
        check_fields(self, "position", "orientation")


@final
@dataclass(frozen=True)
class Compound(TensorBody):
    """A free body made of parts that are fixed to one another.

    Its frame has the axes in which the parts are placed, and its origin at the common mass centre.  Parts that
    overlap count twice where they do.

    Attributes
    ----------
    parts : tuple of Part
        At least one.
    """

    parts: tuple[Part, ...]

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return two balls of different size."""
        return {"parts": (Part(Ball(0.01)), Part(Ball(0.02), (0.03, 0.0, -0.01)))}

    def _check(self) -> None:
        remedy = "Give parts, for example (Part(Ball(0.01)), Part(Ball(0.02), (0.03, 0.0, 0.0)))."
        if not isinstance(self.parts, (tuple, list)) or not self.parts:
            raise InvalidInput("Compound.parts", "must be a tuple of at least one part", self.parts, remedy)
        for part in self.parts:
            if not isinstance(part, Part):
                raise InvalidInput("Compound.parts", "must contain parts only", part, remedy)
        object.__setattr__(self, "parts", tuple(self.parts))
        # moves the shapes now, so that a shape that cannot be moved is an error when the compound is made
        assert self.shapes is not None

    @functools.cached_property
    def _tensor(self) -> Vector:
        """Inertia tensor about the common mass centre [kg m^2], shape [3, 3], by the parallel-axis theorem."""
        tensor, centre = np.zeros((3, 3)), np.array(self.centre)
        for part in self.parts:
            turn, body = rotation(part.orientation), part.body
            own = tensor_of(body.inertia, body.products)
            tensor += turn @ own @ turn.T + parallel_axis(body.total_mass, np.array(part.position) - centre)
        return without_round_off(0.5 * (tensor + tensor.T), 1e-15)

    @functools.cached_property
    def shapes(self) -> tuple[Shape, ...]:
        """Shapes of all parts, in the frame of the compound."""
        centre = np.array(self.centre)
        return tuple(
            moved(shape, np.array(part.position) - centre, np.array(part.orientation))
            for part in self.parts
            for shape in part.body.shapes
        )

    @property
    def centre(self) -> tuple[float, float, float]:
        """The mass centre, from the origin in which the parts are placed [m]."""
        moment = sum((part.body.total_mass * np.array(part.position) for part in self.parts), np.zeros(3))
        x, y, z = (moment / self.total_mass).tolist()
        return x, y, z

    @property
    def total_mass(self) -> float:
        """Of all parts [kg]."""
        return sum(part.body.total_mass for part in self.parts)

    @property
    def sketch(self) -> tuple[Look, ...]:
        """Lines from part to part and back to the first, for what holds them together."""
        places = np.array([part.position for part in self.parts]) - self.centre
        return (Look.polyline(*places, places[0]),)
