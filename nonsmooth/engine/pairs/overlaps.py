"""Overlap check: whether bodies between which contacts are declared have passed into each other.

The contacts of two shapes can miss each other if a feature is wrong or a step too long. The separation of two convex
parts cannot. So at the start of each step every pair of convex parts is checked, from cheap to costly:

1. A pair that was apart is not evaluated again until its parts have moved so far that they may meet. Each carrier
   accumulates a bound of the displacement of its points.
2. The separation along the last direction, or of the bounding spheres, is a lower bound.
3. One search gives a better direction (:mod:`nonsmooth.engine.pairs.separation`).
4. If the parts still overlap, the closed contacts of the pair give the depth that is allowed, and the direction of
   largest separation is searched for.

Discs without thickness have no depth of overlap (:mod:`nonsmooth.engine.pairs.discs`).
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.support import (
    has_half_space,
    height_above_plane,
    known_direction,
    middle_of,
    separation_along,
    store_direction,
)
from nonsmooth.engine.memory.layout import NO_PAIR
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Pair, Workspace, entry_point, frame_at, kernel, part_at
from nonsmooth.engine.numerics.tolerances import SPACING
from nonsmooth.engine.numerics.vectors import distance, dot, opposite
from nonsmooth.engine.pairs.discs import crossing_overlap
from nonsmooth.engine.pairs.separation import best_direction, separating_direction


@kernel()
def _write_depths_of_contacts(ws: Workspace) -> None:
    """Write the normal of the deepest closed contact of every pair, and its gap, at most 0 [m].

    By that depth the pair may overlap. Pairs of the same two shapes have one entry, that of their first pair, which
    ``contact.pair`` names. The gaps are those at the end of the last step.
    """
    for pair in ws.pairs:
        pair.is_closed, pair.deepest = False, 0.0
    for contact in ws.contacts:
        if contact.mode == Mode.OPEN or contact.pair == NO_PAIR:
            continue
        pair = ws.pairs[contact.pair]
        if not pair.is_closed or contact.gap_at_end < pair.deepest:
            pair.is_closed, pair.deepest = True, min(0.0, contact.gap_at_end)
            pair.normal = opposite(contact.normal) if pair.is_swapped else contact.normal


@kernel()
def add_displacements(ws: Workspace) -> None:
    """Add to the distance of each carrier a bound of the displacement of its points since the last evaluation [m].

    A rotation by the angle a displaces a point at the radius r by 2 r sin(a / 2). This is r over the square root of two
    times the Frobenius norm of the change of the axes.
    """
    farthest = 0.0
    for carrier in ws.carriers:
        frame, square = frame_at(ws.floats, carrier.frame), 0.0
        for i in range(9):
            square += (frame.rotation[i] - carrier.axes[i]) ** 2
            carrier.axes[i] = frame.rotation[i]
        # a carrier is a body frame that holds parts, all within the radius
        carrier.distance += distance(frame.origin, carrier.place) + carrier.radius * math.sqrt(0.5 * square)
        carrier.place = frame.origin
        farthest = max(farthest, carrier.distance)
    # the sums restart before their round-off reaches the gap tolerance; each pair is evaluated and listed anew
    if SPACING * farthest > ws.tolerance.gap:
        for carrier in ws.carriers:
            carrier.distance = 0.0
        for pair in ws.pairs:
            pair.margin, pair.listed = 0.0, -math.inf


@kernel("f8(ws, Pair)")
def displacement_bound(ws: Workspace, pair: Pair) -> float:
    """Sum of the bounds of the displacements of both parts of a pair [m]. Its separation changes by no more."""
    return float(ws.carriers[pair.carrier_a].distance + ws.carriers[pair.carrier_b].distance)


@kernel("f8(ws, i8)")
def known_separation(ws: Workspace, number: int) -> float:
    """Lower bound of the separation of pair ``number`` [m], without a search.

    Of a half-space it is exact. Else it is that of the bounding spheres, or along the last direction if they overlap.
    """
    pair = ws.pairs[number]
    if has_half_space(ws, number):
        return height_above_plane(ws, number)
    between = distance(middle_of(ws.floats, pair.frame_b, pair.part_b), middle_of(ws.floats, pair.frame_a, pair.part_a))
    apart = between - part_at(ws.floats, pair.part_a).radius - part_at(ws.floats, pair.part_b).radius
    n = known_direction(ws, pair)
    # a direction of length 0: no search has been made yet
    if apart >= 0.0 or dot(n, n) == 0.0:
        return float(apart)
    return float(separation_along(ws, number, n))


@kernel("f8(ws, i8, f8)")
def _separation(ws: Workspace, number: int, enough: float) -> float:
    """Largest separation that is found of pair ``number`` [m], negative in an overlap. Writes its direction.

    The search stops at a value of ``enough`` [m] or more. The normal of its deepest closed contact is tried first.
    """
    pair = ws.pairs[number]
    if has_half_space(ws, number):
        return height_above_plane(ws, number)
    # the first pair of the same two shapes has their contact
    group = ws.pairs[pair.group]
    if group.is_closed:
        normal = opposite(group.normal) if pair.is_swapped != group.is_swapped else group.normal
        found = separation_along(ws, number, normal)
        if found >= enough:
            store_direction(ws, pair, normal)
            return float(found)
    n = best_direction(ws, number, known_direction(ws, pair), enough)
    store_direction(ws, pair, n)
    return float(separation_along(ws, number, n))


@entry_point()
def check_pairs(ws: Workspace) -> None:
    """Find the pair that overlaps by most beyond the depth of its closed contacts.

    Writes its number to ``run.passed_pair``, or ``NO_PAIR`` if all are within that depth, and its depth and the allowed
    one [m]. If the depth is beyond the tolerances, too, the caller ends the run. Bodies and contacts must be evaluated.
    """
    ws.run.passed_pair, are_depths_known, most = NO_PAIR, False, 0.0
    add_displacements(ws)
    for pair in ws.pairs:
        # the parts have not moved so far that they may meet
        if displacement_bound(ws, pair) < pair.margin:
            continue
        depth = _depth(ws, pair)
        # an overlap that the laws of the pair allow
        if depth <= pair.allowed:
            continue
        if not are_depths_known:
            _write_depths_of_contacts(ws)
            are_depths_known = True
        # pairs of the same two shapes share the depth of their contacts
        group, are_discs = ws.pairs[pair.group], pair.are_both_flat
        # the overlap of discs without thickness is no depth that could be compared with that of a closed contact
        if are_discs and group.is_closed:
            continue
        # least separation that is allowed, and the one found; negative in an overlap
        allowed = group.deepest - pair.allowed
        found = -depth if are_discs else _separation(ws, pair.index, allowed)
        if allowed - found > most:
            most = allowed - found
            ws.run.passed_pair, ws.run.passed_depth, ws.run.passed_allowed = pair.index, -found, -allowed


@kernel("f8(ws, Pair)")
def _depth(ws: Workspace, pair: Pair) -> float:
    """Depth of the overlap of a pair after one search [m], negative if it is apart.

    Of discs without thickness it is the overlap of their circles as they passed each other, else 0. Writes the margin
    of the pair: the displacement bound up to which it need not be evaluated again.
    """
    number = pair.index
    apart = known_separation(ws, number)
    # the separation from a half-space is exact
    if apart < -pair.allowed and not has_half_space(ws, number):
        n = separating_direction(ws, number, known_direction(ws, pair))
        store_direction(ws, pair, n)
        apart = separation_along(ws, number, n)
    are_discs = pair.are_both_flat
    depth = crossing_overlap(ws, number) if are_discs else -apart
    # an overlap up to the allowed one needs no evaluation, but discs without thickness have no such depth
    pair.margin = displacement_bound(ws, pair) + apart + (0.0 if are_discs else pair.allowed)
    return float(depth)
