"""ContactKinematics: gap, frame, witness points and curvature of one contact between two shapes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.interfaces.shape import Shape
from nonsmooth.parameters import Component, Value


@final
@dataclass(frozen=True, eq=False)
class CandidateSearch:
    """Search for pairs of near features of two shapes, if the pairs are too many for a contact each.

    The search serves all contacts that one call of ``between`` returns.  Each contact gets one pair as the argument
    ``candidate`` of its evaluator.  This vector has four numbers.  Three describe the pair; the first of them is 0
    without a pair.  The fourth is the largest distance [m] that the features may move relative to each other before the
    next search.

    Attributes
    ----------
    function : callable
        A plain function ``find(a, b, out, ...)`` of the frame blocks of the bodies.  On entry, ``out[0]`` is a distance
        [m].  The function writes to ``out[0]`` the number of pairs of features that may be within this distance.  From
        ``out[1]`` on it writes three numbers for each pair.  It writes at most one pair more than there are contacts:
        this pair shows that the contacts are too few.  The first number of a pair is not 0.
    values : mapping
        Parameters of the function by name.
    counts : mapping
        First number of a pair -> (m, n): the second number of the pair is an integer from 0 to m - 1, the third one an
        integer from 0 to n - 1.  Pairs that are read from a file are checked by these limits.
    """

    function: Callable[..., None]
    values: Mapping[str, Value]
    counts: Mapping[float, tuple[int, int]]


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

    @classmethod
    @abstractmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the potential contacts of two shapes of the classes in ``pair``."""

    @property
    @abstractmethod
    def evaluator(self) -> Callable[..., None]:
        """Plain function ``evaluate(a, b, out, ...)`` that writes the geometry block of the contact: point 2 above."""

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
    @abstractmethod
    def features(self) -> tuple[str, ...]:
        """Names of the pairs of features that can touch; the geometry block holds the number of the present one."""
