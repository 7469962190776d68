"""Number of periods after which a sampled motion repeats, and a test whether it still approaches its attractor."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nonsmooth.types import Array

_ALIKE = 1e-5
"""Largest difference of points that are taken as equal, relative to the range of all points of a diagram."""
_LEAST = 1e-3
"""Least range used for this difference, relative to the scale of the coordinate: if all points are equal, their range
is 0 and round-off would exceed the allowed difference."""


def alike(points: Array, scale: float) -> float:
    """Return the tolerance within which two points of a diagram are equal, in the unit of the coordinate.

    Parameters
    ----------
    points : array
        All points, nan if a run failed; any shape.
    scale : float
        Scale of the coordinate, from the size of its body, in the unit of the coordinate.
    """
    known = points[np.isfinite(points)]
    return _ALIKE * max(float(np.ptp(known)) if len(known) else 0.0, _LEAST * scale)


def periods(points: Array, near: float) -> NDArray[np.int64]:
    """Return, for each motion, the least n such that its samples repeat after n samples; 0 if they do not repeat.

    n is at most half the number of samples of a motion.

    Points that are n, 2 n, 3 n ... samples apart must all agree: a motion that settles slowly does not repeat.

    Parameters
    ----------
    points : array
        Samples, shape [n_motions, n_samples, n_coordinates]; a motion with a nan does not repeat.
    near : float
        Largest difference of points that are taken as equal, in each coordinate.
    """
    found = np.zeros(len(points), np.int64)
    for n in range(points.shape[1] // 2, 0, -1):
        repeats = [np.all(np.ptp(points[:, first::n], axis=1) <= near, axis=1) for first in range(n)]
        found[np.all(repeats, axis=0)] = n
    return found


def settling(points: Array, near: float) -> NDArray[np.bool_]:
    """Return True for each motion that still approaches its attractor.

    The differences of samples n apart are compared, with n from :func:`periods`, or n = 1 to 4 if the motion does not
    repeat.  The motion still approaches its attractor if the largest difference in the second half of the samples is
    less than half of the largest difference in the first half.  It also does so if the differences keep their sign and
    never grow.  Differences below a thousandth of ``near`` count as zero, because errors of runs cause them.  A spiral
    that loses less than half of its size in half of the samples is not noticed.

    Parameters
    ----------
    points : array
        Samples, shape [n_motions, n_samples, n_coordinates]; a motion with a nan gives False.
    near : float
        Largest difference of points that are taken as equal, in each coordinate.
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
            # a row holds the successive differences of one coordinate at one phase. In a drift, the differences of
            # every row keep their sign and never grow; in chaos, or by rounding, some of them grow or change sign
            rows = [change[k::n, j] for k in range(n) for j in range(one.shape[1])]
            drifts = all(np.all(row * row[0] >= 0.0) and np.all(np.diff(np.abs(row)) <= 0.0) for row in rows)
            found[i] |= early > 1e-3 * near and (late < 0.5 * early or drifts)
    return found
