"""What the searches by Newton's method share: when they end, and the merit function of two points with normals."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled

ROUND_OFF, CLOSE, RIGHT = 2e-16, 1e-12, 1e-13
"""Residuals of Newton's method, relative to the size of the bodies.

Below ``ROUND_OFF`` it ends.  Below ``CLOSE`` it ends once a step no longer halves the residual, which round-off limits
there.  A result with a residual above ``RIGHT`` is rejected.
"""


@compiled
def has_ended(residual: float, last_residual: float, size: float) -> bool:
    """Return whether Newton's method ends, from its residual, the one of the step before, and the size of the bodies.

    All three have the same unit.
    """
    return bool(residual <= ROUND_OFF * size or (residual <= CLOSE * size and residual >= 0.5 * last_residual))


@compiled
def away_from_zero(det: float, least: float) -> float:
    """Return a determinant, with at least the absolute value ``least`` and its own sign, for a division by it."""
    return math.copysign(least, det) if abs(det) < least else det


@compiled
def misfit(r: float, s: float, v: float, w: float, facing: float, weight: float) -> float:
    """Return the merit function of two points: the sum of the squared residuals [m^2].

    Residuals are the components r and s of the vector between the points [m], and v and w of the second normal, times
    ``weight`` [m].  The vectors v, w are 0 for opposite normals and also for equal ones.  So v^2 + w^2 is replaced by
    2 - v^2 - w^2 if the normals do not face each other: ``facing``, their scalar product, is then not negative.
    """
    tilt = weight * (v * v + w * w if facing < 0.0 else 2.0 - v * v - w * w)
    return r * r + s * s + weight * tilt
