"""Roots by a bracketing secant method that does not stall.

The plain secant through both ends of a bracket may keep one end for ever. The rule of N. Anderson and A. Bjorck, BIT 13
(1973) 253-264, reduces the value of that end, and converges faster than bisection.
"""

from __future__ import annotations

from nonsmooth.engine.native.kernel import kernel

TRUSTED = 2.0
"""Largest error of a step to an event, relative to the tolerance. The slip may have turned within it."""
SHORT = 1e-7
"""Corrections below this, relative to a step to an event, are made along the tangent. Their error is its square."""


@kernel("f8(f8, f8, f8)")
def weakened(kept: float, new: float, old: float) -> float:
    """Reduced value of the end that stays, whose value is ``kept``, when ``new`` replaces ``old`` at the other end."""
    ratio = 1.0 - new / old
    return kept * (ratio if ratio > 0.0 else 0.5)
