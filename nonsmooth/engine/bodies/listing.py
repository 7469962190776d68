"""Which of the declared contacts stand in slots: all of a small system, those near each other of a large one.

A unit is a frame that carries bounded shapes, all within a ball about its origin.  The list holds the pairs of units
whose balls are nearer than a margin, found by sorting the balls along an axis and sweeping over them, and every contact
with an unbounded shape.  It stands until some unit has moved by half the margin; of a unit with pools of features
(:mod:`nonsmooth.engine.bodies.pools`), until some point of it has.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.pools import fill_pools, is_empty
from nonsmooth.engine.memory.blocks import GEOMETRY, PAIR, ROTATION, SPIN, VELOCITY
from nonsmooth.engine.memory.layout import (
    CATALOGUE,
    CATALOGUE_FLOATS,
    CLOSING_RATE,
    CONTACT_TIME,
    DIRECTION,
    LEVERS,
    REACH,
    SIZE,
)
from nonsmooth.engine.memory.modes import NO_SLOT, RUNNING
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, kernel, room

_WIDTH = len(CATALOGUE)
_MODE = CATALOGUE.index("mode")
_SPENT = 0.6
"""A list is drawn anew when a unit has used up this part of its way."""
_NARROWEST = 2.0**-12
"""Least part of its widest margin that the list may have, where pools cannot hold what is nearer."""
_ACCELERATION = 2.0
"""By how much a unit is taken to speed up within a step; the step is checked afterwards."""


@kernel("i8(S, F, I, i8)")
def _enter(S: Scalars, w: Floats, k: Integers, declared: int) -> int:
    """Put a declared contact into the next slot, unless it is empty; return 0 if there is no slot."""
    if is_empty(S, w, k, declared) == 1:
        return 1
    if S.n_contacts == S.n_slots:
        return 0
    c = S.n_contacts
    row, floats = S.catalogue + _WIDTH * declared, S.catalogue_floats + CATALOGUE_FLOATS * declared
    # the arrays of the catalogue's entries follow one another
    for i in range(_WIDTH):
        k[S.body_a + i * S.n_slots + c] = k[row + i]
    w[S.contact_time + c], w[S.reach + c] = w[floats + CONTACT_TIME], w[floats + REACH]
    w[S.closing_rate + c], w[S.size + c] = w[floats + CLOSING_RATE], w[floats + SIZE]
    w[S.lever_a + c], w[S.lever_b + c] = w[floats + LEVERS], w[floats + LEVERS + 1]
    w[S.direction + 2 * c], w[S.direction + 2 * c + 1] = w[floats + DIRECTION], w[floats + DIRECTION + 1]
    k[S.facing + c] = 1
    k[S.touching + c] = 0
    k[S.identity + c] = declared
    # a pair writes what of its block can be other than zero; the contact that had the slot may have left more
    for i in range(PAIR):
        w[S.geometry + GEOMETRY * c + i] = 0.0
    # Jacobians keep zeros where other bodies of a linkage stand
    for side in range(2):
        n_u = k[S.linkage_nu + (k[S.linkage_a + c] if side == 0 else k[S.linkage_b + c])]
        jacobian = k[S.jacobian_a + c] if side == 0 else k[S.jacobian_b + c]
        for i in range(3 * n_u):
            w[jacobian + i] = 0.0
    S.n_contacts += 1
    return 1


@kernel("void(S, F, I)")
def _leave(S: Scalars, w: Floats, k: Integers) -> None:
    """Empty all slots; modes and slip directions go back to the catalogue."""
    for c in range(S.n_contacts):
        declared = k[S.identity + c]
        floats = S.catalogue_floats + CATALOGUE_FLOATS * declared
        k[S.catalogue + _WIDTH * declared + _MODE] = k[S.mode + c]
        for i in range(2):
            w[floats + DIRECTION + i] = w[S.direction + 2 * c + i]
        w[floats + CLOSING_RATE] = w[S.closing_rate + c]
    S.n_contacts = 0


@kernel("i8(S, F, I, i8, i8)")
def _enter_pair(S: Scalars, w: Floats, k: Integers, one: int, two: int) -> int:
    """Enter the contacts of two units, if there are any; return 0 if there is no slot."""
    low, high = k[S.unit_partner + one], k[S.unit_partner + one + 1]
    end = high
    while low < high:
        middle = (low + high) // 2
        if k[S.partner_unit + middle] < two:
            low = middle + 1
        else:
            high = middle
    if low == end or k[S.partner_unit + low] != two:
        return 1
    for i in range(k[S.partner_contact + low], k[S.partner_contact + low + 1]):
        if _enter(S, w, k, k[S.paired_contact + i]) == 0:
            return 0
    return 1


@kernel("void(S, F, I, i8)")
def _sort_units(S: Scalars, w: Floats, k: Integers, axis: int) -> None:
    """Sort the units by where their balls begin along an axis; they nearly are, from the last time."""
    for i in range(1, S.n_units):
        unit = k[S.unit_order + i]
        begin = w[S.unit_place + 3 * unit + axis] - w[S.unit_radius + unit]
        j = i - 1
        while j >= 0:
            other = k[S.unit_order + j]
            if w[S.unit_place + 3 * other + axis] - w[S.unit_radius + other] <= begin:
                break
            k[S.unit_order + j + 1] = other
            j -= 1
        k[S.unit_order + j + 1] = unit


@kernel("i8(S, F, I)")
def _widest_axis(S: Scalars, w: Floats, k: Integers) -> int:
    best, widest = 0, -1.0
    for axis in range(3):
        low, high = 1e300, -1e300
        for unit in range(S.n_units):
            low = min(low, w[S.unit_place + 3 * unit + axis])
            high = max(high, w[S.unit_place + 3 * unit + axis])
        if high - low > widest:
            best, widest = axis, high - low
    return best


@room("i8(S, F, I)")
def list_contacts(S: Scalars, w: Floats, k: Integers) -> int:
    """Fill the slots for the present state; return the status."""
    _leave(S, w, k)
    S.fresh = 0
    S.listings += 1
    if S.n_units == 0:
        for declared in range(S.n_declared):
            _enter(S, w, k, declared)
        return RUNNING
    evaluate_bodies(S, w, k, S.t, S.y)
    for unit in range(S.n_units):
        for i in range(3):
            w[S.unit_place + 3 * unit + i] = w[k[S.unit_frame + unit] + i]
        for i in range(9):
            w[S.unit_axes + 9 * unit + i] = w[k[S.unit_frame + unit] + ROTATION + i]
    S.margin_of_list = min(S.widest_margin, 2.0 * S.margin_of_list)
    status = fill_pools(S, w, k)
    while status == NO_SLOT and S.margin_of_list > _NARROWEST * S.widest_margin:
        S.margin_of_list *= 0.5
        status = fill_pools(S, w, k)
    if status != RUNNING:
        return status
    for i in range(k[S.partner_contact + S.n_partners], S.n_paired):
        if _enter(S, w, k, k[S.paired_contact + i]) == 0:
            return NO_SLOT
    axis = _widest_axis(S, w, k)
    _sort_units(S, w, k, axis)
    for i in range(S.n_units):
        one = k[S.unit_order + i]
        end = w[S.unit_place + 3 * one + axis] + w[S.unit_radius + one] + S.margin_of_list
        for j in range(i + 1, S.n_units):
            two = k[S.unit_order + j]
            if w[S.unit_place + 3 * two + axis] - w[S.unit_radius + two] > end:
                break
            square = 0.0
            for r in range(3):
                square += (w[S.unit_place + 3 * one + r] - w[S.unit_place + 3 * two + r]) ** 2
            near = w[S.unit_radius + one] + w[S.unit_radius + two] + S.margin_of_list
            if square <= near * near and _enter_pair(S, w, k, min(one, two), max(one, two)) == 0:
                return NO_SLOT
    return RUNNING


@kernel("f8(S, F, I, i8)")
def _way(S: Scalars, w: Floats, k: Integers, unit: int) -> float:
    """Return how far a unit is from where it was listed, and its farthest point if turning counts."""
    frame, square, lever = k[S.unit_frame + unit], 0.0, w[S.unit_lever + unit]
    for i in range(3):
        square += (w[frame + i] - w[S.unit_place + 3 * unit + i]) ** 2
    way = math.sqrt(square)
    if lever > 0.0:
        square = 0.0
        for i in range(9):
            square += (w[frame + ROTATION + i] - w[S.unit_axes + 9 * unit + i]) ** 2
        way += lever * math.sqrt(0.5 * square)
    return way


@kernel("f8(S, F, I, i8)")
def _unit_speed(S: Scalars, w: Floats, k: Integers, unit: int) -> float:
    v, o = k[S.unit_frame + unit] + VELOCITY, k[S.unit_frame + unit] + SPIN
    speed = math.sqrt(w[v] * w[v] + w[v + 1] * w[v + 1] + w[v + 2] * w[v + 2])
    lever = w[S.unit_lever + unit]
    if lever > 0.0:
        speed += lever * math.sqrt(w[o] * w[o] + w[o + 1] * w[o + 1] + w[o + 2] * w[o + 2])
    return speed


@kernel("f8(S, F, I)")
def longest_step(S: Scalars, w: Floats, k: Integers) -> float:
    """Return for how long the list holds, the bodies being evaluated; 0 if it must be drawn anew."""
    longest = 1e300
    for unit in range(S.n_units):
        way, speed = _way(S, w, k, unit), _unit_speed(S, w, k, unit)
        left = 0.5 * S.margin_of_list - way
        w[S.unit_way + unit], w[S.unit_speed + unit] = way, speed
        if left < 0.5 * (1.0 - _SPENT) * S.margin_of_list:
            return 0.0
        if speed * longest * _ACCELERATION > left:
            longest = left / (_ACCELERATION * speed)
    return longest


@kernel("i8(S, F, I, f8)")
def overran_list(S: Scalars, w: Floats, k: Integers, h: float) -> int:
    """Return 1 if some unit may have left its way in a step of ``h``, the bodies being evaluated at its end.

    No point of a path of length l between two points is farther off than half of l and of the ends' distances.
    """
    for unit in range(S.n_units):
        length = h * max(w[S.unit_speed + unit], _unit_speed(S, w, k, unit))
        if w[S.unit_way + unit] + _way(S, w, k, unit) + length > S.margin_of_list:
            return 1
    return 0
