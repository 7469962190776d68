"""Motion: the prescribed motion of a driven body's frame."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable

from nonsmooth.parameters import Component


class Motion(Component, ABC):
    """A prescribed motion.

    The contract:

    1. ``evaluator`` is a plain function ``evaluate(t, q, u, out, ...)`` with q and u empty; it writes
       position, rotation, velocity, angular velocity and both accelerations of the frame, in the order of
       :mod:`nonsmooth.engine.memory.blocks`.
    2. Position, velocity and acceleration are derivatives of one another and continuous.
    """

    @property
    @abstractmethod
    def evaluator(self) -> Callable[..., None]:
        """The function of point 1."""

    @property
    @abstractmethod
    def time_scale(self) -> float:
        """Shortest time over which the motion changes [s]; infinite at rest."""

    @property
    def period(self) -> float | None:
        """Time after which the motion repeats [s]; None, the default, if it does not repeat."""
        return None
