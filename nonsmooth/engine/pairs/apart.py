"""Which pairs of shapes are apart: the contacts of such a pair are neither listed nor evaluated.

Two convex parts are apart if some direction separates them. That direction and the separation along it are known of
each pair. The separation shrinks by no more than the parts move, so a pair is evaluated again only when its parts have
moved that far. The contacts of a pair of shapes are listed once two of its parts touch within the tolerances, and as
long as one of its contacts is closed.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.support import known_direction, separation_along, store_direction
from nonsmooth.engine.memory.layout import NO_PAIR
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Pair, Workspace, kernel
from nonsmooth.engine.numerics.tolerances import ADJACENT, ALLOWED
from nonsmooth.engine.numerics.vectors import are_alike, opposite
from nonsmooth.engine.pairs.overlaps import add_displacements, displacement_bound, known_separation
from nonsmooth.engine.pairs.separation import accurate_direction


@kernel("b1(ws, i8)")
def find_apart(ws: Workspace, touching: int) -> bool:
    """Find the pairs of shapes that are apart. True if the contacts to list have changed. Bodies must be evaluated.

    The pair ``touching`` is not apart, or ``NO_PAIR``: one of its contacts has an event.
    """
    add_displacements(ws)
    mark_closed(ws)
    has_changed = False
    for pair in ws.pairs:
        group = ws.pairs[pair.group]
        if not group.is_guarded:
            continue
        if pair.index == pair.group:
            group.is_near = group.is_closed or pair.index == touching
        if not group.is_near:
            group.is_near = _is_near(ws, pair)
        is_last = pair.index + 1 == ws.model.n_pairs or ws.pairs[pair.index + 1].group != pair.group
        if is_last and group.is_apart == group.is_near:
            group.is_apart, has_changed = not group.is_near, True
    return has_changed


@kernel()
def mark_closed(ws: Workspace) -> None:
    """Mark the pairs of shapes that have a closed contact."""
    for pair in ws.pairs:
        pair.is_closed = False
    for contact in ws.contacts:
        if contact.mode != Mode.OPEN and contact.pair != NO_PAIR:
            ws.pairs[contact.pair].is_closed = True


@kernel("f8(ws, Pair)")
def budget(ws: Workspace, pair: Pair) -> float:
    """Displacement of both parts together before they may meet [m], negative if the pair must be evaluated again."""
    # the margin of the overlap check includes the allowed overlap
    return float(pair.margin - pair.allowed - pair.clearance - displacement_bound(ws, pair))


@kernel("b1(ws, Pair)")
def _is_near(ws: Workspace, pair: Pair) -> bool:
    """True if two parts touch within the tolerances. Evaluates the pair if it is due."""
    enough = ADJACENT * ws.tolerance.gap
    if budget(ws, pair) > enough:
        return False
    return renewed_separation(ws, pair) <= enough + pair.clearance


@kernel("f8(ws, Pair)")
def renewed_separation(ws: Workspace, pair: Pair) -> float:
    """Lower bound of the separation of two parts [m], after a search if that is necessary. Writes the margin."""
    found = known_separation(ws, pair.index)
    if found <= ADJACENT * ws.tolerance.gap + pair.clearance:
        found = renew_direction(ws, pair)
    # the overlap check of discs without thickness needs each position
    if not pair.are_both_flat:
        pair.margin = displacement_bound(ws, pair) + found + pair.allowed
    return float(found)


@kernel("f8(ws, Pair)")
def renew_direction(ws: Workspace, pair: Pair) -> float:
    """Search the direction in which two parts are farthest apart, and store it. Returns the separation along it [m].

    Of parts that overlap it need not be the largest one. Discs without thickness in one plane are apart along a
    direction and its opposite, up to round-off. They keep the side from which they came.
    """
    known = known_direction(ws, pair)
    n, near = accurate_direction(ws, pair.index, known), ALLOWED * ws.tolerance.gap
    if are_alike(opposite(n), known) and separation_along(ws, pair.index, known) >= -near:
        n = known
    store_direction(ws, pair, n)
    return separation_along(ws, pair.index, n)
