"""When the searches by Newton's method end."""

from __future__ import annotations

from nonsmooth.compiled import compiled

ROUND_OFF, CLOSE, RIGHT = 2e-16, 1e-12, 1e-13
"""Residuals of Newton's method, relative to the size of the bodies.

Below ``ROUND_OFF`` it ends.  Below ``RIGHT`` it ends once a step no longer halves the residual, which round-off limits
there.  Below ``CLOSE`` it ends once a step no longer decreases the residual.  Such a result is rejected.
"""


@compiled
def has_ended(residual: float, last_residual: float, size: float) -> bool:
    """Return whether Newton's method ends, from its residual, the one of the step before, and the size of the bodies.

    All three have the same unit.
    """
    slow = 0.5 if residual <= RIGHT * size else 1.0
    return bool(residual <= ROUND_OFF * size or (residual <= CLOSE * size and residual >= slow * last_residual))
