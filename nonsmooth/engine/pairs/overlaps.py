"""The look at pairs: whether bodies between which contacts are declared have passed into each other.

Features of bodies can miss each other; their pair cannot.  Where a step begins, for each pair of convex parts whose
balls meet, the separation along the direction that parted them last is taken first, then that which one search finds.
Only of a pair that overlaps are its contacts asked how deep they let it, and is the largest separation looked for.  A
pair that was found apart is not looked at again before its parts have moved so far that they may meet.  Discs without
thickness overlap by no depth: of these it is asked whether one went through the other.
"""

from __future__ import annotations

import math

from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import (
    Workspace,
    entry_point,
    frame_at,
    kernel,
    part_at,
)
from nonsmooth.engine.numerics.vectors import distance, dot
from nonsmooth.engine.pairs.discs import crossing_overlap
from nonsmooth.engine.pairs.separation import best_direction, separating_direction
from nonsmooth.engine.pairs.support import height_above_plane, middle_of, separation_along

NO_PAIR = -1
"""A contact between shapes that are not looked at."""
_LARGEST_DISPLACEMENT = 1e3
"""After this way [m] ways are counted anew, long before their round-off counts; half-spaces that turn go farther."""


@kernel()
def _write_depths_of_contacts(ws: Workspace) -> None:
    """Write how deep the closed contacts of a pair let it overlap, with the normal of the deepest."""
    for number in range(ws.model.n_pairs):
        pair = ws.pairs[number]
        pair.is_closed, pair.deepest = False, 0.0
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        if contact.mode == Mode.OPEN or contact.pair == NO_PAIR:
            continue
        pair = ws.pairs[contact.pair]
        if not pair.is_closed or contact.gap_at_end < pair.deepest:
            pair.is_closed, pair.deepest, pair.normal = True, min(0.0, contact.gap_at_end), contact.normal


@kernel()
def _add_displacements(ws: Workspace) -> None:
    """Add to the way of each carrier how far any point of its parts can be from where it was at the last look."""
    farthest = 0.0
    for number in range(ws.model.n_carriers):
        carrier = ws.carriers[number]
        frame, square = frame_at(ws.floats, carrier.frame), 0.0
        for i in range(9):
            square += (frame.rotation[i] - carrier.axes[i]) ** 2
            carrier.axes[i] = frame.rotation[i]
        carrier.distance += distance(frame.origin, carrier.place) + carrier.radius * math.sqrt(0.5 * square)
        carrier.place = frame.origin
        farthest = max(farthest, carrier.distance)
    if farthest > _LARGEST_DISPLACEMENT:
        for number in range(ws.model.n_carriers):
            ws.carriers[number].distance = 0.0
        for number in range(ws.model.n_pairs):
            ws.pairs[number].margin = 0.0


@kernel("f8(ws, i8)")
def _displacement_bound(ws: Workspace, number: int) -> float:
    """Return the way of both carriers of a pair [m]: its separation changes by no more."""
    pair = ws.pairs[number]
    return float(ws.carriers[pair.carrier_a].distance + ws.carriers[pair.carrier_b].distance)


@kernel("f8(ws, i8)")
def _known_separation(ws: Workspace, number: int) -> float:
    """Return how far apart a pair is at least, as far as what is known of it tells [m]."""
    pair = ws.pairs[number]
    if part_at(ws.floats, pair.part_a).rings < 0.0:
        return height_above_plane(ws, number)
    between = distance(middle_of(ws.floats, pair.frame_b, pair.part_b), middle_of(ws.floats, pair.frame_a, pair.part_a))
    apart = between - part_at(ws.floats, pair.part_a).radius - part_at(ws.floats, pair.part_b).radius
    n = pair.direction
    if apart >= 0.0 or dot(n, n) == 0.0:
        return float(apart)
    return float(separation_along(ws, number, n))


@kernel("f8(ws, i8, f8)")
def _separation(ws: Workspace, number: int, enough: float) -> float:
    """Return the separation of a pair if it is below ``enough``, else a number that is not."""
    pair = ws.pairs[number]
    if part_at(ws.floats, pair.part_a).rings < 0.0:
        return height_above_plane(ws, number)
    group = ws.pairs[pair.group]
    if group.is_closed:
        found = separation_along(ws, number, group.normal)
        if found >= enough:
            pair.direction = group.normal
            return float(found)
    pair.direction = best_direction(ws, number, pair.direction, enough)
    return float(separation_along(ws, number, pair.direction))


@entry_point()
def check_pairs(ws: Workspace) -> None:
    """Find a pair that overlaps by more than its closed contacts say, bodies and contacts being evaluated.

    What these say is asked only of a pair that one search does not find apart.
    """
    ws.run.passed_pair, asked, most = -1, False, 0.0
    _add_displacements(ws)
    for number in range(ws.model.n_pairs):
        pair, way = ws.pairs[number], _displacement_bound(ws, number)
        if way < pair.margin:
            continue
        apart = _known_separation(ws, number)
        if apart < -pair.allowed and part_at(ws.floats, pair.part_a).rings >= 0.0:
            pair.direction = separating_direction(ws, number, pair.direction)
            apart = separation_along(ws, number, pair.direction)
        inside = crossing_overlap(ws, number) if pair.flat == 1 else -apart
        pair.margin = way + apart + (0.0 if pair.flat == 1 else pair.allowed)
        if inside <= pair.allowed:
            continue
        if not asked:
            _write_depths_of_contacts(ws)
            asked = True
        group = ws.pairs[pair.group]
        if pair.flat == 1 and group.is_closed:
            continue
        explained = group.deepest - pair.allowed
        found = -inside if pair.flat == 1 else _separation(ws, number, explained)
        if explained - found > most:
            most = explained - found
            ws.run.passed_pair, ws.run.passed_depth, ws.run.passed_allowed = number, -found, -explained
