"""Candidate features: which pairs of features of two shapes have one of the contacts that the shapes share.

Two meshes have far more pairs of features than can touch at once. So they share a number of declared contacts, each of
which holds one pair of features, or none. When the neighbour list is made, the search function of the two shapes finds
the pairs that are near each other. A pair that has a contact keeps it, with mode and slip. An open
contact whose pair was not found is emptied. The other pairs that were found fill empty contacts.

Behind its features each contact stores the largest distance that they may have while the list holds.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.declared import features_of, history_of
from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.engine.memory.layout import NO_PAIR
from nonsmooth.engine.memory.modes import Mode, Status
from nonsmooth.engine.native.kernel import Search, Workspace, at, call_pair, kernel
from nonsmooth.engine.numerics.vectors import dot, minus

NARROWEST = 2.0**-12
"""Least margin of the list, relative to the widest one, and least reach of a pair, relative to the size of the smaller
part, if there are more candidate features than contacts for them."""
_NOT_A_NUMBER = -1
"""Number of pairs in place of one that is negative or not finite."""


@kernel("b1(ws, i8, i8)")
def has_no_features(ws: Workspace, row: int, declared: int) -> bool:
    """True if a declared contact of a row may hold any pair of features of two shapes, and holds none at present.

    A contact with fixed features has offset 0 here. The first number of a pair is never 0.
    """
    candidate = features_of(ws, row, declared)
    return candidate > 0 and ws.floats[candidate] == 0.0


@kernel("b1(ws, i8, i8)")
def are_near(ws: Workspace, a: int, b: int) -> bool:
    """True if the bounding spheres ``a`` and ``b`` are nearer than the margin of the neighbour list [m].

    Their centres are those noted when the list is made.
    """
    sphere_a, sphere_b = ws.spheres[a], ws.spheres[b]
    between = minus(sphere_a.place, sphere_b.place)
    near = sphere_a.radius + sphere_b.radius + ws.island.list_margin
    return dot(between, between) <= near * near


@kernel("void(ws, i8, i8, i8, i8)")
def _match(ws: Workspace, row: int, declared: int, found: int, n_found: int) -> None:
    """Mark the pair of features of a declared contact as taken among the ``n_found`` pairs at offset ``found``.

    A taken pair has a zero in place of its first number. If the pair was not found, an open contact is emptied, so that
    another pair may take it. A closed contact keeps its pair.
    """
    features = features_of(ws, row, declared)
    for i in range(n_found):
        is_same = True
        for r in range(CANDIDATE):
            if ws.floats[found + CANDIDATE * i + r] != ws.floats[features + r]:
                is_same = False
        if is_same:
            ws.floats[found + CANDIDATE * i] = 0.0
            return
    history = history_of(ws, declared)
    if history < 0 or ws.histories[history].mode == Mode.OPEN:
        ws.floats[features] = 0.0
        if history >= 0:
            # the history of the old pair must not go to the next one: values as at the start of a run
            ws.histories[history].direction, ws.histories[history].closing_rate = (1.0, 0.0), 0.0


@kernel("Status(ws)")
def find_candidates(ws: Workspace) -> Status:
    """Assign the pairs of features that are near each other to declared contacts.

    A search has as many contacts as two shapes may need at once; their pairs of features change. Near is within the
    margin of the neighbour list, or within the displacement of a pair of convex parts up to which the list is valid;
    the latter is reduced as long as there are more pairs than contacts. Status: ``RUNNING``, ``NO_SLOT`` if the margin
    of the list must be reduced, ``NOT_FINITE`` if a search fails.
    """
    for search in ws.searches:
        status = _assign(ws, search)
        while status == Status.NO_SLOT and _narrows(ws, search):
            status = _assign(ws, search)
        if status != Status.RUNNING:
            return status
    return Status.RUNNING


@kernel("b1(ws, Search)")
def _narrows(ws: Workspace, search: Search) -> bool:
    """Reduce the reach of the pair of a search to half, so that fewer features are within it; False at the least."""
    if not _is_of_pair(ws, search):
        return False
    pair = ws.pairs[ws.rows[search.row].pair]
    pair.reach *= 0.5
    return bool(pair.reach > NARROWEST * pair.size)


@kernel("b1(ws, Search)")
def _is_of_pair(ws: Workspace, search: Search) -> bool:
    """True if the displacement of a pair of convex parts limits the time for which the features found are enough."""
    pair = ws.rows[search.row].pair
    return pair != NO_PAIR and ws.pairs[pair].is_guarded and ws.pairs[pair].reach < math.inf


@kernel("f8(ws, Search)")
def _margin(ws: Workspace, search: Search) -> float:
    """Largest gap of the features that a search looks for: the reach of its pair, else the margin of the list [m]."""
    return ws.pairs[ws.rows[search.row].pair].reach if _is_of_pair(ws, search) else ws.island.list_margin


@kernel("Status(ws, Search)")
def _assign(ws: Workspace, search: Search) -> Status:
    """Assign the pairs of features that a search finds to its contacts; status as in :func:`find_candidates`."""
    pair = ws.rows[search.row].pair
    n_found = 0 if pair != NO_PAIR and ws.pairs[pair].is_apart else _find(ws, search)
    if n_found == _NOT_A_NUMBER:
        return Status.NOT_FINITE
    if n_found > search.n_contacts:
        return Status.NO_SLOT
    end = search.first_contact + search.n_contacts
    # the pairs follow the number of pairs in the output of the search
    for declared in range(search.first_contact, end):
        if not has_no_features(ws, search.row, declared):
            _match(ws, search.row, declared, search.out + 1, n_found)
    # closed contacts keep pairs that were not found, so that the others may be too few
    if not _fill_empty(ws, search, n_found):
        return Status.NO_SLOT
    for declared in range(search.first_contact, end):
        # largest gap of a pair while the list holds: the margin, and as much for the bodies to move
        ws.floats[features_of(ws, search.row, declared) + CANDIDATE] = 2.0 * _margin(ws, search)
    return Status.RUNNING


@kernel("Status(ws)")
def try_searches(ws: Workspace) -> Status:
    """Call all searches of shapes near each other, apart or not: ``NOT_FINITE`` if one fails, else ``RUNNING``."""
    for search in ws.searches:
        if _find(ws, search) == _NOT_A_NUMBER:
            return Status.NOT_FINITE
    return Status.RUNNING


@kernel("i8(ws, Search)")
def _find(ws: Workspace, search: Search) -> int:
    """Call a search for pairs of features if its shapes are near each other.

    Number of pairs that it found, 0 if the shapes are not near, or ``_NOT_A_NUMBER`` if the function gave a negative or
    undefined number. The function reads the margin [m] at ``search.out``, where it writes
    the number of pairs. The pairs follow.
    """
    if not are_near(ws, search.sphere_a, search.sphere_b):
        return 0
    ws.floats[search.out] = _margin(ws, search)
    a, b = at(ws.floats, ws.spheres[search.sphere_a].frame), at(ws.floats, ws.spheres[search.sphere_b].frame)
    call_pair(search.function, a, b, at(ws.floats, search.parameters), at(ws.floats, search.out))
    # NaN fails the comparison, too
    return int(ws.floats[search.out]) if ws.floats[search.out] >= 0.0 else _NOT_A_NUMBER


@kernel("b1(ws, Search, i8)")
def _fill_empty(ws: Workspace, search: Search, n_found: int) -> bool:
    """Fill empty contacts with the pairs of features that have no contact yet. False if there are too few contacts.

    The ``n_found`` pairs are in the output of the search, behind their number. A pair that has a contact is marked by a
    zero in place of its first number.
    """
    declared, end = search.first_contact, search.first_contact + search.n_contacts
    for i in range(n_found):
        found = search.out + 1 + CANDIDATE * i
        if ws.floats[found] == 0.0:
            continue
        while declared < end and not has_no_features(ws, search.row, declared):
            declared += 1
        if declared == end:
            return False
        features = features_of(ws, search.row, declared)
        for r in range(CANDIDATE):
            ws.floats[features + r] = ws.floats[found + r]
    return True
