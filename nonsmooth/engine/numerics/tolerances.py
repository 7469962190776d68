"""Multiples of the tolerances of gaps, velocities, times and steps, by which the engine judges what is zero."""

from __future__ import annotations

ALLOWED = 1e3
"""Largest accumulated error that is allowed, in tolerances. Steps and events within their tolerances add up to less."""
NEGLIGIBLE = 1.0 / ALLOWED
"""Gap, rate, time or residual that counts as zero, in tolerances. ``ALLOWED`` of them add up to one tolerance."""
ADJACENT = 10.0
"""Gap and rate of surfaces that are next to each other at rest, in tolerances."""
