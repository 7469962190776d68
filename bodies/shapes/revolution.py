"""Mass properties and drawing of a frustum swept by a sphere: its profile is two arcs and the line between them."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from nonsmooth.interfaces.body import Vector

from .drawing import arc, revolved
from .frustum import AXIS, CENTER, COS, HIGH, LOW, SIDE, SIN, SWEEP
from .placement import about_axis
from .swept_solid import Integrals

_NODES = 24
"""Of Gauss' rule on every piece; the integrands are polynomials of at most the sixth order in sine and cosine."""


def swept_frustum(numbers: Sequence[float]) -> Integrals:
    """Return volume [m^3], centroid [m] and inertia at density 1 about it [m^5].

    Slice by slice across the axis: pi R^2, and R^2 / 4 of a slice's area across the axis.

    Parameters
    ----------
    numbers : sequence of float
        Those of the frustum (:func:`bodies.shapes.frustum.frustum_numbers`).
    """
    low, high, below, above, sweep = numbers[0], numbers[1], numbers[LOW], numbers[HIGH], numbers[SWEEP]
    cosine, sine = numbers[COS], numbers[SIN]
    normal = math.atan2(sine, cosine)
    pieces = [_arc(low, below, sweep, -0.5 * math.pi, normal), _arc(high, above, sweep, normal, 0.5 * math.pi)]
    if numbers[SIDE] > 0.0:
        nodes, weights = _rule(0.0, 1.0)
        rise, wide = above - below, low + sweep * cosine
        pieces.append((wide + nodes * (high - low), below + sweep * sine + nodes * rise, weights * rise))
    radii, heights, weights = (np.concatenate(part) for part in zip(*pieces, strict=True))
    areas = math.pi * radii**2 * weights
    volume = float(np.sum(areas))
    height = float(areas @ heights) / volume
    along = float(areas @ radii**2) / 2.0
    across = 0.5 * along + float(areas @ (heights - height) ** 2)
    axis = _axis(numbers)
    return volume, np.array(numbers[CENTER : CENTER + 3]) + height * np.array(axis), about_axis(axis, along, across)


def draw_swept_frustum(numbers: Sequence[float], fineness: int) -> tuple[Vector, Vector]:
    """Return vertices and triangles, meridians and parallels with arcs at the rims."""
    low, high, below, above, sweep = numbers[0], numbers[1], numbers[LOW], numbers[HIGH], numbers[SWEEP]
    normal = math.acos(min(max(numbers[SIN], -1.0), 1.0))
    lower = sweep * arc(fineness, math.pi, normal) + (low, below)
    upper = sweep * arc(fineness, normal, 0.0) + (high, above)
    # an arc of a disc begins where the other ends, and that about an apex ends on the axis
    first = 1 if numbers[SIDE] == 0.0 else 0
    last = len(upper) if high > 0.0 else len(upper) - 1
    profile = np.vstack([(0.0, below - sweep), lower, upper[first:last], (0.0, above + sweep)])
    return revolved(profile, fineness, numbers[CENTER : CENTER + 3], _axis(numbers))


def _arc(wide: float, height: float, radius: float, start: float, end: float) -> tuple[Vector, Vector, Vector]:
    """Return distances from the axis, heights and weights of the slices of an arc, by angles from across the axis."""
    angles, weights = _rule(start, end)
    cosine = np.cos(angles)
    return wide + radius * cosine, height + radius * np.sin(angles), weights * radius * cosine


def _rule(start: float, end: float) -> tuple[Vector, Vector]:
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    return start + 0.5 * (end - start) * (1.0 + nodes), 0.5 * (end - start) * weights


def _axis(numbers: Sequence[float]) -> tuple[float, float, float]:
    return numbers[AXIS], numbers[AXIS + 3], numbers[AXIS + 6]
