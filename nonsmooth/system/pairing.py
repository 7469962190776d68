"""Which contact kinematics knows a pair of shapes."""

from __future__ import annotations

import math
from collections.abc import Iterable

from nonsmooth.interfaces import ContactKinematics, Shape


def nearest_pair(
    known: Iterable[type[ContactKinematics]], first: Shape, second: Shape
) -> tuple[type[ContactKinematics], bool] | None:
    """Return the kinematics of two shapes, and whether they stand in its order; None if there is none.

    A pair of base classes knows all shapes that derive from them; of several that fit, the one is taken whose classes
    are nearest to the shapes'.
    """
    best: tuple[type[ContactKinematics], bool] | None = None
    least = math.inf
    for kinematics in known:
        for in_order, one, two in ((True, first, second), (False, second, first)):
            steps = _steps(one, kinematics.pair[0]) + _steps(two, kinematics.pair[1])
            if steps < least:
                best, least = (kinematics, in_order), steps
    return best


def _steps(shape: Shape, kind: type[Shape]) -> float:
    line = type(shape).__mro__
    return line.index(kind) if kind in line else math.inf
