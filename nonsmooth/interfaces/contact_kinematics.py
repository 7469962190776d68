"""ContactKinematics: the potential contacts of two shapes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar

from nonsmooth.interfaces.feature_pair import FeaturePair
from nonsmooth.interfaces.shape import Shape


class ContactKinematics(ABC):
    """Factory of the potential contacts of two shapes. The class itself is used, without an instance.

    The contract:

    1. ``pair`` names the two classes of shapes, ``between`` returns the contacts of two such shapes.
    2. The ``evaluator`` of each contact writes its geometry block.  All rates and second-order terms follow from this
       block in the engine.
    3. The normal points from the first body to the second; the gap is negative under penetration.
    4. The first tangent is fixed to the first body as far as the normal allows.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]]

    @classmethod
    @abstractmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the potential contacts of two shapes of the classes in ``pair``."""

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Shapes "first" and "second" with which ``nonsmooth check`` tries the class; by default their own examples."""
        return {}
