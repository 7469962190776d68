"""Distance of two solids, or depth of their overlap, with lower and upper bounds from planes that separate them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from nonsmooth.interfaces.solid import Piece, Vector
from nonsmooth.queries.result import PLANES, DistanceResult
from nonsmooth.solids.overlap import Penetration, penetration
from nonsmooth.solids.placed import Placed, overlap
from nonsmooth.solids.separation import nearest

_CLOSE, _ROUND_OFF = 1e-13, 1e-14
"""Allowed error of nearest points, and largest overlap that is treated as touching; both relative to the size
of the two solids."""
_SAME = 1e-9
"""Tolerance, relative to the size of the two solids, within which the result of a contact is accepted.  It limits the
difference of the contact's gap from the gap between two planes normal to the contact's normal.  It also limits the
difference between the vector that joins the contact's nearest points and the gap times the normal."""
_MOST_PAIRS = 4_000_000


class TooManyPieces(Exception):
    """There are too many pairs of pieces to check them one by one; the argument is their number."""


def whole(solid: Placed) -> Piece:
    """Convex hull of a solid."""
    return Piece(solid.support, np.mean(solid.bounds, axis=0) if solid.solid.hollow else _only(solid).place)


def by_planes(one: Placed, two: Placed) -> DistanceResult:
    """Distance of two solids, or minus the depth of their overlap [m], with nearest points and bounds.

    The lower and the upper bound of the distance or depth come from planes that separate or touch the solids.

    Raises
    ------
    TooManyPieces
        If the solids have so many pieces that the query would take minutes.
    """
    if not (one.solid.hollow or two.solid.hollow):
        return _of_convex(_only(one), _only(two), _size(one, two))
    found = deep(one, two)
    return found if found is not None else _of_pieces(one, two)


def deep(one: Placed, two: Placed) -> DistanceResult | None:
    """Overlap of two solids that need not be convex; None if they do not overlap.

    A translation that separates their convex hulls separates the solids, and so bounds the depth from above. The
    overlap of two pieces, or the depth of one solid within the other one, bounds it from below.
    """
    size = _size(one, two)
    way = _middle(two) - _middle(one)
    away = float(np.linalg.norm(way))
    normal = way / away if away > 0.0 else np.array([0.0, 0.0, 1.0])
    least = overlap(one, two, _ROUND_OFF * size, normal)
    if least == 0.0:
        return None
    found = _depth(whole(one), whole(two), size)
    if found is None or found.upper < least:
        point = 0.5 * (_middle(one) + _middle(two))
        return DistanceResult(-least, -2.0 * size, -least, point, point, normal, PLANES)
    return replace(_overlapping(found), upper=-least)


def proved(found: DistanceResult, one: Placed, two: Placed) -> DistanceResult | None:
    """Add bounds to ``found``, the distance of two convex solids by contacts; None if ``found`` fails a check.

    The first check: the two planes that touch the solids and are normal to the contact's normal must be the gap apart.
    If the solids overlap, a second check follows: the search for the depth must find no translation that separates the
    solids and is shorter than the depth by contacts.
    """
    tolerance = _SAME * _size(one, two) + one.solid.set_back + two.solid.set_back
    n, gap = found.normal, found.gap
    off = max(abs(float(n @ n) - 1.0) * _size(one, two), float(np.max(np.abs(found.second - found.first - gap * n))))
    between = float(n @ (two.support(-n) - one.support(n)))
    if not (off <= tolerance and abs(between - gap) <= tolerance):
        return None
    if gap > 0.0:
        return replace(found, lower=min(between, gap), upper=max(between, gap))
    out = _depth(_only(one), _only(two), _size(one, two))
    if out is None:
        return replace(found, lower=min(between, gap), upper=0.0) if gap >= -tolerance else None
    if -gap > out.upper + tolerance:
        return None
    return replace(found, lower=min(between, gap), upper=max(gap, -out.lower))


def _only(solid: Placed) -> Piece:
    return solid.pieces(*solid.bounds)[0]


def _middle(solid: Placed) -> Vector:
    return np.asarray(np.mean(solid.bounds, axis=0))


def _size(one: Placed, two: Placed) -> float:
    return max(float(np.linalg.norm(high - low)) for low, high in (one.bounds, two.bounds))


def _depth(one: Piece, two: Piece, size: float) -> Penetration | None:
    return penetration(one, two, _ROUND_OFF * size)


def _of_convex(one: Piece, two: Piece, size: float) -> DistanceResult:
    found = nearest(one, two, _CLOSE * size)
    if found.lower <= _ROUND_OFF * size:
        out = _depth(one, two, size)
        if out is not None:
            return _overlapping(out)
    upper = float(np.linalg.norm(found.second - found.first))
    return DistanceResult(upper, min(found.lower, upper), upper, found.first, found.second, found.normal, PLANES)


def _overlapping(out: Penetration) -> DistanceResult:
    return DistanceResult(-out.upper, -out.upper, -out.lower, out.first, out.second, out.normal, PLANES)


def _of_pieces(one: Placed, two: Placed) -> DistanceResult:
    """Distance of two solids that do not overlap: the least distance of their convex pieces.

    The pairs of pieces are evaluated in the order of the distances of their bounding boxes, until no other pair can be
    nearer.
    """
    way = _middle(two) - _middle(one)
    reach = float(np.linalg.norm(two.support(-way) - one.support(way))) if np.any(way) else _size(one, two)
    (low, high), (below, above) = one.bounds, two.bounds
    first, second = one.pieces(below - reach, above + reach), two.pieces(low - reach, high + reach)
    if len(first) * len(second) > _MOST_PAIRS:
        raise TooManyPieces(len(first) * len(second))
    (low, high), (below, above) = _boxes(first), _boxes(second)
    between = np.maximum(np.maximum(below[None] - high[:, None], low[:, None] - above[None]), 0.0)
    apart = np.linalg.norm(between, axis=2).ravel()
    best: DistanceResult | None = None
    for number in np.argsort(apart, kind="stable").tolist():
        if best is not None and apart[number] >= best.gap:
            break
        i, j = divmod(number, len(second))
        found = _of_convex(first[i], second[j], _size(one, two))
        if best is None or found.gap < best.gap:
            best = found
    assert best is not None
    return best


def _boxes(pieces: Sequence[Piece]) -> tuple[Vector, Vector]:
    low, high = (
        np.array([[piece.support(sign * axis)[i] for i, axis in enumerate(np.eye(3))] for piece in pieces])
        for sign in (-1.0, 1.0)
    )
    return low, high
