"""Where a function changes its sign: the rule of N. Anderson and A. Bjorck, BIT 13 (1973) 253-264."""

from __future__ import annotations

from nonsmooth.engine.native.kernel import kernel

TRUSTED = 2.0
"""The largest error of a step to an event, relative to the tolerance; the slip may have turned within it."""
SHORT = 1e-7
"""Corrections below this part of a step to an event are made along the tangent; their error is its square."""


@kernel("f8(f8, f8, f8)")
def weakened(kept: float, new: float, old: float) -> float:
    """Return by what value the end that stays counts, its own being ``kept``, as ``new`` takes the place of ``old``.

    The secant through it then does not stall at the end that stays.
    """
    ratio = 1.0 - new / old
    return kept * (ratio if ratio > 0.0 else 0.5)
