"""Sides: which body of a contact arrows are drawn for."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nonsmooth.system.system import System


def sides(system: System) -> NDArray[np.float64]:
    """Return for each contact 1, or -1 where only its first body moves: arrows show what bodies that move get."""
    return np.array([-1.0 if c.second.n_u == 0 < c.first.n_u else 1.0 for c in system.contacts])
