"""Joint: a bilateral constraint between two frames."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable

import numpy as np

from nonsmooth.interfaces.solid import Vector
from nonsmooth.parameters import Component


class Joint(Component, ABC):
    """What two frames may not do relative to each other, at all times, impacts included.

    The contract:

    1. ``evaluator`` is a plain function ``evaluate(a, b, out, ...)``; a and b are the frame blocks of the two bodies,
       out the rows of the joint (:mod:`nonsmooth.engine.memory.blocks`); its further arguments are parameters of the
       joint.
    2. Residuals vanish where the joint is closed; rates and biases are their derivatives.
    """

    @property
    @abstractmethod
    def n_rows(self) -> int:
        """Number of rows: how many degrees of freedom the joint takes."""

    @property
    @abstractmethod
    def evaluator(self) -> Callable[..., None]:
        """The function of point 1."""

    @property
    def ends(self) -> Vector:
        """Point of the joint in the frame of each body [m], shape [2, 3], for drawings; by default the two origins."""
        return np.zeros((2, 3))
