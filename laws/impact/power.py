"""The force of a power of the indentation, which the impact laws of the LZB kind share."""

from __future__ import annotations

import math


def power_force(indentation: float, stiffness: float, exponent: float) -> float:
    """Return k x^eta [N], Eq. (20)."""
    if exponent == 1.5:
        # Hertz, where a square root is cheaper than a power
        return stiffness * indentation * math.sqrt(indentation)
    return float(stiffness * indentation**exponent)
