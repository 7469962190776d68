"""The instant in which a contact point runs along a body: a flat place rolls over another surface.

Where a body has no curvature its point of contact is infinitely fast, and so is its acceleration: next to the middle of
a boxy face or of a flat line steps shrink to nothing.  What the contact gives to the bodies stays finite.  While they
stand still the point runs from where it was to where it is, and as it stays closed all the way its impulse neither
stores nor gives energy.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.kinematics import NOT_EVALUATED, evaluate_geometry, evaluate_jacobian, evaluate_rates
from nonsmooth.engine.contact.forces import resolve
from nonsmooth.engine.contact.problem import friction_coefficient, slip_coefficient
from nonsmooth.engine.contact.trial import NO_FORCE, small_force
from nonsmooth.engine.delassus.delassus import add_product, add_response, assemble_delassus
from nonsmooth.engine.delassus.islands import activate_group
from nonsmooth.engine.flow.flow import right_hand_side
from nonsmooth.engine.flow.self_check import ALLOWED
from nonsmooth.engine.memory.layout import DRIVEN, EXCHANGED, FRICTION_LOSS
from nonsmooth.engine.memory.modes import NO_RELEASE, Cause, Mode
from nonsmooth.engine.native.kernel import Workspace, frame_at, kernel
from nonsmooth.engine.numerics.vectors import dot, length, minus

_STRETCH = 0.01
"""Way of a contact point in one stretch, in units of the smaller body;"""
_MOST_STRETCHES = 100
"""so many stretches at most."""
_LEAST_SPEED_RATIO = 3.0
"""A point that runs is so many times as fast as the bodies at least."""


@kernel("i8(ws)")
def _store_displacements(ws: Workspace) -> int:
    """Keep the ways of the contact points from where they were to where they are; return in how many stretches."""
    longest = 0.0
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        way_a = minus(contact.point_a, contact.leap_start_a)
        way_b = minus(contact.point_b, contact.leap_start_b)
        contact.leap_a, contact.leap_b = way_a, way_b
        longest = max(longest, dot(way_a, way_a) / contact.size**2, dot(way_b, way_b) / contact.size**2)
    return min(_MOST_STRETCHES, 1 + int(longest**0.5 / _STRETCH))


@kernel("void(ws, f8)")
def _set_up_problem(ws: Workspace, part: float) -> None:
    """Put the active contacts at a ``part`` of their ways, and write what they hold, how they rub, and the rates."""
    ws.problem.acceleration_scale = 0.0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        c = active.contact
        contact = ws.contacts[c]
        (ax, ay, az), (bx, by, bz) = contact.leap_a, contact.leap_b
        contact.point_a = (
            contact.leap_start_a[0] + part * ax,
            contact.leap_start_a[1] + part * ay,
            contact.leap_start_a[2] + part * az,
        )
        contact.point_b = (
            contact.leap_start_b[0] + part * bx,
            contact.leap_start_b[1] + part * by,
            contact.leap_start_b[2] + part * bz,
        )
        contact.version_a = NOT_EVALUATED
        evaluate_rates(ws, c)
        evaluate_jacobian(ws, c)
        speed = length(contact.slip)
        active.static_coefficient = friction_coefficient(ws, c, 0.0)
        active.friction_coefficient = slip_coefficient(ws, c, speed)
        sticks = contact.mode == Mode.STICK and contact.release == NO_RELEASE
        active.is_normal_force_unknown = contact.release != Cause.LIFT_OFF
        active.sticks = sticks and active.static_coefficient > 0.0
        active.direction = contact.direction
        if speed > ws.tolerance.velocity:
            active.direction = contact.slip[0] / speed, contact.slip[1] / speed
        for r in range(3):
            active.free[r] = contact.rate[r]
            ws.problem.acceleration_scale = max(ws.problem.acceleration_scale, abs(contact.rate[r]))
    assemble_delassus(ws)


@kernel("i8(ws)")
def _release(ws: Workspace) -> int:
    """Release the contacts that pull from all, and those past their static bound from sticking; return how many."""
    released = 0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        contact = ws.contacts[active.contact]
        faint = small_force(ws, a)
        if active.is_normal_force_unknown and active.normal_force < -faint:
            contact.release, active.is_normal_force_unknown, active.sticks = Cause.LIFT_OFF, False, False
            released += 1
        elif active.sticks and length(active.friction) > active.static_coefficient * active.normal_force + faint:
            (t1, t2), norm = active.friction, length(active.friction)
            contact.release, active.sticks = Cause.STICK_TO_SLIP, False
            contact.direction = active.direction = -t1 / norm, -t2 / norm
            released += 1
    return released


@kernel("void(ws, f8)")
def _apply_impulses(ws: Workspace, part: float) -> None:
    """Let the active contacts act at a ``part`` of their ways, without loss but by friction.

    What they hold of the velocities changes its sign in the middle of a stretch, at whose ends nothing is left of it.
    """
    _set_up_problem(ws, part)
    for _round in range(2 * ws.problem.n_active + 1):
        for i in range(3 * ws.problem.n_active):
            ws.problem.forces[i] = 0.0
        resolve(ws)
        if _release(ws) == 0:
            break
    for i in range(3 * ws.problem.n_active):
        ws.problem.forces[i] *= 2.0
    add_response(ws, ws.problem.forces.start, ws.step.y_new.start + ws.model.n_q)
    powers = ws.step.y_new.start + ws.model.n_q + ws.model.n_u
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        contact = ws.contacts[active.contact]
        for r in range(3):
            impulse = active.force[r]
            ws.floats[powers + DRIVEN] -= impulse * contact.prescribed_rate[r]
            ws.floats[powers + EXCHANGED] += abs(impulse * contact.prescribed_rate[r])
            if r > 0 and not active.sticks:
                lost = -impulse * 0.5 * add_product(ws, 2.0 * contact.rate[r], a, r, ws.problem.forces.start)
                ws.floats[powers + FRICTION_LOSS] += lost
                ws.floats[powers + EXCHANGED] += abs(lost)


@kernel()
def _store_points(ws: Workspace) -> None:
    """Keep where the contact points are at ``y``."""
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    for i in range(ws.island.n_grouped):
        c = ws.island.grouped[i]
        contact = ws.contacts[c]
        evaluate_geometry(ws, c)
        contact.leap_start_a, contact.leap_start_b = contact.point_a, contact.point_b


@kernel("i8(ws, f8, f8)")
def _jumping_contact(ws: Workspace, h: float, rate: float) -> int:
    """Return a contact whose point has run in the time ``h``, faster than the bodies go, to where they approach, or -1.

    That is by more than a gap ``rate``, the bodies being evaluated at its end.
    """
    runs = -1
    for i in range(ws.island.n_grouped):
        c = ws.island.grouped[i]
        evaluate_geometry(ws, c)
        evaluate_rates(ws, c)
        contact = ws.contacts[c]
        spin_a, spin_b = frame_at(ws.floats, contact.frame_a).spin, frame_at(ws.floats, contact.frame_b).spin
        turning, way = minus(spin_b, spin_a), minus(contact.point_b, contact.leap_start_b)
        speed = length(contact.slip) + contact.size * math.sqrt(dot(turning, turning))
        if contact.rate[0] < rate and dot(way, way) > (_LEAST_SPEED_RATIO * h * speed) ** 2:
            runs = c
    return runs


@kernel()
def evaluate_force_round_off(ws: Workspace) -> None:
    """Write what counts as no force behind a leap: before it, next to the flat place, forces may have had no bound."""
    right_hand_side(ws, ws.island.time, ws.island.y.start, may_choose=False, of_all_bodies=True)
    largest = 0.0
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        largest = max(largest, abs(contact.force[0]))
        if contact.slip_per_force > 0.0:
            largest = max(largest, abs(contact.bias[0]) / contact.slip_per_force)
    for i in range(ws.island.n_grouped):
        ws.contacts[ws.island.grouped[i]].force_round_off = NO_FORCE * largest


@kernel("b1(ws, f8)")
def jump_contact_points(ws: Workspace, h: float) -> bool:
    """Write the state after the time ``h``, too short for steps, to ``y_new``; return 1 if contact points run in it.

    ``slopes`` must hold the slope at ``y``, and the closed contacts be grouped.  What the impulses let go is
    ``released``, by the cause that it means.
    """
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        if contact.is_compliant:
            return False
        contact.release = NO_RELEASE
    _store_points(ws)
    for i in range(ws.model.n_y):
        ws.step.y_new[i] = ws.island.y[i] + (h * ws.island.slopes[i] if i < ws.model.n_q else 0.0)
    evaluate_bodies(ws, ws.island.time + h, ws.step.y_new.start)
    if _jumping_contact(ws, h, 0.0) < 0:
        return False
    n = _store_displacements(ws)
    for stretch in range(n):
        for group in range(ws.island.n_groups):
            activate_group(ws, group)
            _apply_impulses(ws, (stretch + 0.5) / n)
        evaluate_bodies(ws, ws.island.time + h, ws.step.y_new.start)
    return True


@kernel("i8(ws)")
def contact_past_flat_place(ws: Workspace) -> int:
    """Return a held contact whose point ran along a body within the step that was taken, or -1.

    Behind it they approach faster than tolerances explain of what is held: a face has fallen flat, and the other side
    of its rim is the lower one.
    """
    approaches, explained = False, ALLOWED * ws.tolerance.velocity
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        held = not contact.is_compliant and not contact.is_averaged and contact.past_feature_at_end <= 0.0
        if held and contact.velocity_at_end[0] < -explained:
            approaches = True
    if not approaches:
        return -1
    _store_points(ws)
    evaluate_bodies(ws, ws.island.time + ws.step.h, ws.step.y_new.start)
    return _jumping_contact(ws, ws.step.h, -explained)
