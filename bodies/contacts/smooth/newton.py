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
def has_ended(residual: float, before: float, size: float) -> bool:
    """Return whether Newton's method ends: ``before`` is the residual of the last step, ``size`` that of the bodies."""
    return bool(residual <= ROUND_OFF * size or (residual <= CLOSE * size and residual >= 0.5 * before))


@compiled
def away_from_zero(found: float, least: float) -> float:
    """Return a determinant whose absolute value is at least ``least``, with the same sign."""
    return math.copysign(least, found) if abs(found) < least else found


@compiled
def misfit(r: float, s: float, v: float, w: float, facing: float, weight: float) -> float:
    """Return the merit function of two points: the sum of the squared residuals [m^2].

    Residuals are the components r and s of the vector between the points [m], and v and w of the second normal, times
    ``weight`` [m].  If the normals do not face each other (``facing``, their scalar product, is not negative), the
    merit is large.
    """
    apart = weight * (v * v + w * w if facing < 0.0 else 2.0 - v * v - w * w)
    return r * r + s * s + weight * apart
