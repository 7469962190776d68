"""The look at pairs: whether bodies between which contacts are declared have passed into each other.

Features of bodies can miss each other; their pair cannot.  Where a step begins, for each pair of convex parts whose
balls meet, the separation along the direction that parted them last is taken first, then that which one search finds.
Only of a pair that overlaps are its contacts asked how deep they let it, and is the largest separation looked for.  A
pair that was found apart is not looked at again before its parts have moved so far that they may meet.  Discs without
thickness overlap by no depth: of these it is asked whether one went through the other.
"""

from __future__ import annotations

import math

from nonsmooth.engine.memory.modes import OPEN
from nonsmooth.engine.native.kernel import (
    Floats,
    Integers,
    Scalars,
    carrier_at,
    contact_at,
    entry_point,
    frame_at,
    kernel,
    pair_at,
    part_at,
)
from nonsmooth.engine.numerics.vectors import distance, dot
from nonsmooth.engine.pairs.circles import crossing_overlap
from nonsmooth.engine.pairs.separation import direction_of, parting_direction
from nonsmooth.engine.pairs.support import height_over, middle_of, separation_along

NO_PAIR = -1
"""A contact between shapes that are not looked at."""
_FAR = 1e3
"""After this way [m] ways are counted anew, long before their round-off counts; half-spaces that turn go farther."""


@kernel("void(S, F, I)")
def _ask_contacts(S: Scalars, w: Floats, k: Integers) -> None:
    """Write how deep the closed contacts of a pair let it overlap, with the normal of the deepest."""
    for number in range(S.n_pairs):
        pair = pair_at(S, w, k, number)
        pair.closed, pair.deepest = 0, 0.0
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.mode == OPEN or contact.pair == NO_PAIR:
            continue
        pair = pair_at(S, w, k, contact.pair)
        if pair.closed == 0 or contact.gap_end < pair.deepest:
            pair.closed, pair.deepest, pair.normal = 1, min(0.0, contact.gap_end), contact.normal


@kernel("void(S, F, I)")
def _move_carriers(S: Scalars, w: Floats, k: Integers) -> None:
    """Add to the way of each carrier how far any point of its parts can be from where it was at the last look."""
    farthest = 0.0
    for number in range(S.n_carriers):
        carrier = carrier_at(S, w, k, number)
        frame, square = frame_at(w, carrier.frame), 0.0
        for i in range(9):
            square += (frame.rotation[i] - carrier.axes[i]) ** 2
            carrier.axes[i] = frame.rotation[i]
        carrier.way += distance(frame.origin, carrier.place) + carrier.lever * math.sqrt(0.5 * square)
        carrier.place = frame.origin
        farthest = max(farthest, carrier.way)
    if farthest > _FAR:
        for number in range(S.n_carriers):
            carrier_at(S, w, k, number).way = 0.0
        for number in range(S.n_pairs):
            pair_at(S, w, k, number).room = 0.0


@kernel("f8(S, F, I, i8)")
def _way(S: Scalars, w: Floats, k: Integers, number: int) -> float:
    """Return the way of both carriers of a pair [m]: its separation changes by no more."""
    pair = pair_at(S, w, k, number)
    return float(carrier_at(S, w, k, pair.carrier_a).way + carrier_at(S, w, k, pair.carrier_b).way)


@kernel("f8(S, F, I, i8)")
def _known_separation(S: Scalars, w: Floats, k: Integers, number: int) -> float:
    """Return how far apart a pair is at least, as far as what is known of it tells [m]."""
    pair = pair_at(S, w, k, number)
    if part_at(w, pair.part_a).rings < 0.0:
        return height_over(S, w, k, number)
    between = distance(middle_of(w, pair.frame_b, pair.part_b), middle_of(w, pair.frame_a, pair.part_a))
    apart = between - part_at(w, pair.part_a).radius - part_at(w, pair.part_b).radius
    n = pair.direction
    if apart >= 0.0 or dot(n, n) == 0.0:
        return float(apart)
    return float(separation_along(S, w, k, number, n))


@kernel("f8(S, F, I, i8, f8)")
def _separation(S: Scalars, w: Floats, k: Integers, number: int, enough: float) -> float:
    """Return the separation of a pair if it is below ``enough``, else a number that is not."""
    pair = pair_at(S, w, k, number)
    if part_at(w, pair.part_a).rings < 0.0:
        return height_over(S, w, k, number)
    group = pair_at(S, w, k, pair.group)
    if group.closed == 1:
        found = separation_along(S, w, k, number, group.normal)
        if found >= enough:
            pair.direction = group.normal
            return float(found)
    pair.direction = direction_of(S, w, k, number, pair.direction, enough)
    return float(separation_along(S, w, k, number, pair.direction))


@entry_point("void(S, F, I)")
def look_at_pairs(S: Scalars, w: Floats, k: Integers) -> None:
    """Find a pair that overlaps by more than its closed contacts say, bodies and contacts being evaluated.

    What these say is asked only of a pair that one search does not find apart.
    """
    S.passed, asked, most = -1, 0, 0.0
    _move_carriers(S, w, k)
    for number in range(S.n_pairs):
        pair, way = pair_at(S, w, k, number), _way(S, w, k, number)
        if way < pair.room:
            continue
        apart = _known_separation(S, w, k, number)
        if apart < -pair.allowed and part_at(w, pair.part_a).rings >= 0.0:
            pair.direction = parting_direction(S, w, k, number, pair.direction)
            apart = separation_along(S, w, k, number, pair.direction)
        inside = crossing_overlap(S, w, k, number) if pair.flat == 1 else -apart
        pair.room = way + apart + (0.0 if pair.flat == 1 else pair.allowed)
        if inside <= pair.allowed:
            continue
        if asked == 0:
            _ask_contacts(S, w, k)
            asked = 1
        group = pair_at(S, w, k, pair.group)
        if pair.flat == 1 and group.closed == 1:
            continue
        explained = group.deepest - pair.allowed
        found = -inside if pair.flat == 1 else _separation(S, w, k, number, explained)
        if explained - found > most:
            most = explained - found
            S.passed, S.passed_depth, S.passed_explained = number, -found, -explained
