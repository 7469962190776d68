"""The numbers of the guards: which is which, and whose.

Every contact has two guards next to each other, normal and friction.  The scenario's own come behind those of all
contacts, and last the end guard of every contact.
"""

from __future__ import annotations

from nonsmooth.engine.native.kernel import Scalars, kernel


@kernel("i8(i8)")
def normal_guard(c: int) -> int:
    """Return the guard of contact ``c`` that is its gap, its normal force or the way to its reach."""
    return 2 * c


@kernel("i8(i8)")
def friction_guard(c: int) -> int:
    """Return the guard of contact ``c`` that is the distance to its static bound, or its slip."""
    return 2 * c + 1


@kernel("i8(i8)")
def contact_of(i: int) -> int:
    """Return the contact whose normal or friction guard ``i`` is."""
    return i // 2


@kernel("i8(i8)")
def is_friction_guard(i: int) -> int:
    """Return 1 if guard ``i`` of a contact is that of its friction."""
    return i % 2


@kernel("i8(S)")
def first_own_guard(S: Scalars) -> int:
    """Return the first guard of the scenario's own; before it are the normal and friction guards."""
    return int(2 * S.n_contacts)


@kernel("i8(S)")
def first_end_guard(S: Scalars) -> int:
    """Return the end guard of the first contact; those of the others follow."""
    return int(2 * S.n_contacts + S.n_own_guards)


@kernel("i8(S)")
def number_of_guards(S: Scalars) -> int:
    """Return how many guards there are."""
    return int(3 * S.n_contacts + S.n_own_guards)
