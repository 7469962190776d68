"""Which of the declared contacts stand in slots: all of a small system, those near each other of a large one.

A unit is a frame that carries bounded shapes, all within a ball about its origin.  The list holds the pairs of units
whose balls are nearer than a margin, found by sorting the balls along an axis and sweeping over them, and contacts with
unbounded shapes, walls: those of units whose balls are nearer than the margin where the wall is below a plane at rest,
all of others.  It stands until some unit has moved by half the margin; of a unit with pools of features
(:mod:`nonsmooth.engine.pairs.candidates`), until some point of it has.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.declared import store_histories, write_history, write_parameters
from nonsmooth.engine.bodies.kinematics import NOT_EVALUATED
from nonsmooth.engine.memory.blocks import PAIR
from nonsmooth.engine.memory.layout import NO_PAIR
from nonsmooth.engine.memory.modes import Status
from nonsmooth.engine.native.kernel import Floats, Workspace, entry_point, frame_at, kernel
from nonsmooth.engine.numerics.vectors import distance, dot, minus
from nonsmooth.engine.pairs.apart import find_apart
from nonsmooth.engine.pairs.candidates import are_near, find_candidates, has_no_features

_SPENT = 0.6
"""A list is drawn anew when a unit has used up this part of its way."""
_NARROWEST = 2.0**-12
"""Least part of its widest margin that the list may have, where pools cannot hold what is nearer."""
_ACCELERATION = 2.0
"""By how much a unit is taken to speed up within a step; the step is checked afterwards."""


@kernel("b1(ws, i8, i8)")
def _enter(ws: Workspace, row: int, declared: int) -> bool:
    """Put a declared contact of a row into the next slot, unless it is empty; return 0 if there is no slot."""
    if has_no_features(ws, row, declared):
        return True
    if ws.island.n_contacts == ws.model.n_slots:
        return False
    c = ws.island.n_contacts
    contact = ws.contacts[c]
    write_parameters(ws, row, declared, contact)
    write_history(ws, contact)
    contact.is_touching = False
    contact.version_a = NOT_EVALUATED
    # a pair writes what of its block can be other than zero; the contact that had the slot may have left more
    for i in range(PAIR):
        contact.geometry[i] = 0.0
    # Jacobians keep zeros where other bodies of an articulation stand
    for side in range(2):
        n_u = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b].n_u
        jacobian = contact.jacobian_a if side == 0 else contact.jacobian_b
        for i in range(3 * n_u):
            ws.floats[jacobian + i] = 0.0
    ws.island.n_contacts += 1
    return True


@kernel("b1(ws, i8)")
def _enter_row(ws: Workspace, row: int) -> bool:
    """Enter all contacts of a row, unless its shapes are apart; return 0 if there is no slot."""
    pair = ws.rows[row].pair
    if pair != NO_PAIR and ws.pairs[pair].is_apart:
        return True
    for declared in range(ws.rows[row].first_contact, ws.rows[row].end_contact):
        if not _enter(ws, row, declared):
            return False
    return True


@kernel("b1(ws, i8, i8)")
def _enter_pair(ws: Workspace, one: int, two: int) -> bool:
    """Enter the contacts of two units, if there are any; return 0 if there is no slot."""
    unit = ws.spheres[one]
    low, high = unit.first_partner, unit.end_partner
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
    """Return 1 if a frame neither moves nor begins to."""
    frame = frame_at(floats, place)
    moves = dot(frame.velocity, frame.velocity) + dot(frame.spin, frame.spin)
    moves += dot(frame.acceleration, frame.acceleration) + dot(frame.spin_acceleration, frame.spin_acceleration)
    return moves == 0.0


@kernel("b1(ws, i8)")
def _is_clear(ws: Workspace, number: int) -> bool:
    """Return 1 if the ball of a unit is farther above a wall at rest than the margin: a closed contact has none."""
    wall = ws.half_spaces[number]
    frame, unit = frame_at(ws.floats, wall.frame), ws.spheres[wall.sphere]
    third = frame.rotation[2], frame.rotation[5], frame.rotation[8]
    height = dot(third, minus(unit.place, frame.origin)) - wall.ceiling
    return height - unit.radius > ws.island.list_margin


@kernel("f8(ws, i8, i8)")
def _begin(ws: Workspace, number: int, axis: int) -> float:
    """Return where the ball of a unit begins along an axis."""
    unit = ws.spheres[number]
    return float(unit.places[axis] - unit.radius)


@kernel("void(ws, i8)")
def _sort_units(ws: Workspace, axis: int) -> None:
    """Sort the units by where their balls begin along an axis; they nearly are, from the last time."""
    for i in range(1, ws.model.n_spheres):
        unit = ws.island.sphere_order[i]
        begin = _begin(ws, unit, axis)
        j = i - 1
        while j >= 0:
            other = ws.island.sphere_order[j]
            if _begin(ws, other, axis) <= begin:
                break
            ws.island.sphere_order[j + 1] = other
            j -= 1
        ws.island.sphere_order[j + 1] = unit


@kernel("i8(ws)")
def _widest_axis(ws: Workspace) -> int:
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
    for pair in ws.pairs:
        pair.is_apart = False
    return fill_list(ws)


@entry_point("Status(ws)")
def list_touching(ws: Workspace) -> Status:
    """List the contacts of bodies near each other, except of guarded pairs that are apart; return the status."""
    return list_with(ws, NO_PAIR)


@kernel("Status(ws, i8)")
def list_with(ws: Workspace, touching: int) -> Status:
    """The same, with the contacts of the pair ``touching`` in any case, or ``NO_PAIR``."""
    # the pairs need the bodies, and the modes of the contacts that are listed
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    find_apart(ws, touching)
    return fill_list(ws)


@entry_point("Status(ws)")
def fill_list(ws: Workspace) -> Status:
    """Fill the slots for the present state; return the status.

    With the status ``LIST_FULL`` the histories are kept, and the call can be repeated in a memory with more slots.
    """
    store_histories(ws)
    ws.island.follows_a_step = False
    ws.totals.n_listings += 1
    if ws.model.n_spheres == 0:
        for row in range(ws.model.n_rows):
            _enter_row(ws, row)
        ws.island.n_histories = 0
        return Status.RUNNING
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    for unit in ws.spheres:
        frame = frame_at(ws.floats, unit.frame)
        unit.place = frame.origin
        for i in range(9):
            unit.axes[i] = frame.rotation[i]
    margin = ws.island.list_margin
    ws.island.list_margin = min(ws.options.widest_margin, 2.0 * ws.island.list_margin)
    status = find_candidates(ws)
    while status == Status.NO_SLOT and ws.island.list_margin > _NARROWEST * ws.options.widest_margin:
        ws.island.list_margin *= 0.5
        status = find_candidates(ws)
    if status != Status.RUNNING:
        return status
    frame = still = -1
    for i in range(ws.model.n_half_spaces):
        wall = ws.half_spaces[i]
        # the walls of one frame follow one another
        if wall.frame != frame:
            frame, still = wall.frame, _is_still(ws.floats, wall.frame)
        clear = still == 1 and wall.is_steady and _is_clear(ws, i)
        if not clear and not _enter_row(ws, wall.row):
            return _full(ws, margin)
    axis = _widest_axis(ws)
    _sort_units(ws, axis)
    for i in range(ws.model.n_spheres):
        one = ws.island.sphere_order[i]
        unit = ws.spheres[one]
        end = unit.places[axis] + unit.radius + ws.island.list_margin
        for j in range(i + 1, ws.model.n_spheres):
            two = ws.island.sphere_order[j]
            if _begin(ws, two, axis) > end:
                break
            if are_near(ws, one, two) and not _enter_pair(ws, min(one, two), max(one, two)):
                return _full(ws, margin)
    ws.island.n_histories = 0
    return Status.RUNNING


@kernel("f8(ws, i8)")
def _way(ws: Workspace, number: int) -> float:
    """Return how far a unit is from where it was listed, and its farthest point if turning counts."""
    unit = ws.spheres[number]
    frame = frame_at(ws.floats, unit.frame)
    way, lever = distance(frame.origin, unit.place), unit.feature_radius
    if lever > 0.0:
        square = 0.0
        for i in range(9):
            square += (frame.rotation[i] - unit.axes[i]) ** 2
        way += lever * math.sqrt(0.5 * square)
    return float(way)


@kernel("f8(ws, i8)")
def _unit_speed(ws: Workspace, number: int) -> float:
    unit = ws.spheres[number]
    frame = frame_at(ws.floats, unit.frame)
    speed = math.sqrt(dot(frame.velocity, frame.velocity))
    if unit.feature_radius > 0.0:
        speed += unit.feature_radius * math.sqrt(dot(frame.spin, frame.spin))
    return speed


@kernel("f8(ws)")
def longest_step(ws: Workspace) -> float:
    """Return for how long the list holds, the bodies being evaluated; 0 if it must be drawn anew."""
    longest = math.inf
    for number in range(ws.model.n_spheres):
        unit, way, speed = ws.spheres[number], _way(ws, number), _unit_speed(ws, number)
        left = 0.5 * ws.island.list_margin - way
        unit.distance, unit.speed = way, speed
        if left < 0.5 * (1.0 - _SPENT) * ws.island.list_margin:
            return 0.0
        if speed * longest * _ACCELERATION > left:
            longest = left / (_ACCELERATION * speed)
    return longest


@kernel("b1(ws, f8)")
def overran_list(ws: Workspace, h: float) -> bool:
    """Return 1 if some unit may have left its way in a step of ``h``, the bodies being evaluated at its end.

    No point of a path of length l between two points is farther off than half of l and of the ends' distances.
    """
    for unit in ws.spheres:
        path = h * max(unit.speed, _unit_speed(ws, unit.index))
        if unit.distance + _way(ws, unit.index) + path > ws.island.list_margin:
            return True
    return False
