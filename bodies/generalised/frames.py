"""Frames of a body in generalised coordinates: points of it, or rigid parts that turn."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from nonsmooth.engine.memory.blocks import ROTATION
from nonsmooth.interfaces import Shape
from nonsmooth.types import Floats

from ..values import check_carried

Function = Callable[..., None]


@dataclass(frozen=True)
class MovingFrame(ABC):
    """A frame and the shapes that it carries.

    The contract:

    1. ``pose``, ``jacobian`` and ``bias`` are plain functions ``(q, out, ...)``, ``(q, out, ...)`` and
       ``(q, u, out, ...)`` whose further arguments are constants of the body.
    2. ``jacobian`` writes :attr:`n_rows` rows of n numbers each, ``bias`` the rates of (jacobian u) while u' = 0.
    """

    pose: Function
    jacobian: Function
    bias: Function
    carried: tuple[Shape, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "carried", check_carried(f"{type(self).__name__}.carried", self.carried))

    @property
    @abstractmethod
    def n_pose(self) -> int:
        """How many numbers ``pose`` writes."""

    @property
    @abstractmethod
    def n_rows(self) -> int:
        """How many rows ``jacobian`` writes, and how many numbers ``bias``."""

    @property
    @abstractmethod
    def head(self) -> Function:
        """``head(out)`` writes what ``pose`` leaves out of the pose."""


def _world_axes(out: Floats) -> None:
    for i in range(3):
        out[ROTATION + 4 * i] = 1.0


def _nothing(out: Floats) -> None:
    pass


@final
@dataclass(frozen=True)
class PointFrame(MovingFrame):
    """A point of a mechanism; the axes of its frame stay those of the world.

    Attributes
    ----------
    pose : callable
        ``position(q, out, ...)`` writes the position [m, 3].
    jacobian : callable
        ``jacobian(q, out, ...)`` writes the Jacobian of the velocity, row by row [3 n].
    bias : callable
        ``bias(q, u, out, ...)`` writes the acceleration while u' = 0, J' u [m/s^2, 3].
    carried : tuple of Shape
        Its shapes, as a rule one ``Point()``.
    """

    @property
    def n_pose(self) -> int:
        """Three coordinates."""
        return 3

    @property
    def n_rows(self) -> int:
        """Three velocities."""
        return 3

    @property
    def head(self) -> Function:
        """The axes of the world."""
        return _world_axes


@final
@dataclass(frozen=True)
class TurningFrame(MovingFrame):
    """A rigid part of a mechanism, a link or a slider, that carries shapes in its own axes.

    Attributes
    ----------
    pose : callable
        ``pose(q, out, ...)`` writes the position [m, 3], then the axes of the part as columns, row by row [9].
    jacobian : callable
        ``jacobian(q, out, ...)`` writes the Jacobian of the velocity, then that of the angular velocity in world
        axes, row by row [6 n].
    bias : callable
        ``bias(q, u, out, ...)`` writes acceleration and angular acceleration while u' = 0 [m/s^2 and rad/s^2, 6].
    carried : tuple of Shape
        Its shapes.
    """

    @property
    def n_pose(self) -> int:
        """Three coordinates and nine of the rotation."""
        return 12

    @property
    def n_rows(self) -> int:
        """Three velocities and three angular velocities."""
        return 6

    @property
    def head(self) -> Function:
        """Nothing is left."""
        return _nothing
