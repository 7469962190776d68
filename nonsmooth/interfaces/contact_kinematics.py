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
    """A search for the features of two shapes that may be near each other, where they are too many for a contact each.

    Its contacts are those of one ``between`` whose ``candidates`` it is, one after the other; their evaluators take
    what was found as the vector ``candidate``: three numbers, the first of them 0 where they hold no features, and how
    far these may come from each other until they are looked for again [m].

    Attributes
    ----------
    function : callable
        A plain function ``find(a, b, out, ...)`` of the frame blocks of the bodies.  ``out[0]`` is a distance [m]; it
        writes there how many pairs of features may be no farther from each other, and behind it three numbers of each,
        the first of which is not 0, of one more than there are contacts at most.
    values : mapping
        Its parameters.
    counts : mapping
        For each first number that it writes, how many there are of the second and of the third, whole numbers from 0:
        what a file says that was found has to be among these.
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
        """The function of point 2."""

    @property
    def candidates(self) -> CandidateSearch | None:
        """The search that tells which features this contact is of at present; None if they are given."""
        return None

    @property
    @abstractmethod
    def features(self) -> tuple[str, ...]:
        """Names of the pairs of features that can touch; the geometry block holds the number of the present one."""
