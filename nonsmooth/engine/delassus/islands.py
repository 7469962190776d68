"""Islands: contacts that share no movable body act on each other in no way, and are solved apart."""

from __future__ import annotations

from nonsmooth.engine.bodies.courses import has_own_step
from nonsmooth.engine.delassus.ordering import order_active
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import (
    Workspace,
    entry_point,
    kernel,
)


@kernel("i8(ws, i8)")
def _leader(ws: Workspace, number: int) -> int:
    """Return the articulation that stands for all that contacts join to this one, shortening the way there."""
    root = number
    while ws.articulations[root].root != root:
        root = ws.articulations[root].root
    while ws.articulations[number].root != root:
        articulation = ws.articulations[number]
        number = articulation.root
        articulation.root = root
    return root


@kernel("i8(ws, i8)")
def _articulation(ws: Workspace, c: int) -> int:
    """Return a movable articulation of contact ``c``; the first one if none is."""
    contact = ws.contacts[c]
    a, b = contact.articulation_a, contact.articulation_b
    return int(b if ws.articulations[a].n_u == 0 and ws.articulations[b].n_u > 0 else a)


@kernel("void(ws, i8)")
def activate_group(ws: Workspace, group: int) -> None:
    """Make the contacts of an island the active ones."""
    first = ws.island.group_start[group]
    ws.problem.first_grouped = first
    ws.problem.n_active = ws.island.group_start[group + 1] - first
    for a in range(ws.problem.n_active):
        ws.actives[a].contact = ws.island.grouped[first + a]


@entry_point()
def group_members(ws: Workspace) -> None:
    """Sort the contacts marked as ``member`` into islands, in the order of their first contacts, and link each."""
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        if contact.is_in_problem:
            for side in range(2):
                number = contact.articulation_a if side == 0 else contact.articulation_b
                articulation = ws.articulations[number]
                articulation.root, articulation.group = number, -1
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        a, b = contact.articulation_a, contact.articulation_b
        if contact.is_in_problem and ws.articulations[a].n_u > 0 and ws.articulations[b].n_u > 0:
            ws.articulations[_leader(ws, b)].root = _leader(ws, a)
    groups = members = 0
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        if not contact.is_in_problem:
            continue
        number = _articulation(ws, c)
        root = ws.articulations[_leader(ws, number)]
        # between two driven bodies every contact is an island of its own
        if ws.articulations[number].n_u == 0 or root.group < 0:
            root.group = groups
            ws.island.group_start[groups] = 0
            groups += 1
        contact.group = root.group
        ws.island.group_start[contact.group] += 1
        members += 1
    # counts become starts, and the contacts fall into their places
    end = members
    for i in range(groups):
        g = groups - 1 - i
        end -= ws.island.group_start[g]
        ws.island.group_start[g] = end
        ws.island.group_next[g] = end
    ws.island.group_start[groups] = members
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        if contact.is_in_problem:
            g = contact.group
            ws.island.grouped[ws.island.group_next[g]] = c
            ws.island.group_next[g] += 1
    ws.island.n_groups = groups
    ws.island.n_grouped = members
    for group in range(groups):
        activate_group(ws, group)
        order_active(ws)


@kernel()
def group_closed(ws: Workspace) -> None:
    """Sort the closed contacts into islands, but for those of bodies on their courses."""
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        contact.is_in_problem = contact.mode != Mode.OPEN and not has_own_step(ws, c)
    group_members(ws)


@kernel()
def group_touching(ws: Workspace) -> None:
    """Sort the touching contacts that collide, not those that give way, into islands."""
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        contact.is_in_problem = contact.is_touching if not contact.is_compliant else False
    group_members(ws)
