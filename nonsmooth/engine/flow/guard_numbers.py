"""The numbers of the guards: which is which, and whose.

First stand the normal guards of all contacts, then their friction guards, then the scenario's own, and last the end
guards of the contacts.
"""

from __future__ import annotations

from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Contact, Guard, Workspace, kernel


@kernel("i8(i8)")
def normal_guard(c: int) -> int:
    """The guard of contact ``c`` that is its gap, its normal force or the way to its reach."""
    return c


@kernel("i8(ws, i8)")
def friction_guard(ws: Workspace, c: int) -> int:
    """The guard of contact ``c`` that is the distance to its static bound, or its slip."""
    return int(ws.island.n_contacts + c)


@kernel("b1(ws, i8)")
def is_friction_guard(ws: Workspace, i: int) -> bool:
    """Return 1 if guard ``i`` of a contact is that of its friction."""
    return i >= ws.island.n_contacts


@kernel("i8(ws, i8)")
def contact_of(ws: Workspace, i: int) -> int:
    """The contact whose normal or friction guard ``i`` is."""
    return int(i - ws.island.n_contacts) if i >= ws.island.n_contacts else i


@kernel("i8(ws)")
def first_own_guard(ws: Workspace) -> int:
    """The first guard of the scenario's own; before it are the normal and friction guards."""
    return int(2 * ws.island.n_contacts)


@kernel("i8(ws)")
def first_end_guard(ws: Workspace) -> int:
    """The end guard of the first contact; those of the others follow."""
    return int(first_own_guard(ws) + ws.model.n_own_guards)


@kernel("i8(ws)")
def number_of_guards(ws: Workspace) -> int:
    """Number of guards."""
    return int(first_end_guard(ws) + ws.island.n_contacts)


@kernel("Guard(ws, Contact)")
def normal_of(ws: Workspace, contact: Contact) -> Guard:
    """The normal guard of a contact."""
    return ws.guards[normal_guard(contact.index)]


@kernel("Guard(ws, Contact)")
def friction_of(ws: Workspace, contact: Contact) -> Guard:
    """The friction guard of a contact."""
    return ws.guards[friction_guard(ws, contact.index)]


@kernel("Guard(ws, Contact)")
def end_of(ws: Workspace, contact: Contact) -> Guard:
    """The end guard of a contact."""
    return ws.guards[first_end_guard(ws) + contact.index]


@kernel("Contact(ws, i8)")
def contact_at(ws: Workspace, i: int) -> Contact:
    """The contact whose normal or friction guard ``i`` is."""
    return ws.contacts[contact_of(ws, i)]


@kernel("b1(ws, i8)")
def is_of_open_contact(ws: Workspace, i: int) -> bool:
    """True if the contact whose normal or friction guard ``i`` is, is open."""
    return contact_at(ws, i).mode == Mode.OPEN
