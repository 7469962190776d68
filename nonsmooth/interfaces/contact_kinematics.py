"""ContactKinematics: gap, frame, witness points and curvature of one contact between two shapes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import ClassVar

from nonsmooth.interfaces.shape import Shape
from nonsmooth.parameters import Component


class ContactKinematics(Component, ABC):
    """The geometry of one potential contact; all rates and second-order terms follow from it in the engine.

    The contract:

    1. ``pair`` names the two classes of shapes, ``between`` returns the contacts of two such shapes.
    2. ``evaluator`` is a plain function ``evaluate(a, b, out, ...)``; a and b are the frame blocks of the two
       bodies, out the geometry block (:mod:`nonsmooth.model.layout`).
    3. The normal points from the first body to the second; the gap is negative under penetration.
    4. The first tangent is fixed to the first body as far as the normal allows.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]]

    @classmethod
    @abstractmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the potential contacts of two shapes of the classes in ``pair``."""

    @property
    @abstractmethod
    def evaluator(self) -> Callable[..., None]:
        """The function of point 2."""

    @property
    @abstractmethod
    def features(self) -> tuple[str, ...]:
        """Names of the pairs of features that can touch; the geometry block holds the number of the present one."""
