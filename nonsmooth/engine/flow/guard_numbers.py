"""The numbers of the guards: which is which, and whose.

First stand the normal guards of all contacts, then their friction guards, then the scenario's own, and last the end
guards of the contacts.
"""

from __future__ import annotations

from nonsmooth.engine.native.kernel import Workspace, kernel


@kernel("i8(i8)")
def normal_guard(c: int) -> int:
    """Return the guard of contact ``c`` that is its gap, its normal force or the way to its reach."""
    return c


@kernel("i8(ws, i8)")
def friction_guard(ws: Workspace, c: int) -> int:
    """Return the guard of contact ``c`` that is the distance to its static bound, or its slip."""
    return int(ws.island.n_contacts + c)


@kernel("b1(ws, i8)")
def is_friction_guard(ws: Workspace, i: int) -> bool:
    """Return 1 if guard ``i`` of a contact is that of its friction."""
    return i >= ws.island.n_contacts


@kernel("i8(ws, i8)")
def contact_of(ws: Workspace, i: int) -> int:
    """Return the contact whose normal or friction guard ``i`` is."""
    return int(i - ws.island.n_contacts) if i >= ws.island.n_contacts else i


@kernel("i8(ws)")
def first_own_guard(ws: Workspace) -> int:
    """Return the first guard of the scenario's own; before it are the normal and friction guards."""
    return int(2 * ws.island.n_contacts)


@kernel("i8(ws)")
def first_end_guard(ws: Workspace) -> int:
    """Return the end guard of the first contact; those of the others follow."""
    return int(first_own_guard(ws) + ws.model.n_own_guards)


@kernel("i8(ws)")
def number_of_guards(ws: Workspace) -> int:
    """Return how many guards there are."""
    return int(first_end_guard(ws) + ws.island.n_contacts)
