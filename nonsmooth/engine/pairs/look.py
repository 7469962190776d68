"""The look at pairs: whether bodies between which contacts are declared have passed into each other.

Features of bodies can miss each other; their pair cannot.  For each pair of convex parts whose balls meet the
separation along the direction that parted them last is taken first, or along the normal of a contact of theirs that is
closed.  Only where that does not show them apart is a better direction looked for.
"""

from __future__ import annotations

from nonsmooth.engine.memory.modes import OPEN
from nonsmooth.engine.native.kernel import (
    Floats,
    Integers,
    Scalars,
    contact_at,
    entry_point,
    kernel,
    pair_at,
    part_at,
)
from nonsmooth.engine.numerics.vectors import dot, minus
from nonsmooth.engine.pairs.separation import direction_of
from nonsmooth.engine.pairs.support import height_over, middle_of, separation_along

NO_PAIR = -1
"""A contact between shapes that are not looked at."""


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
        if pair.closed == 0 or contact.gap < pair.deepest:
            pair.closed, pair.deepest, pair.normal = 1, min(0.0, contact.gap), contact.normal


@kernel("i8(S, F, I, i8)")
def _balls_meet(S: Scalars, w: Floats, k: Integers, number: int) -> int:
    """Return 1 if the balls that hold the parts of a pair meet."""
    pair = pair_at(S, w, k, number)
    way = minus(middle_of(w, pair.frame_b, pair.part_b), middle_of(w, pair.frame_a, pair.part_a))
    reach = part_at(w, pair.part_a).radius + part_at(w, pair.part_b).radius
    return 1 if dot(way, way) < reach * reach else 0


@kernel("i8(S, F, I, i8)")
def _are_parted(S: Scalars, w: Floats, k: Integers, number: int) -> int:
    """Return 1 if a pair is apart, or overlaps by no more than is allowed, as far as what is known of it tells."""
    pair = pair_at(S, w, k, number)
    if part_at(w, pair.part_a).rings < 0.0:
        return 1 if height_over(S, w, k, number) >= -pair.allowed else 0
    if _balls_meet(S, w, k, number) == 0:
        return 1
    n = pair.direction
    return 1 if dot(n, n) > 0.0 and separation_along(S, w, k, number, n) >= -pair.allowed else 0


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

    What these say is asked only where a pair is not apart.
    """
    S.passed, asked, most = -1, 0, 0.0
    for number in range(S.n_pairs):
        if _are_parted(S, w, k, number) == 1:
            continue
        if asked == 0:
            _ask_contacts(S, w, k)
            asked = 1
        pair = pair_at(S, w, k, number)
        explained = pair_at(S, w, k, pair.group).deepest - pair.allowed
        found = _separation(S, w, k, number, explained)
        if explained - found > most:
            most = explained - found
            S.passed, S.passed_depth, S.passed_explained = number, -found, -explained
