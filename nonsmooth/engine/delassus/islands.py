"""Islands: sets of contacts that share no movable body with the contacts of other sets.

Contacts of different islands do not act on each other, so each island is a contact problem of its own. Islands are
found by a disjoint-set forest of articulations (R. E. Tarjan, J. ACM 22 (1975) 215-225): a contact between two movable
articulations joins their sets, and ``root`` leads from an articulation to the representative of its set. This needs
one pass through the contacts. A search through the graph of contacts would need its edges, which are not known yet.

Islands are numbered in the order of their first contacts. An island is called ``group`` in names of the code.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.courses import has_own_step
from nonsmooth.engine.delassus.ordering import order_active
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import ContactRecord, Workspace, entry_point, kernel

_NO_GROUP = -1
"""Island of an articulation that has none yet."""


@kernel("i8(ws, i8)")
def _find_root(ws: Workspace, number: int) -> int:
    """Representative of the set of articulations that contains articulation ``number``: the end of its chain ``root``.

    Links the articulations of the chain directly to it, so that the next query is short.
    """
    root = number
    while ws.articulations[root].root != root:
        root = ws.articulations[root].root
    while ws.articulations[number].root != root:
        articulation = ws.articulations[number]
        number = articulation.root
        articulation.root = root
    return root


@kernel("i8(ws, ContactRecord)")
def _movable_articulation(ws: Workspace, contact: ContactRecord) -> int:
    """Articulation of a contact that is movable: the first such one, or simply the first if none is.

    An articulation is a body, or several that joints connect. Its set is the island of the contact.
    """
    a, b = contact.articulation_a, contact.articulation_b
    return int(b if ws.articulations[a].n_u == 0 and ws.articulations[b].n_u > 0 else a)


@kernel("void(ws, i8)")
def activate_group(ws: Workspace, group: int) -> None:
    """Make the contacts of island ``group`` the active contacts ``ws.actives``, with which the solvers work.

    Their other numbers (forces, modes under trial) are those of the island before, until they are written.
    """
    first = ws.island.group_start[group]
    ws.problem.first_grouped = first
    ws.problem.n_active = ws.island.group_start[group + 1] - first
    for active in ws.actives:
        active.contact = ws.island.grouped[first + active.index]


@entry_point()
def group_members(ws: Workspace) -> None:
    """Sort the contacts marked by ``is_in_problem`` into islands, sets of contacts that do not act on each other.

    Each island gets an order of its contacts and the block structure of its Delassus matrix.
    """
    _join_articulations(ws)
    _number_islands(ws)
    _list_islands(ws)
    for group in range(ws.island.n_groups):
        # in ascending order: the blocks of an island follow those of the island before
        activate_group(ws, group)
        order_active(ws)


@kernel()
def _join_articulations(ws: Workspace) -> None:
    """Join the movable articulations that a marked contact connects into sets: contacts of one set form an island.

    Marked are the contacts with ``is_in_problem``. Each articulation starts as a set of its own.
    """
    for contact in ws.contacts:
        if contact.is_in_problem:
            for side in range(2):
                number = contact.articulation_a if side == 0 else contact.articulation_b
                articulation = ws.articulations[number]
                articulation.root, articulation.group = number, _NO_GROUP
    for contact in ws.contacts:
        a, b = contact.articulation_a, contact.articulation_b
        # a fixed or driven body passes no force on, so it joins nothing
        if contact.is_in_problem and ws.articulations[a].n_u > 0 and ws.articulations[b].n_u > 0:
            ws.articulations[_find_root(ws, b)].root = _find_root(ws, a)


@kernel()
def _number_islands(ws: Workspace) -> None:
    """Give each marked contact (``is_in_problem``) the number of its island, and write the islands' sizes.

    ``root.group`` is the island of a set of articulations, once its first contact is met. The sizes are in
    ``group_start``, which :func:`_list_islands` replaces by the starts.
    """
    n_groups = n_grouped = 0
    for contact in ws.contacts:
        if not contact.is_in_problem:
            continue
        number = _movable_articulation(ws, contact)
        root = ws.articulations[_find_root(ws, number)]
        # the first contact of a set begins an island; one between two driven bodies is an island of its own
        if ws.articulations[number].n_u == 0 or root.group == _NO_GROUP:
            root.group = n_groups
            ws.island.group_start[n_groups] = 0
            n_groups += 1
        contact.group = root.group
        ws.island.group_start[contact.group] += 1
        n_grouped += 1
    ws.island.n_groups, ws.island.n_grouped = n_groups, n_grouped


@kernel()
def _list_islands(ws: Workspace) -> None:
    """Write the marked contacts to ``grouped``, island after island, and the starts of the islands to ``group_start``.

    This is a counting sort. Before, ``group_start`` holds the sizes of the islands. ``group_next`` is the next free
    entry of each. One more start, behind the last island, is the number of all its contacts.
    """
    # the starts follow from the sizes, from the last island backwards
    end = ws.island.n_grouped
    for i in range(ws.island.n_groups):
        group = ws.island.n_groups - 1 - i
        end -= ws.island.group_start[group]
        ws.island.group_start[group] = end
        ws.island.group_next[group] = end
    ws.island.group_start[ws.island.n_groups] = ws.island.n_grouped
    for contact in ws.contacts:
        if contact.is_in_problem:
            ws.island.grouped[ws.island.group_next[contact.group]] = contact.index
            ws.island.group_next[contact.group] += 1


@kernel()
def group_closed(ws: Workspace) -> None:
    """Sort the closed contacts into islands, for the forces of the smooth motion.

    Contacts of bodies with a step of their own (multirate) belong to none.
    """
    for contact in ws.contacts:
        # a body with an own step moves along a step that is known already
        contact.is_in_problem = contact.mode != Mode.OPEN and not has_own_step(ws, contact.index)
    group_members(ws)


@kernel()
def group_touching(ws: Workspace) -> None:
    """Sort the rigid contacts that touch into islands, for a collision. Compliant contacts do not collide."""
    for contact in ws.contacts:
        contact.is_in_problem = contact.is_touching and not contact.is_compliant
    group_members(ws)
