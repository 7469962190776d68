"""Tolerances of gaps, velocities and times, and their multiples, by which the engine judges what is zero.

The default tolerances are relative to the smallest body, with its size L, the typical acceleration a, the speed
sqrt(a L) and the time sqrt(L / a). Bodies of more than about a millimetre on Earth have the largest tolerances.
"""

from __future__ import annotations

GAP, RELATIVE_GAP = 1e-12, 1e-9
"""Largest default tolerance of gaps [m], and the same relative to L."""
LARGEST_RELATIVE_GAP = 1e-7
"""Largest tolerance of gaps that a user may give, relative to L. With more, cubes collide flush at wrong points."""
VELOCITY, RELATIVE_VELOCITY = 2e-8, 2e-7
"""Largest default tolerance of velocities [m/s], and the same relative to sqrt(a L)."""
TIME, RELATIVE_TIME = 1e-12, 1e-10
"""Largest default tolerance of times [s], and the same relative to sqrt(L / a)."""
SPACING = 4.0 * 2.0**-52
"""Least difference of two times or lengths, relative to them: a smaller difference is round-off."""
ALLOWED = 1e3
"""Largest accumulated error that is allowed, in tolerances. Steps and events within their tolerances add up to less."""
NEGLIGIBLE = 1.0 / ALLOWED
"""Gap, rate, time or residual that counts as zero, in tolerances. ``ALLOWED`` of them add up to one tolerance."""
ADJACENT = 10.0
"""Gap and rate of surfaces that are next to each other at rest, in tolerances."""
