"""Search for a root between two values of opposite signs, by the secants of the Illinois method.

If the same end of the interval moves twice in succession, the value at the other end is halved.
"""

from __future__ import annotations

from typing import NamedTuple

from nonsmooth.compiled import compiled


class Bracket(NamedTuple):
    """Both ends of an interval, values of opposite signs there, and the end that moved last: 1 low, 2 high, 0 none."""

    low: float
    high: float
    at_low: float
    at_high: float
    moved: int


@compiled
def next_place(b: Bracket) -> float:
    """Return the next argument: the zero of the secant, or the middle if round-off puts it outside."""
    place = (b.low * b.at_high - b.high * b.at_low) / (b.at_high - b.at_low)
    return place if min(b.low, b.high) < place < max(b.low, b.high) else 0.5 * (b.low + b.high)


@compiled
def narrowed(b: Bracket, place: float, value: float) -> Bracket:
    """Return the part of a bracket that holds the root, from the ``value`` at the argument ``place`` inside."""
    if (value < 0.0) == (b.at_low < 0.0):
        return Bracket(place, b.high, value, 0.5 * b.at_high if b.moved == 1 else b.at_high, 1)
    return Bracket(b.low, place, 0.5 * b.at_low if b.moved == 2 else b.at_low, value, 2)
