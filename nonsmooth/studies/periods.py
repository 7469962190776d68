"""After how many looks a motion repeats that is looked at once a period."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nonsmooth.types import Array

_ALIKE = 1e-5
"""Part of the range of all points within which two count as one."""
_LEAST = 1e-3
"""Part of the scale of a coordinate that counts as the range where that is less: of one point only there is none."""


def alike(points: Array, scale: float) -> float:
    """Return the greatest difference within which points of a diagram count as one, in their unit.

    Parameters
    ----------
    points : array
        All of them, nan where a run failed; any shape.
    scale : float
        Of the coordinate, by the size of its body, in its unit.
    """
    known = points[np.isfinite(points)]
    return _ALIKE * max(float(np.ptp(known)) if len(known) else 0.0, _LEAST * scale)


def periods(points: Array, near: float) -> NDArray[np.int64]:
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


def settling(points: Array, near: float) -> NDArray[np.bool_]:
    """Return whether each motion still approaches what it settles to.

    Points n looks apart then differ less and less: by less than half as much in the second half of the looks, or always
    to the same side and never more.  Differences below a thousandth of ``near`` count as none: tolerances of runs leave
    as much.  A spiral that loses less than half in half of the looks is not noticed.

    Parameters
    ----------
    points : array
        What it was, look by look, shape [n_motions, n_looks, n_coordinates]; one with a nan does not settle.
    near : float
        Greatest difference of a coordinate within which points count as one.
    """
    found, repeats = np.zeros(len(points), np.bool_), periods(points, near)
    for i, one in enumerate(points):
        tried = (int(repeats[i]),) if repeats[i] else (1, 2, 3, 4)
        for n in tried:
            change = one[n:] - one[:-n]
            half = len(change) // 2
            if half < 2 * n or not np.isfinite(change).all():
                continue
            early, late = (float(np.max(np.abs(part))) for part in (change[:half], change[half:]))
            # rounding and chaos change the side or the size
            rows = [change[k::n, j] for k in range(n) for j in range(one.shape[1])]
            drifts = all(np.all(row * row[0] >= 0.0) and np.all(np.diff(np.abs(row)) <= 0.0) for row in rows)
            found[i] |= early > 1e-3 * near and (late < 0.5 * early or drifts)
    return found
