"""After how many looks a motion repeats that is looked at once a period."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def periods(points: NDArray[np.float64], near: float) -> NDArray[np.int64]:
    """Return of each motion the least n after which all its points repeat, up to half of them; 0 where none does.

    Points that are n, 2 n, 3 n ... looks apart must all agree: what only settles slowly does not repeat.

    Parameters
    ----------
    points : array
        What it was, look by look, shape [n_motions, n_looks, n_coordinates]; one with a nan does not repeat.
    near : float
        Greatest difference of a coordinate within which points count as one.
    """
    found = np.zeros(len(points), np.int64)
    for n in range(points.shape[1] // 2, 0, -1):
        repeats = [np.all(np.ptp(points[:, first::n], axis=1) <= near, axis=1) for first in range(n)]
        found[np.all(repeats, axis=0)] = n
    return found
