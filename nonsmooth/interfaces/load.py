"""Load: a force and a moment between two frames."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable

import numpy as np

from nonsmooth.interfaces.solid import Vector
from nonsmooth.parameters import Component


class Load(Component, ABC):
    """An applied force: a spring, a damper, drag, a drive.

    The contract:

    1. ``evaluator`` is a plain function ``evaluate(t, a, b, out, ...)`` of time [s] and the frame blocks of the two
       bodies that writes force, point and moment (:mod:`nonsmooth.engine.memory.blocks`); its further arguments are
       parameters of the load.
    2. It is smooth in its arguments; the first body gets the opposite.
    3. ``depends_on_time`` is false only if the function does not use the time: force and moment then follow from the
       motion of the two bodies alone, and are constant while both bodies rest.
    """

    @property
    @abstractmethod
    def evaluator(self) -> Callable[..., None]:
        """The function of point 1."""

    @property
    def depends_on_time(self) -> bool:
        """Whether force and moment depend on time other than through the motion of the bodies; yes by default."""
        return True

    @property
    def ends(self) -> Vector:
        """Where it acts, each point in the frame of its body [m], shape [2, 3], to be drawn; the origins by default."""
        return np.zeros((2, 3))
