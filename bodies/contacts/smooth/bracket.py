"""Search for a root between two values of opposite signs: secants, and halvings if the secants are slow.

The secant is that of the Illinois method: if the same end of the interval moves twice in succession, the value at the
other end is halved.
"""

from __future__ import annotations

from typing import TypeAlias

from nonsmooth.compiled import compiled

_MOST_SLOW_STEPS = 3
"""Largest number of successive secant steps that each leave more than half of the interval; a halving follows."""
Bracket: TypeAlias = tuple[float, float, float, float, int, int]
"""Both ends of the interval, values there, the end that moved last (1 low, 2 high, 0 none), number of slow steps."""


@compiled
def bracket(low: float, high: float, at_low: float, at_high: float) -> Bracket:
    """Return the bracket with which a search starts: both ends of the interval, and values of opposite signs there."""
    return low, high, at_low, at_high, 0, 0


@compiled
def next_place(b: Bracket) -> tuple[float, Bracket]:
    """Return the argument of the next evaluation, and the bracket.

    It is the zero of the secant.  After ``_MOST_SLOW_STEPS`` slow steps, or if round-off puts the zero outside, it is
    the middle of the interval; the number of slow steps is then 0 again.
    """
    low, high, at_low, at_high, moved, slow = b
    middle = (low * at_high - high * at_low) / (at_high - at_low)
    if slow >= _MOST_SLOW_STEPS or not (min(low, high) < middle < max(low, high)):
        return 0.5 * (low + high), (low, high, at_low, at_high, moved, 0)
    return middle, b


@compiled
def narrowed(b: Bracket, middle: float, value: float) -> Bracket:
    """Return the part of a bracket that holds the root, from the ``value`` at the argument ``middle`` inside.

    If the same end moves twice in succession, the value at the other end is halved (Illinois method).
    """
    low, high, at_low, at_high, moved, slow = b
    width = abs(high - low)
    if (value < 0.0) == (at_low < 0.0):
        low, at_low, at_high, moved = middle, value, 0.5 * at_high if moved == 1 else at_high, 1
    else:
        high, at_high, at_low, moved = middle, value, 0.5 * at_low if moved == 2 else at_low, 2
    return low, high, at_low, at_high, moved, slow + 1 if abs(high - low) > 0.5 * width else 0
