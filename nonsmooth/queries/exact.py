"""The contacts of two shapes, called from Python: their least gap of features that face each other."""

from __future__ import annotations

from typing import final

import numpy as np

from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.distance_backend import Place
from nonsmooth.interfaces.solid import Vector
from nonsmooth.model.layout import FRAME, GEOMETRY, PAST_END
from nonsmooth.plugins import registry
from nonsmooth.plugins.call import pair_caller
from nonsmooth.queries.result import EXACT, DistanceResult
from nonsmooth.system.pairing import nearest_pair


@final
class Contacts:
    """All contacts of two shapes, by the kinematics that is installed for them, compiled.

    Parameters
    ----------
    first, second : Shape
        The shapes, in any order.

    Raises
    ------
    LookupError
        If no kinematics is known for them.
    InvalidInput
        If the kinematics refuses them, as meshes with too many features.
    """

    def __init__(self, first: Shape, second: Shape) -> None:
        found = nearest_pair(registry.load_all("kinematics").values(), first, second)
        if found is None:
            raise LookupError(f"{type(first).__name__}-{type(second).__name__}")
        kinematics, self._in_order = found
        contacts = kinematics.between(*((first, second) if self._in_order else (second, first)))
        self._calls = [pair_caller(one.evaluator, one.parameters(), type(one).__name__) for one in contacts]

    def least(self, one: Place, two: Place) -> DistanceResult | None:
        """Return the least gap that faces, None if none does; bounds are its own value, as nobody has proved it."""
        a, b, out = np.zeros(FRAME), np.zeros(FRAME), np.zeros(GEOMETRY)
        for block, (position, axes) in zip((a, b), (one, two) if self._in_order else (two, one), strict=True):
            block[:3], block[3:12] = position, axes.ravel()
        best: Vector | None = None
        for call in self._calls:
            out[:] = 0.0
            call(a, b, out)
            # a gap that is no number is none
            if out[PAST_END] <= 0.0 and (out[0] < best[0] if best is not None else out[0] == out[0]):
                best = out.copy()
        if best is None:
            return None
        gap = float(best[0])
        found = DistanceResult(gap, gap, gap, best[7:10], best[10:13], best[1:4], EXACT)
        return found if self._in_order else found.exchanged()
