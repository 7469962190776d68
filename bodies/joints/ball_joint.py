"""Ball joint: a point of one body stays on a point of the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

from .rows import AXES, JointRow, RowsJoint, on_planes


@final
@dataclass(frozen=True)
class BallJoint(RowsJoint):
    """Two points coincide; the bodies turn freely about them.

    Attributes
    ----------
    first, second : tuple of float
        The point in the frame of the first and of the second body [m], shape [3].
    """

    @property
    def rows(self) -> Sequence[JointRow]:
        """Three translations."""
        return on_planes(self.first, self.second, AXES)
