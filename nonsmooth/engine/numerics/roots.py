"""Where a function changes its sign: the rule of N. Anderson and A. Bjorck, BIT 13 (1973) 253-264."""

from __future__ import annotations

from nonsmooth.engine.native.kernel import kernel


@kernel("f8(f8, f8, f8)")
def weakened(kept: float, new: float, old: float) -> float:
    """Return by what value the end that stays counts, its own being ``kept``, as ``new`` takes the place of ``old``.

    The secant through it then does not stall at the end that stays.
    """
    ratio = 1.0 - new / old
    return kept * (ratio if ratio > 0.0 else 0.5)
