"""Islands: contacts that share no movable body act on each other in no way, and are solved apart."""

from __future__ import annotations

from nonsmooth.engine.delassus.ordering import order_active
from nonsmooth.engine.memory.modes import OPEN
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, kernel, room


@kernel("i8(S, F, I, i8)")
def _root(S: Scalars, w: Floats, k: Integers, linkage: int) -> int:
    """Return the linkage that stands for all that are tied to this one, shortening the way there."""
    root = linkage
    while k[S.linkage_root + root] != root:
        root = k[S.linkage_root + root]
    while k[S.linkage_root + linkage] != root:
        linkage, k[S.linkage_root + linkage] = k[S.linkage_root + linkage], root
    return root


@kernel("i8(S, F, I, i8)")
def _linkage(S: Scalars, w: Floats, k: Integers, c: int) -> int:
    """Return a movable linkage of contact ``c``; the first one if none is."""
    a, b = k[S.linkage_a + c], k[S.linkage_b + c]
    return b if k[S.linkage_nu + a] == 0 and k[S.linkage_nu + b] > 0 else a


@kernel("void(S, F, I, i8)")
def activate_group(S: Scalars, w: Floats, k: Integers, group: int) -> None:
    """Make the contacts of an island the active ones."""
    first = k[S.group_start + group]
    S.first_grouped = first
    S.n_active = k[S.group_start + group + 1] - first
    for a in range(S.n_active):
        k[S.active + a] = k[S.grouped + first + a]


@room()
def group_members(S: Scalars, w: Floats, k: Integers) -> None:
    """Sort the contacts marked as ``member`` into islands, in the order of their first contacts, and link each."""
    for c in range(S.n_contacts):
        if k[S.member + c] == 1:
            for side in range(2):
                linkage = k[S.linkage_a + c] if side == 0 else k[S.linkage_b + c]
                k[S.linkage_root + linkage] = linkage
                k[S.linkage_group + linkage] = -1
    for c in range(S.n_contacts):
        a, b = k[S.linkage_a + c], k[S.linkage_b + c]
        if k[S.member + c] == 1 and k[S.linkage_nu + a] > 0 and k[S.linkage_nu + b] > 0:
            k[S.linkage_root + _root(S, w, k, b)] = _root(S, w, k, a)
    groups = members = 0
    for c in range(S.n_contacts):
        if k[S.member + c] == 0:
            continue
        linkage = _linkage(S, w, k, c)
        root = _root(S, w, k, linkage)
        # between two driven bodies every contact is an island of its own
        if k[S.linkage_nu + linkage] == 0 or k[S.linkage_group + root] < 0:
            k[S.linkage_group + root] = groups
            k[S.group_start + groups] = 0
            groups += 1
        k[S.group_of + c] = k[S.linkage_group + root]
        k[S.group_start + k[S.group_of + c]] += 1
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
        if k[S.member + c] == 1:
            g = k[S.group_of + c]
            k[S.grouped + k[S.group_next + g]] = c
            k[S.group_next + g] += 1
    S.n_groups = groups
    S.n_grouped = members
    for group in range(groups):
        activate_group(S, w, k, group)
        order_active(S, w, k)


@kernel("void(S, F, I)")
def group_closed(S: Scalars, w: Floats, k: Integers) -> None:
    """Sort the closed contacts into islands."""
    for c in range(S.n_contacts):
        k[S.member + c] = 1 if k[S.mode + c] != OPEN else 0
    group_members(S, w, k)


@kernel("void(S, F, I)")
def group_touching(S: Scalars, w: Floats, k: Integers) -> None:
    """Sort the touching contacts that collide, not those that give way, into islands."""
    for c in range(S.n_contacts):
        k[S.member + c] = k[S.touching + c] if k[S.normal_function + c] == 0 else 0
    group_members(S, w, k)
