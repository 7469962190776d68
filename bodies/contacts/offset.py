"""Surfaces at a distance from a core: what spheres, capsules and other rounded bodies have in common."""

from __future__ import annotations

import math

from bodies.contacts.tangents import write_tangent
from nonsmooth.compiled import compiled
from nonsmooth.types import Floats


@compiled
def join_cores(a: Floats, out: Floats, radius_a: float, radius_b: float, nx: float, ny: float, nz: float) -> None:
    """Write gap, axes and witness points; the nearest points of the two cores stand in place of the latter.

    Cores that meet have no normal: (nx, ny, nz) is taken, and must be across both.
    """
    square = 0.0
    for i in range(3):
        square += (out[10 + i] - out[7 + i]) * (out[10 + i] - out[7 + i])
    distance = math.sqrt(square)
    out[0] = distance - radius_a - radius_b
    out[1], out[2], out[3] = nx, ny, nz
    for i in range(3):
        if distance > 0.0:
            out[1 + i] = (out[10 + i] - out[7 + i]) / distance
        out[7 + i] += radius_a * out[1 + i]
        out[10 + i] -= radius_b * out[1 + i]
    write_tangent(a, out)


@compiled
def place_sphere(a: Floats, out: Floats, x: float, y: float, z: float, distance: float, radius: float) -> None:
    """Write gap, tangent and witness points of a sphere about (x, y, z) at a distance along the normal in ``out``."""
    out[0] = distance - radius
    out[7], out[8], out[9] = x - distance * out[1], y - distance * out[2], z - distance * out[3]
    out[10], out[11], out[12] = x - radius * out[1], y - radius * out[2], z - radius * out[3]
    write_tangent(a, out)


@compiled
def gap_at_distance(gap: float, past: float, radius: float) -> float:
    """Return the gap at a distance from a core, by that of the core and the way past its end.

    Past the end a gap that is positive stays so: it is the root of the squares of the gap and of the way past the end.
    """
    if past <= 0.0 or gap <= 0.0:
        return gap - radius
    apart = math.sqrt(max(gap * gap - past * past, 0.0))
    return math.hypot(max(apart - radius, 0.0), past)
