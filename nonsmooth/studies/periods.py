"""Periods of motions that are sampled once a period, and whether they still settle."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nonsmooth.types import Array

_ALIKE = 1e-5
"""Part of the range of all points within which two points count as equal."""
_LEAST = 1e-3
"""Smallest range, as a part of the scale of the coordinate: a single point has no range."""


def alike(points: Array, scale: float) -> float:
    """Return the largest difference of points of a diagram that count as equal, in their unit.

    Parameters
    ----------
    points : array
        All points, nan if a run failed; any shape.
    scale : float
        Scale of the coordinate by the size of its body, in its unit.
    """
    known = points[np.isfinite(points)]
    return _ALIKE * max(float(np.ptp(known)) if len(known) else 0.0, _LEAST * scale)


def periods(points: Array, near: float) -> NDArray[np.int64]:
    """Return the least n after which all points of each motion repeat, up to half of them; 0 if none does.

    Points that are n, 2 n, 3 n ... samples apart must all agree: a motion that settles slowly does not repeat.

    Parameters
    ----------
    points : array
        Samples, shape [n_motions, n_samples, n_coordinates]; a motion with a nan does not repeat.
    near : float
        Largest difference of a coordinate of equal points.
    """
    found = np.zeros(len(points), np.int64)
    for n in range(points.shape[1] // 2, 0, -1):
        repeats = [np.all(np.ptp(points[:, first::n], axis=1) <= near, axis=1) for first in range(n)]
        found[np.all(repeats, axis=0)] = n
    return found


def settling(points: Array, near: float) -> NDArray[np.bool_]:
    """Return True for each motion that still approaches its attractor.

    Points n samples apart then differ less and less: by less than half as much in the second half of the samples, or
    always to the same side and never more.  Differences below a thousandth of ``near`` count as zero, as tolerances of
    runs cause them.  A spiral that loses less than half in half of the samples is not noticed.

    Parameters
    ----------
    points : array
        Samples, shape [n_motions, n_samples, n_coordinates]; a motion with a nan does not settle.
    near : float
        Largest difference of a coordinate of equal points.
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
