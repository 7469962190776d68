"""Fixed joint: two bodies become one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

from nonsmooth.vectors import unit_vector

from ..values import turned_back
from .rows import AXES, JointRow, RowsJoint, on_planes, parallel_axes


@final
@dataclass(frozen=True)
class Fixed(RowsJoint):
    """Two points coincide and nothing turns.

    Attributes
    ----------
    first, second : tuple of float
        The point in the frame of the first and of the second body [m], shape [3].
    orientation : tuple of float
        Unit quaternion (scalar first) of the second frame as seen from the first, shape [4].
    """

    orientation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)

    @property
    def rows(self) -> Sequence[JointRow]:
        """Rows that prevent all rotations and all translations."""
        quaternion = unit_vector("Fixed.orientation", self.orientation, 4)
        x, y, z = AXES
        turns = parallel_axes(AXES, [turned_back(quaternion, axis) for axis in AXES])
        return *turns, *on_planes(self.first, self.second, (y, z, x))
