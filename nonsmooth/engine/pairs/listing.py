"""Neighbour list: which of the declared contacts are active.

All contacts of a small system are active. In a large one, every frame that carries bounded shapes has a bounding sphere
about its origin, and the list is made as follows:

1. Bounding spheres are sorted along an axis, and a sweep finds the pairs that are nearer than a margin.
2. The contacts of such a pair become active, except those of shapes that are apart
   (:mod:`nonsmooth.engine.pairs.apart`).
3. A half-space at rest has contacts with the spheres nearer than the margin, and any other half-space with all.

The list is valid until a sphere has moved by half the margin. If features of its shapes are searched for
(:mod:`nonsmooth.engine.pairs.candidates`), no point of the shapes may have moved farther than that.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.declared import store_histories, write_history, write_parameters
from nonsmooth.engine.bodies.kinematics import NOT_EVALUATED
from nonsmooth.engine.memory.blocks import PAIR
from nonsmooth.engine.memory.layout import NO_PAIR
from nonsmooth.engine.memory.modes import Mode, Status
from nonsmooth.engine.native.kernel import (
    ContactRecord,
    Floats,
    Pair,
    Workspace,
    at,
    call_pair,
    entry_point,
    frame_at,
    kernel,
)
from nonsmooth.engine.numerics.vectors import distance, dot, minus
from nonsmooth.engine.pairs.apart import find_apart
from nonsmooth.engine.pairs.candidates import NARROWEST, are_near, find_candidates, has_no_features, try_searches
from nonsmooth.engine.pairs.motion import speed_of_parts
from nonsmooth.engine.pairs.overlaps import displacement_bound, known_separation

_SPENT = 0.6
"""Part of the allowed displacement of a sphere after which the list is made anew."""
_REACH = 0.1
"""Displacement of two convex shapes for which a list is enough, relative to the size of the smaller one.

A larger one lists more contacts, a smaller one lists them more often."""
_ACCELERATION = 2.0
"""Assumed ratio of the speed of a sphere within a step to that at its start. The end of the step is checked."""


@kernel("b1(ws, ContactRecord)")
def _is_far(ws: Workspace, contact: ContactRecord) -> bool:
    """True if an open contact of convex shapes stays open while these move by the reach of their pair.

    The depth of shapes of several parts, or of pieces of a surface, is not known: their springs are all listed.
    """
    if contact.mode != Mode.OPEN or contact.bound_function == 0 or contact.pair == NO_PAIR:
        return False
    following = contact.pair + 1
    has_several = following < ws.model.n_pairs and ws.pairs[following].group == contact.pair
    if contact.is_compliant and has_several:
        return False
    a, b = at(ws.floats, contact.frame_a), at(ws.floats, contact.frame_b)
    call_pair(contact.bound_function, a, b, at(ws.floats, contact.geometry_parameters), contact.geometry)
    # the first number of the block is the bound
    return bool(contact.gap - contact.reach > ws.pairs[contact.pair].reach)


@kernel("b1(ws, i8, i8)")
def _enter(ws: Workspace, row: int, declared: int) -> bool:
    """Make a declared contact of a row active, if it has features. False if there is no slot left."""
    if has_no_features(ws, row, declared):
        return True
    if ws.island.n_contacts == ws.model.n_slots:
        return False
    c = ws.island.n_contacts
    contact = ws.contacts[c]
    write_parameters(ws, row, declared, contact)
    write_history(ws, contact)
    if _is_far(ws, contact):
        return True
    contact.is_touching = False
    contact.version_a = NOT_EVALUATED
    # a kinematics leaves out numbers that are always zero; the contact that had the slot may have written them
    for i in range(PAIR):
        contact.geometry[i] = 0.0
    # the Jacobians are zero in the columns of the other bodies of an articulation
    for side in range(2):
        n_u = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b].n_u
        jacobian = contact.jacobian_a if side == 0 else contact.jacobian_b
        for i in range(3 * n_u):
            ws.floats[jacobian + i] = 0.0
    ws.island.n_contacts += 1
    return True


@kernel("b1(ws, i8)")
def _enter_row(ws: Workspace, row: int) -> bool:
    """Make all contacts of a row active, unless its shapes are apart. False if there are too few slots."""
    pair = ws.rows[row].pair
    if pair != NO_PAIR and ws.pairs[pair].is_apart:
        return True
    for declared in range(ws.rows[row].first_contact, ws.rows[row].end_contact):
        if not _enter(ws, row, declared):
            return False
    return True


@kernel("b1(ws, i8, i8)")
def _enter_spheres(ws: Workspace, one: int, two: int) -> bool:
    """Make the contacts of the shapes in two bounding spheres active. False if there are too few slots."""
    sphere = ws.spheres[one]
    low, high = sphere.first_partner, sphere.end_partner
    end = high
    while low < high:
        middle = (low + high) // 2
        if ws.model.partner[middle] < two:
            low = middle + 1
        else:
            high = middle
    if low == end or ws.model.partner[low] != two:
        return True
    for i in range(ws.model.partner_row[low], ws.model.partner_row[low + 1]):
        if not _enter_row(ws, ws.model.paired_row[i]):
            return False
    return True


@kernel("b1(F, i8)")
def _is_still(floats: Floats, place: int) -> bool:
    """True if a frame has no velocity and no acceleration."""
    frame = frame_at(floats, place)
    moves = dot(frame.velocity, frame.velocity) + dot(frame.spin, frame.spin)
    moves += dot(frame.acceleration, frame.acceleration) + dot(frame.spin_acceleration, frame.spin_acceleration)
    return moves == 0.0


@kernel("b1(ws, i8)")
def _is_clear(ws: Workspace, number: int) -> bool:
    """True if a sphere is farther above a half-space at rest than the margin: none of its contacts is closed."""
    half_space = ws.half_spaces[number]
    frame, sphere = frame_at(ws.floats, half_space.frame), ws.spheres[half_space.sphere]
    third = frame.rotation[2], frame.rotation[5], frame.rotation[8]
    height = dot(third, minus(sphere.place, frame.origin)) - half_space.ceiling
    return height - sphere.radius > ws.island.list_margin


@kernel("f8(ws, i8, i8)")
def _begin(ws: Workspace, number: int, axis: int) -> float:
    """Least coordinate of a bounding sphere along an axis [m]."""
    sphere = ws.spheres[number]
    return float(sphere.places[axis] - sphere.radius)


@kernel("void(ws, i8)")
def _sort_spheres(ws: Workspace, axis: int) -> None:
    """Sort the spheres by their least coordinates along an axis. They are nearly sorted from the last time."""
    for i in range(1, ws.model.n_spheres):
        number = ws.island.sphere_order[i]
        begin = _begin(ws, number, axis)
        j = i - 1
        while j >= 0:
            other = ws.island.sphere_order[j]
            if _begin(ws, other, axis) <= begin:
                break
            ws.island.sphere_order[j + 1] = other
            j -= 1
        ws.island.sphere_order[j + 1] = number


@kernel("i8(ws)")
def _widest_axis(ws: Workspace) -> int:
    """Axis along which the centres of the spheres extend farthest: 0, 1 or 2."""
    best, widest = 0, -1.0
    for axis in range(3):
        low, high = math.inf, -math.inf
        for number in range(ws.model.n_spheres):
            place = ws.spheres[number].places[axis]
            low, high = min(low, place), max(high, place)
        if high - low > widest:
            best, widest = axis, high - low
    return best


@kernel("Status(ws, f8)")
def _full(ws: Workspace, margin: float) -> Status:
    """Undo a list for which there are too few slots, so that it can be made again, from the former ``margin``."""
    ws.island.n_contacts = 0
    ws.island.list_margin = margin
    ws.totals.n_listings -= 1
    return Status.LIST_FULL


@entry_point("Status(ws)")
def list_near(ws: Workspace) -> Status:
    """List the contacts of all bodies near each other, whether their shapes are apart or not; return the status."""
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    for pair in ws.pairs:
        pair.is_apart, pair.reach = False, math.inf
    return fill_list(ws)


@entry_point("Status(ws)")
def list_touching(ws: Workspace) -> Status:
    """List the contacts of bodies near each other, except of guarded pairs that are apart; return the status.

    A search for features that fails is found here, also if its shapes are apart.
    """
    status = list_with(ws, NO_PAIR)
    return try_searches(ws) if status == Status.RUNNING else status


@kernel("Status(ws, i8)")
def list_with(ws: Workspace, touching: int) -> Status:
    """The same, with the contacts of the pair ``touching`` in any case, or ``NO_PAIR``."""
    # the pairs need the bodies, and the modes of the contacts that are listed
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    find_apart(ws, touching)
    for pair in ws.pairs:
        # compliant bodies may overlap, and their features be as deep in each other
        depth = max(0.0, -known_separation(ws, pair.index)) if pair.is_guarded and not pair.is_apart else 0.0
        pair.reach = _REACH * pair.size + depth if pair.is_guarded else math.inf
        pair.listed = displacement_bound(ws, pair)
    return fill_list(ws)


@entry_point("Status(ws)")
def fill_list(ws: Workspace) -> Status:
    """Make the list at the present state, by the pairs that are known to be apart; return the status.

    Bodies must be evaluated. With the status ``LIST_FULL`` the histories are kept, and the call can be repeated in a
    memory with more slots.
    """
    store_histories(ws)
    ws.island.follows_a_step = False
    ws.totals.n_listings += 1
    if ws.model.n_spheres == 0:
        for row in range(ws.model.n_rows):
            _enter_row(ws, row)
        ws.island.n_histories = 0
        return Status.RUNNING
    for sphere in ws.spheres:
        frame = frame_at(ws.floats, sphere.frame)
        sphere.place = frame.origin
        for i in range(9):
            sphere.axes[i] = frame.rotation[i]
    margin = ws.island.list_margin
    ws.island.list_margin = min(ws.options.widest_margin, 2.0 * ws.island.list_margin)
    status = find_candidates(ws)
    while status == Status.NO_SLOT and ws.island.list_margin > NARROWEST * ws.options.widest_margin:
        ws.island.list_margin *= 0.5
        status = find_candidates(ws)
    if status != Status.RUNNING:
        return status
    frame = still = -1
    for i in range(ws.model.n_half_spaces):
        half_space = ws.half_spaces[i]
        # the half-spaces of one frame are adjacent
        if half_space.frame != frame:
            frame, still = half_space.frame, _is_still(ws.floats, half_space.frame)
        clear = still == 1 and half_space.is_steady and _is_clear(ws, i)
        if not clear and not _enter_row(ws, half_space.row):
            return _full(ws, margin)
    axis = _widest_axis(ws)
    _sort_spheres(ws, axis)
    for i in range(ws.model.n_spheres):
        one = ws.island.sphere_order[i]
        sphere = ws.spheres[one]
        end = sphere.places[axis] + sphere.radius + ws.island.list_margin
        for j in range(i + 1, ws.model.n_spheres):
            two = ws.island.sphere_order[j]
            if _begin(ws, two, axis) > end:
                break
            if are_near(ws, one, two) and not _enter_spheres(ws, min(one, two), max(one, two)):
                return _full(ws, margin)
    ws.island.n_histories = 0
    return Status.RUNNING


@kernel("f8(ws, i8)")
def _displacement(ws: Workspace, number: int) -> float:
    """Displacement of a sphere since the list was made [m], that of its features included if they are searched for."""
    sphere = ws.spheres[number]
    frame = frame_at(ws.floats, sphere.frame)
    moved, radius = distance(frame.origin, sphere.place), sphere.feature_radius
    if radius > 0.0:
        square = 0.0
        for i in range(9):
            square += (frame.rotation[i] - sphere.axes[i]) ** 2
        moved += radius * math.sqrt(0.5 * square)
    return float(moved)


@kernel("f8(ws, i8)")
def _speed(ws: Workspace, number: int) -> float:
    """Speed of a sphere, that of its features included if they are searched for [m/s]."""
    sphere = ws.spheres[number]
    frame = frame_at(ws.floats, sphere.frame)
    speed = math.sqrt(dot(frame.velocity, frame.velocity))
    if sphere.feature_radius > 0.0:
        speed += sphere.feature_radius * math.sqrt(dot(frame.spin, frame.spin))
    return speed


@kernel("f8(ws)")
def longest_step(ws: Workspace) -> float:
    """Time for which the list is valid [s], 0 if it must be made anew. Bodies must be evaluated."""
    longest = math.inf
    for number in range(ws.model.n_spheres):
        sphere, moved, speed = ws.spheres[number], _displacement(ws, number), _speed(ws, number)
        left = 0.5 * ws.island.list_margin - moved
        sphere.distance, sphere.speed = moved, speed
        if left < 0.5 * (1.0 - _SPENT) * ws.island.list_margin:
            return 0.0
        if speed * longest * _ACCELERATION > left:
            longest = left / (_ACCELERATION * speed)
    for pair in ws.pairs:
        if not _is_limited(ws, pair):
            continue
        left = pair.listed + pair.reach - displacement_bound(ws, pair)
        speed = speed_of_parts(ws, ws.carriers[pair.carrier_a]) + speed_of_parts(ws, ws.carriers[pair.carrier_b])
        if left < (1.0 - _SPENT) * pair.reach:
            return 0.0
        if speed * longest * _ACCELERATION > left:
            longest = left / (_ACCELERATION * speed)
    return longest


@kernel("b1(ws, Pair)")
def _is_limited(ws: Workspace, pair: Pair) -> bool:
    """True if a displacement of two parts limits the time for which their listed contacts are enough."""
    return pair.is_guarded and pair.index == pair.group and not pair.is_apart and pair.reach < math.inf


@kernel("b1(ws, f8)")
def overran_list(ws: Workspace, h: float) -> bool:
    """True if a sphere may have moved too far in a step of ``h`` [s]. Bodies must be evaluated at its end.

    On a path of length l between two points, the distance from a third point is at most half of l plus half the sum of
    the distances of both ends.
    """
    for sphere in ws.spheres:
        path = h * max(sphere.speed, _speed(ws, sphere.index))
        if sphere.distance + _displacement(ws, sphere.index) + path > ws.island.list_margin:
            return True
    for pair in ws.pairs:
        if _is_limited(ws, pair):
            a, b = ws.carriers[pair.carrier_a], ws.carriers[pair.carrier_b]
            path = h * (max(a.speed_at_start, speed_of_parts(ws, a)) + max(b.speed_at_start, speed_of_parts(ws, b)))
            if displacement_bound(ws, pair) + path > pair.listed + pair.reach:
                return True
    return False
