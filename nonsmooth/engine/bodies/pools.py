"""Which features of two shapes stand in the contacts that are kept for them, where there are too many for one each.

A pool is a row of declared contacts of two units, each of which holds the numbers of a pair of features, or none.  When
contacts are listed, a function of the pair finds the features that are nearer than the margin of the list.  Those that
have a contact keep it, with its mode and slip; the others that are open make room.  Behind its features a contact has
how far they may come from each other while the list stands.
"""

from __future__ import annotations

from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.engine.memory.modes import Mode, Status
from nonsmooth.engine.native.kernel import Workspace, at, call_pair, kernel
from nonsmooth.engine.numerics.vectors import dot, minus


@kernel("b1(ws, i8)")
def is_empty(ws: Workspace, declared: int) -> bool:
    """Return 1 if a declared contact is one of a pool and holds no features."""
    candidate = ws.declared_contacts[declared].features
    return candidate > 0 and ws.floats[candidate] == 0.0


@kernel("b1(ws, i8, i8)")
def are_near(ws: Workspace, one: int, two: int) -> bool:
    """Return 1 if the balls of two units are nearer than the margin of the list."""
    a, b = ws.spheres[one], ws.spheres[two]
    way = minus(a.place, b.place)
    near = a.radius + b.radius + ws.island.list_margin
    return dot(way, way) <= near * near


@kernel("void(ws, i8, i8, i8)")
def _keep(ws: Workspace, declared: int, found: int, n: int) -> None:
    """Empty an open contact whose features are not among ``n`` that were found; cross them out where they are."""
    candidate = ws.declared_contacts[declared].features
    for i in range(n):
        same = True
        for r in range(CANDIDATE):
            if ws.floats[found + CANDIDATE * i + r] != ws.floats[candidate + r]:
                same = False
        if same:
            ws.floats[found + CANDIDATE * i] = 0.0
            return
    if ws.declared_contacts[declared].mode == Mode.OPEN:
        ws.floats[candidate] = 0.0
        contact = ws.declared_contacts[declared]
        contact.direction, contact.closing_rate = (1.0, 0.0), 0.0


@kernel("Status(ws)")
def fill_pools(ws: Workspace) -> Status:
    """Put the features nearer than the margin into the contacts of their pools; return the status."""
    for number in range(ws.model.n_searches):
        pool = ws.searches[number]
        out, first, contacts = pool.out, pool.first_contact, pool.n_contacts
        found, n = out + 1, 0
        if are_near(ws, pool.sphere_a, pool.sphere_b):
            ws.floats[out] = ws.island.list_margin
            frame_a, frame_b = ws.spheres[pool.sphere_a].frame, ws.spheres[pool.sphere_b].frame
            call_pair(
                pool.function,
                at(ws.floats, frame_a),
                at(ws.floats, frame_b),
                at(ws.floats, pool.parameters),
                at(ws.floats, out),
            )
            if not ws.floats[out] >= 0.0:
                return Status.NOT_FINITE
            n = int(ws.floats[out])
            if n > contacts:
                return Status.NO_SLOT
        for declared in range(first, first + contacts):
            if not is_empty(ws, declared):
                _keep(ws, declared, found, n)
        declared = first
        for i in range(n):
            if ws.floats[found + CANDIDATE * i] == 0.0:
                continue
            while declared < first + contacts and not is_empty(ws, declared):
                declared += 1
            if declared == first + contacts:
                return Status.NO_SLOT
            candidate = ws.declared_contacts[declared].features
            for r in range(CANDIDATE):
                ws.floats[candidate + r] = ws.floats[found + CANDIDATE * i + r]
        for declared in range(first, first + contacts):
            ws.floats[ws.declared_contacts[declared].features + CANDIDATE] = 2.0 * ws.island.list_margin
    return Status.RUNNING
