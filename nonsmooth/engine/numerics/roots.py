"""Roots by a bracketing secant method that does not stall.

The plain secant through both bounds of a bracket may keep one bound for ever. The rule of N. Anderson and A. Bjorck,
BIT 13 (1973) 253-264, reduces the function value at that bound, and converges faster than bisection.
"""

from __future__ import annotations

from nonsmooth.engine.native.kernel import kernel

TRUSTED = 2.0
"""Largest error of a step to an event, relative to the tolerance. A longer step was accepted with an error of 1."""
SHORT = 1e-7
"""Corrections below this, relative to a step to an event, are made along the tangent. Their error is its square."""


@kernel("f8(f8, f8, f8)")
def weakened(kept: float, new: float, old: float) -> float:
    """Reduced function value at the bound of a bracket that a secant step keeps, so that it is not kept for ever.

    ``kept`` is its value now. At the other bound the value ``new``, of the same sign, replaces ``old``, which must not
    be zero. The next secant step then ends nearer to the bound that is kept.
    """
    ratio = 1.0 - new / old
    # half, if the new value is not smaller than the old one
    return kept * (ratio if ratio > 0.0 else 0.5)
