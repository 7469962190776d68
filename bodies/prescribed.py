"""Prescribed bodies: what all bodies without coordinates have in common."""

from __future__ import annotations

from abc import ABC
from dataclasses import dataclass
from typing import Any

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body
from nonsmooth.interfaces.body import NamesAndUnits, Vector


@dataclass(frozen=True)
class Prescribed(Body, ABC):
    """A body without coordinates: where it is does not depend on what touches it."""

    @property
    def q_labels(self) -> NamesAndUnits:
        """0: driven."""
        return ()

    @property
    def u_labels(self) -> NamesAndUnits:
        """0: driven."""
        return ()

    @property
    def quaternion(self) -> int:
        """None."""
        return -1

    @property
    def scales(self) -> tuple[Vector, Vector]:
        """Empty."""
        return np.zeros(0), np.zeros(0)

    def state(self, **start: Any) -> tuple[Vector, Vector]:
        """Return empty vectors; a driven body cannot be placed."""
        if start:
            raise InvalidInput(
                f"start of a {type(self).__name__}",
                "must not be given",
                sorted(start),
                "Its motion, or its position, says where it is at t = 0.",
            )
        return np.zeros(0), np.zeros(0)
