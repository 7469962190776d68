"""Distance of two shapes, or depth of their overlap, by the pairs of their convex pieces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nonsmooth.queries.result import PAIR, DistanceResult
from nonsmooth.solids.measure import Measured
from nonsmooth.solids.placed import Placed, measured, measured_hulls, near_pairs, nested, overlap

_ROUND_OFF = 1e-13
"""Largest overlap of two surfaces that is treated as touching, relative to their size."""
_NEARER = 1e-3
"""First distance within which pieces of surfaces are searched for beyond the distance of the hulls, relative to the
size of the shapes."""
_WIDER = 4.0
"""Factor by which that distance grows as long as no pair of pieces is within it."""
_MOST_OVERLAPS = 1000
"""Largest number of pairs of pieces of which the deepest overlap is searched for, which takes a tenth of a second."""


def distance_by_pieces(one: Placed, two: Placed) -> DistanceResult:
    """Distance of two shapes, of which at least one is bounded, with nearest points and bounds.

    Of a half-space the hull of the other shape decides. If surfaces overlap, the deepest overlap of two pieces, or the
    depth of one shape within the other, bounds the depth from below. The translation that separates the two pieces is
    the answer if it also separates the shapes. If not, the translation that separates their hulls is.
    """
    if not (one.pieces.is_bounded and two.pieces.is_bounded):
        return _result(measured_hulls(one, two))
    found, least = _of_pieces(one, two), _ROUND_OFF * _size(one, two)
    if one.pieces.surface is None and two.pieces.surface is None:
        return _result(found)
    if found.separation < -least:
        if overlap(one, two.moved(-found.separation * found.normal), least) == 0.0:
            return _result(found)
        depth = max(-found.upper, 0.0)
    else:
        depth = nested(one, two, least)
        if depth == 0.0:
            return _result(found)
    hulls = measured_hulls(one, two)
    return replace(_result(hulls), upper=max(hulls.separation, -depth))


def _result(found: Measured) -> DistanceResult:
    gap = found.separation
    return DistanceResult(gap, gap, max(gap, found.upper), found.first, found.second, found.normal, PAIR)


def _size(one: Placed, two: Placed) -> float:
    """Diagonal of the larger box of two shapes [m]."""
    return max(float(np.linalg.norm(high - low)) for low, high in (one.bounds, two.bounds))


def _span(one: Placed, two: Placed) -> float:
    """Diagonal of the box that contains two shapes [m]."""
    (low, high), (below, above) = one.bounds, two.bounds
    return float(np.linalg.norm(np.maximum(high, above) - np.minimum(low, below)))


def _of_pieces(one: Placed, two: Placed) -> Measured:
    """Least separation of all pairs of pieces of two bounded shapes.

    Only pairs are measured whose boxes are within some reach. No other pair is nearer if the separation that is found
    is within this reach, too. If not, the reach grows.
    """
    size = _size(one, two)
    are_parts = one.pieces.surface is None and two.pieces.surface is None
    if are_parts and len(one.pieces.hull) == len(two.pieces.hull) == 1:
        return measured_hulls(one, two)
    # of convex parts there are few, so that all are within reach
    reach = _span(one, two) if are_parts else max(measured_hulls(one, two).separation, 0.0) + _NEARER * size
    while True:
        best: Measured | None = None
        for number, (i, j, apart) in enumerate(near_pairs(one, two, reach)):
            # pairs whose boxes overlap may overlap deeper
            if best is not None and apart >= best.separation and (apart > 0.0 or number >= _MOST_OVERLAPS):
                break
            found = measured(one, two, i, j)
            if best is None or found.separation < best.separation:
                best = found
        if best is not None and best.separation <= reach:
            return best
        reach *= _WIDER
