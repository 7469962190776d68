"""Surfaces at a distance from a core: what spheres, capsules and other rounded bodies have in common."""

from __future__ import annotations

import math

from bodies.blocks import put
from bodies.contacts.features.tangents import write_tangent
from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import GAP, NORMAL, POINT_A, POINT_B
from nonsmooth.types import Floats


@compiled
def join_cores(a: Floats, out: Floats, radius_a: float, radius_b: float, nx: float, ny: float, nz: float) -> None:
    """Write gap, axes and witness points; the nearest points of the two cores stand in place of the latter.

    Cores that meet have no normal: (nx, ny, nz) is taken, and must be across both.
    """
    square = 0.0
    for i in range(3):
        square += (out[POINT_B + i] - out[POINT_A + i]) * (out[POINT_B + i] - out[POINT_A + i])
    distance = math.sqrt(square)
    out[GAP] = distance - radius_a - radius_b
    put(out, NORMAL, nx, ny, nz)
    for i in range(3):
        if distance > 0.0:
            out[NORMAL + i] = (out[POINT_B + i] - out[POINT_A + i]) / distance
        out[POINT_A + i] += radius_a * out[NORMAL + i]
        out[POINT_B + i] -= radius_b * out[NORMAL + i]
    write_tangent(a, out)


@compiled
def place_sphere(a: Floats, out: Floats, x: float, y: float, z: float, distance: float, radius: float) -> None:
    """Write gap, tangent and witness points of a sphere about (x, y, z) at a distance along the normal in ``out``."""
    out[GAP] = distance - radius
    put(out, POINT_A, x - distance * out[NORMAL], y - distance * out[NORMAL + 1], z - distance * out[NORMAL + 2])
    put(out, POINT_B, x - radius * out[NORMAL], y - radius * out[NORMAL + 1], z - radius * out[NORMAL + 2])
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
