"""The declared contacts: parameters of each from its row and its kind, and its history while the list is made.

The memory holds a record for each row, the contacts of two shapes, and for each kind, the contacts with the same
kinematics and laws. The parameters of a contact follow from both. State is stored for active contacts only. While the
neighbour list is made anew, the states of the contacts that were on it are the histories, which a hash table finds by
the number of the contact.
"""

from __future__ import annotations

import math

from nonsmooth.engine.memory.modes import NO_RELEASE, Mode
from nonsmooth.engine.native.kernel import ContactRecord, Workspace, copy_fields, entry_point, kernel


@kernel("i8(i8, i8)")
def _moved(offset: int, distance: int) -> int:
    """An offset in a block of a contact, ``distance`` behind that in the block of the first contact; 0 stays 0."""
    return offset + distance if offset > 0 else 0


@kernel("i8(ws, i8, i8)")
def features_of(ws: Workspace, first: int, declared: int) -> int:
    """Offset of the pair of features of a declared contact in row ``first`` or behind; 0 if its features are fixed."""
    number = first
    while ws.rows[number].end_contact <= declared:
        number += 1
    row = ws.rows[number]
    kind = ws.kinds[row.first_kind + declared - row.first_contact]
    return int(_moved(kind.features, row.rank * kind.geometry_stride))


@kernel("void(ws, i8, i8, ContactRecord)")
def write_parameters(ws: Workspace, number: int, declared: int, contact: ContactRecord) -> None:
    """Write the parameters of a declared contact in row ``number`` to an active contact."""
    row = ws.rows[number]
    index = declared - row.first_contact
    kind = ws.kinds[row.first_kind + index]
    copy_fields(row, contact)
    copy_fields(kind, contact)
    contact.declared = declared
    contact.inner_states += index * contact.n_inner_states
    geometry, laws = row.rank * kind.geometry_stride, row.rank * kind.law_stride
    if geometry > 0:
        contact.geometry_parameters = _moved(contact.geometry_parameters, geometry)
        contact.features = _moved(contact.features, geometry)
    if laws > 0:
        contact.normal_parameters = _moved(contact.normal_parameters, laws)
        contact.friction_parameters = _moved(contact.friction_parameters, laws)
        contact.anisotropy = _moved(contact.anisotropy, laws)
        contact.traction_parameters = _moved(contact.traction_parameters, laws)
        contact.traction_out = _moved(contact.traction_out, laws)
        contact.rates_parameters = _moved(contact.rates_parameters, laws)
        contact.rates_out = _moved(contact.rates_out, laws)
        contact.inner_states_at_start = _moved(contact.inner_states_at_start, laws)
        contact.inner_states_copy = _moved(contact.inner_states_copy, laws)
        contact.impact_force_parameters = _moved(contact.impact_force_parameters, laws)
        contact.efficiency_parameters = _moved(contact.efficiency_parameters, laws)
        contact.map_parameters = _moved(contact.map_parameters, laws)


@kernel("i8(ws, i8)")
def _row_of(ws: Workspace, declared: int) -> int:
    """Row of a declared contact, by bisection: the contacts of a row follow those of the row before."""
    first, end = 0, ws.model.n_rows
    while end - first > 1:
        middle = (first + end) // 2
        if ws.rows[middle].first_contact <= declared:
            first = middle
        else:
            end = middle
    return first


@entry_point()
def copy_parameters(ws: Workspace) -> None:
    """Write the parameters of its declared contact to each active contact, for a list that a checkpoint brought."""
    for contact in ws.contacts:
        write_parameters(ws, _row_of(ws, contact.declared), contact.declared, contact)


@kernel("i8(ws, i8)")
def _place(ws: Workspace, declared: int) -> int:
    """Place of a contact in the hash table of histories: where its history is, or the free place where it belongs."""
    size = 2 * ws.model.n_slots + 1
    place = declared % size
    # linear probing: at least half of the places are free
    while ws.island.history_places[place] > 0:
        if ws.histories[ws.island.history_places[place] - 1].declared == declared:
            return place
        place = place + 1 if place + 1 < size else 0
    return place


@kernel("i8(ws, i8)")
def history_of(ws: Workspace, declared: int) -> int:
    """Index of the history of a declared contact, -1 if it has none: it is open, and its features are new."""
    return ws.island.history_places[_place(ws, declared)] - 1


@kernel()
def store_histories(ws: Workspace) -> None:
    """Move the states of all active contacts to histories, and list the histories in the hash table.

    Histories that are there stay: those of a start, which Python has written.
    """
    n = ws.island.n_histories
    for contact in ws.contacts:
        copy_fields(contact, ws.histories[n])
        n += 1
    ws.island.n_contacts, ws.island.n_histories = 0, n
    for i in range(2 * ws.model.n_slots + 1):
        ws.island.history_places[i] = 0
    for history in ws.histories:
        ws.island.history_places[_place(ws, history.declared)] = history.index + 1


@kernel("void(ws, ContactRecord)")
def write_history(ws: Workspace, contact: ContactRecord) -> None:
    """Write the history of its declared contact to an active contact, or the state of one that was never closed."""
    number = history_of(ws, contact.declared)
    if number >= 0:
        copy_fields(ws.histories[number], contact)
        return
    contact.mode = contact.mode_after_averaging = Mode.OPEN
    # any unit vector, until a slip has a direction
    contact.direction = 1.0, 0.0
    contact.initial_depth = 0.0
    contact.closing_rate = contact.force_round_off = contact.slip_per_force = 0.0
    for i in range(3):
        contact.mean_force[i] = 0.0
    contact.mean_span = contact.mean_gap = contact.mean_gap_change = 0.0
    contact.mean_forces_asked, contact.mean_forces_wait = -math.inf, 0.0
    contact.release = NO_RELEASE
    contact.facing = 1
    contact.slack = 0.0
    for i in range(3):
        contact.null_space_force[i] = 0.0
    contact.burst_start, contact.burst_events = 0.0, 0
