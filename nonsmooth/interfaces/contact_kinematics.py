"""ContactKinematics: gap, frame, witness points and curvature of one contact between two shapes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, ClassVar

from nonsmooth.interfaces.feature_pair import CandidateSearch
from nonsmooth.interfaces.shape import Shape
from nonsmooth.parameters import Component


class ContactKinematics(Component, ABC):
    """The geometry of one potential contact; all rates and second-order terms follow from it in the engine.

    The contract:

    1. ``pair`` names the two classes of shapes, ``between`` returns the contacts of two such shapes.
    2. ``evaluator`` is a plain function ``evaluate(a, b, out, ...)``; a and b are the frame blocks of the two
       bodies, out the geometry block (:mod:`nonsmooth.engine.memory.blocks`).
    3. The normal points from the first body to the second; the gap is negative under penetration.
    4. The first tangent is fixed to the first body as far as the normal allows.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]]

    @property
    def values(self) -> Any:
        """Transitional."""
        return self.parameters()

    @classmethod
    @abstractmethod
    def between(cls, first: Shape, second: Shape) -> tuple[Any, ...]:
        """Return the potential contacts of two shapes of the classes in ``pair``."""

    @property
    def evaluator(self) -> Callable[..., None]:
        """Plain function ``evaluate(a, b, out, ...)`` that writes the geometry block of the contact: point 2 above."""
        raise NotImplementedError

    @property
    def bound(self) -> Callable[..., None] | None:
        """Plain function that tells how far the bodies must move before the contact can close; None if that is unknown.

        ``bound(a, b, out, ...)`` has the arguments of the evaluator. It writes to ``out[0]`` a distance [m]: the
        contact stays open while the largest displacements of a point of either body add up to less. Among convex
        bodies a contact is left out until they have moved that far.
        """
        return None

    @property
    def candidates(self) -> CandidateSearch | None:
        """Search that finds the pair of features of this contact; None if the pair never changes."""
        return None

    @property
    def features(self) -> tuple[str, ...]:
        """Names of the pairs of features that can touch; the geometry block holds the number of the present one."""
        raise NotImplementedError
