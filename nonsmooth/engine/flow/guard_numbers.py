"""Numbers of the guards: the normal guards of all contacts, their friction guards, those of the user, the end guards.

The number of a guard gives its kind and its contact, so a guard that has fired needs no more than its number.
"""

from __future__ import annotations

from nonsmooth.engine.memory.layout import NO_PAIR
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import ContactRecord, GuardRecord, Workspace, kernel


@kernel("i8(i8)")
def normal_guard(c: int) -> int:
    """Number of the normal guard of contact ``c``: its gap, its normal force, or the distance to its reach."""
    return c


@kernel("i8(ws, i8)")
def friction_guard(ws: Workspace, c: int) -> int:
    """Number of the friction guard of contact ``c``: the distance to its static bound, or its slip."""
    return int(ws.island.n_contacts + c)


@kernel("b1(ws, i8)")
def is_friction_guard(ws: Workspace, i: int) -> bool:
    """True if guard ``i``, a normal or a friction guard, is a friction guard: those follow all normal guards."""
    return i >= ws.island.n_contacts


@kernel("i8(ws, i8)")
def contact_of(ws: Workspace, i: int) -> int:
    """Number of the contact of the normal or friction guard ``i``: friction guards follow all normal guards."""
    return int(i - ws.island.n_contacts) if i >= ws.island.n_contacts else i


@kernel("i8(ws)")
def first_user_guard(ws: Workspace) -> int:
    """Number of the first guard of the user. The normal and friction guards are before it."""
    return int(2 * ws.island.n_contacts)


@kernel("i8(ws)")
def first_end_guard(ws: Workspace) -> int:
    """Number of the end guard (distance to the end of its features) of the first contact. The others follow."""
    return int(first_user_guard(ws) + ws.model.n_own_guards)


@kernel("i8(ws)")
def number_of_guards(ws: Workspace) -> int:
    """Number of all guards: two of each contact, those of the user, and the end guard of each contact."""
    return int(first_end_guard(ws) + ws.island.n_contacts)


@kernel("GuardRecord(ws, ContactRecord)")
def normal_of(ws: Workspace, contact: ContactRecord) -> GuardRecord:
    """Record of the normal guard of a contact: its gap, its normal force, or the distance to its reach."""
    return ws.guards[normal_guard(contact.index)]


@kernel("GuardRecord(ws, ContactRecord)")
def friction_of(ws: Workspace, contact: ContactRecord) -> GuardRecord:
    """Record of the friction guard of a contact: the distance to its static bound, or its slip."""
    return ws.guards[friction_guard(ws, contact.index)]


@kernel("GuardRecord(ws, ContactRecord)")
def end_of(ws: Workspace, contact: ContactRecord) -> GuardRecord:
    """Record of the end guard of a contact: the distance to the end of its features."""
    return ws.guards[first_end_guard(ws) + contact.index]


@kernel("ContactRecord(ws, i8)")
def contact_at(ws: Workspace, i: int) -> ContactRecord:
    """Contact of the normal or friction guard ``i``."""
    return ws.contacts[contact_of(ws, i)]


@kernel("b1(ws, i8)")
def is_of_open_contact(ws: Workspace, i: int) -> bool:
    """True if the contact of the normal or friction guard ``i`` is open."""
    return contact_at(ws, i).mode == Mode.OPEN


@kernel("b1(ws, ContactRecord)")
def is_of_watched_pair(ws: Workspace, contact: ContactRecord) -> bool:
    """True if the separation of the shapes of a contact is watched within the step, in place of its gap."""
    return contact.pair != NO_PAIR and ws.pairs[contact.pair].is_watched
