"""Islands: contacts that share no movable body act on each other in no way, and are solved apart."""

from __future__ import annotations

from nonsmooth.engine.bodies.courses import is_on_course
from nonsmooth.engine.delassus.ordering import order_active
from nonsmooth.engine.memory.modes import OPEN
from nonsmooth.engine.native.kernel import (
    Floats,
    Integers,
    Scalars,
    active_at,
    articulation_at,
    contact_at,
    entry_point,
    kernel,
)


@kernel("i8(S, F, I, i8)")
def _leader(S: Scalars, w: Floats, k: Integers, number: int) -> int:
    """Return the articulation that stands for all that contacts join to this one, shortening the way there."""
    root = number
    while articulation_at(S, w, k, root).root != root:
        root = articulation_at(S, w, k, root).root
    while articulation_at(S, w, k, number).root != root:
        articulation = articulation_at(S, w, k, number)
        number = articulation.root
        articulation.root = root
    return root


@kernel("i8(S, F, I, i8)")
def _articulation(S: Scalars, w: Floats, k: Integers, c: int) -> int:
    """Return a movable articulation of contact ``c``; the first one if none is."""
    contact = contact_at(S, w, k, c)
    a, b = contact.articulation_a, contact.articulation_b
    return int(b if articulation_at(S, w, k, a).nu == 0 and articulation_at(S, w, k, b).nu > 0 else a)


@kernel("void(S, F, I, i8)")
def activate_group(S: Scalars, w: Floats, k: Integers, group: int) -> None:
    """Make the contacts of an island the active ones."""
    first = k[S.group_start + group]
    S.first_grouped = first
    S.n_active = k[S.group_start + group + 1] - first
    for a in range(S.n_active):
        active_at(S, w, k, a).slot = k[S.grouped + first + a]


@entry_point()
def group_members(S: Scalars, w: Floats, k: Integers) -> None:
    """Sort the contacts marked as ``member`` into islands, in the order of their first contacts, and link each."""
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.member == 1:
            for side in range(2):
                number = contact.articulation_a if side == 0 else contact.articulation_b
                articulation = articulation_at(S, w, k, number)
                articulation.root, articulation.group = number, -1
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        a, b = contact.articulation_a, contact.articulation_b
        if contact.member == 1 and articulation_at(S, w, k, a).nu > 0 and articulation_at(S, w, k, b).nu > 0:
            articulation_at(S, w, k, _leader(S, w, k, b)).root = _leader(S, w, k, a)
    groups = members = 0
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.member == 0:
            continue
        number = _articulation(S, w, k, c)
        root = articulation_at(S, w, k, _leader(S, w, k, number))
        # between two driven bodies every contact is an island of its own
        if articulation_at(S, w, k, number).nu == 0 or root.group < 0:
            root.group = groups
            k[S.group_start + groups] = 0
            groups += 1
        contact.group_of = root.group
        k[S.group_start + contact.group_of] += 1
        members += 1
    # counts become starts, and the contacts fall into their places
    end = members
    for i in range(groups):
        g = groups - 1 - i
        end -= k[S.group_start + g]
        k[S.group_start + g] = end
        k[S.group_next + g] = end
    k[S.group_start + groups] = members
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.member == 1:
            g = contact.group_of
            k[S.grouped + k[S.group_next + g]] = c
            k[S.group_next + g] += 1
    S.n_groups = groups
    S.n_grouped = members
    for group in range(groups):
        activate_group(S, w, k, group)
        order_active(S, w, k)


@kernel("void(S, F, I)")
def group_closed(S: Scalars, w: Floats, k: Integers) -> None:
    """Sort the closed contacts into islands, but for those of bodies on their courses."""
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        contact.member = 1 if contact.mode != OPEN and is_on_course(S, w, k, c) == 0 else 0
    group_members(S, w, k)


@kernel("void(S, F, I)")
def group_touching(S: Scalars, w: Floats, k: Integers) -> None:
    """Sort the touching contacts that collide, not those that give way, into islands."""
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        contact.member = contact.touching if contact.normal_function == 0 else 0
    group_members(S, w, k)
