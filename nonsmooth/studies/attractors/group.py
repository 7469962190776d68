"""Groups of runs that go to one attractor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray


@final
@dataclass(frozen=True, eq=False)
class Group:
    """Runs that go to one attractor.

    Attributes
    ----------
    runs : array
        Numbers of the runs, shape [n_runs].
    points : array
        The attractor over the scales of its coordinates, shape [n_points, n_coordinates].
    period : int or None
        After how many periods it repeats, 0 where it does not; None where that is not known, or not the same in all.
    """

    runs: NDArray[np.int64]
    points: NDArray[np.float64]
    period: int | None
