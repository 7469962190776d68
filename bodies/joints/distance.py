"""Distance joint: a massless rod between two points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

from nonsmooth.parameters import parameter

from .rows import JointRow, RowKind, RowsJoint


@final
@dataclass(frozen=True)
class Distance(RowsJoint):
    """Two points keep their distance.

    Attributes
    ----------
    first, second : tuple of float
        The point in the frame of the first and of the second body [m], shape [3].
    """

    length: float = parameter(1.0, doc="distance of the points", unit="m", above=0.0, usual=(1e-4, 1e3))

    @property
    def rows(self) -> Sequence[JointRow]:
        """One translation."""
        return (JointRow(RowKind.AT_DISTANCE, self.first, self.second, (self.length, 0.0, 0.0)),)
