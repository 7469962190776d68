"""Jump of a contact point: a flat part of a surface rolls over another one, and the contact point moves at once.

If a surface has no curvature, its contact point is infinitely fast, and so is its acceleration. Close to the middle of
a superellipsoid's face or to a flat line, steps shrink to zero. But the impulse of the contact stays finite. So the
bodies do not move while the contact point moves from its old to its new place, in short stretches. The contact stays
closed, so its impulse neither stores nor supplies energy: in each stretch the part of the velocity that the contact
resists is reflected, by twice the impulse that would stop it. An inelastic impact at the new place would lose energy
that the smooth motion keeps.
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
from nonsmooth.engine.memory.layout import DRIVEN, EXCHANGED, FRICTION_LOSS, NORMAL_ROW
from nonsmooth.engine.memory.modes import NO_CONTACT, NO_RELEASE, Cause, Mode
from nonsmooth.engine.native.kernel import Workspace, frame_at, kernel
from nonsmooth.engine.numerics.tolerances import ALLOWED
from nonsmooth.engine.numerics.vectors import Vector, dot, length, minus, scaled

_STRETCH = 0.01
"""Displacement of a contact point in one stretch, relative to the size of the smaller body."""
_MOST_STRETCHES = 100
"""Most stretches of a jump, so that it ends in bounded time."""
_LEAST_SPEED_RATIO = 3.0
"""Speed of a contact point, relative to that of its bodies, above which it jumps."""


@kernel("i8(ws)")
def _store_displacements(ws: Workspace) -> int:
    """Store the displacements of the contact points from before the jump to now [m]. Number of stretches of the jump.

    A stretch is a part of the displacement that is short compared with the bodies. Impulses act in each of them. Of
    very long displacements the stretches are longer, as their number is limited.
    """
    longest = 0.0
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        a = minus(contact.point_a, contact.point_a_before_jump)
        b = minus(contact.point_b, contact.point_b_before_jump)
        contact.jump_a, contact.jump_b = a, b
        longest = max(longest, dot(a, a) / contact.size**2, dot(b, b) / contact.size**2)
    return min(_MOST_STRETCHES, 1 + int(longest**0.5 / _STRETCH))


@kernel("void(ws, f8)")
def _set_up_problem(ws: Workspace, part: float) -> None:
    """Move the points of the active contacts by a ``part`` of their displacements, and write the contact problem there.

    It has gap rates and slips [m/s] in place of accelerations, and impulses [N s] in place of forces. A contact that
    the jump has released in an earlier stretch, with its cause in ``release``, stays open or sliding.
    """
    ws.problem.acceleration_scale = 0.0
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        contact.point_a = _moved(contact.point_a_before_jump, part, contact.jump_a)
        contact.point_b = _moved(contact.point_b_before_jump, part, contact.jump_b)
        # the points are not those of the bodies' positions, so the contact must not count as evaluated
        contact.version_a = NOT_EVALUATED
        evaluate_rates(ws, active.contact)
        evaluate_jacobian(ws, active.contact)
        speed = length(contact.slip)
        active.static_coefficient = friction_coefficient(ws, active.contact, speed=0.0)
        active.friction_coefficient = slip_coefficient(ws, active.contact, speed)
        sticks = contact.mode == Mode.STICK and contact.release == NO_RELEASE
        # the impulse of a contact that has lifted off is known to be 0
        active.is_normal_force_unknown = contact.release != Cause.LIFT_OFF
        active.sticks = sticks and active.static_coefficient > 0.0
        # a slip within the velocity tolerance keeps its direction
        active.direction = contact.direction
        if speed > ws.tolerance.velocity:
            active.direction = contact.slip[0] / speed, contact.slip[1] / speed
        for r in range(3):
            active.free[r] = contact.rate[r]
            # the largest rate: the impulse that counts as zero is relative to that which stops it
            ws.problem.acceleration_scale = max(ws.problem.acceleration_scale, abs(contact.rate[r]))
    assemble_delassus(ws)


@kernel("v3(v3, f8, v3)")
def _moved(point: Vector, part: float, displacement: Vector) -> Vector:
    """Point [m] after a ``part`` of a displacement [m]."""
    x, y, z = scaled(part, displacement)
    return point[0] + x, point[1] + y, point[2] + z


@kernel("i8(ws)")
def _release(ws: Workspace) -> int:
    """Open the active contacts that pull, and let those past their static bound slide. Number of these contacts.

    The cause of each is written to ``release``, by which they stay released in later stretches of the jump.
    """
    n_released = 0
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        round_off = small_force(ws, active.index)
        if active.is_normal_force_unknown and active.normal_force < -round_off:
            contact.release, active.is_normal_force_unknown, active.sticks = Cause.LIFT_OFF, False, False
            n_released += 1
        elif active.sticks and length(active.friction) > active.static_coefficient * active.normal_force + round_off:
            (t1, t2), norm = active.friction, length(active.friction)
            contact.release, active.sticks = Cause.STICK_TO_SLIP, False
            # the slip begins against the friction that held the contact
            contact.direction = active.direction = -t1 / norm, -t2 / norm
            n_released += 1
    return n_released


@kernel("void(ws, f8)")
def _apply_impulses(ws: Workspace, part: float) -> None:
    """Apply the impulses of the active contacts at a ``part`` of their displacements to ``y_new``.

    In the middle of a stretch they reverse the part of the velocity that the contacts resist. So this part is zero on
    average over the stretch. Only friction dissipates. The work goes to the energy accounts of ``y_new``.
    """
    _set_up_problem(ws, part)
    # each round releases a contact, and a contact can be released twice: from sticking, and from sliding
    for _round in range(2 * ws.problem.n_active + 1):
        # an impulse of a contact that was released must not remain
        for i in range(3 * ws.problem.n_active):
            ws.problem.forces[i] = 0.0
        resolve(ws)
        if _release(ws) == 0:
            break
    # these impulses stop the rates, twice as large ones reverse them
    for i in range(3 * ws.problem.n_active):
        ws.problem.forces[i] *= 2.0
    add_response(ws, ws.problem.forces.start, ws.step.y_new.start + ws.model.n_q)
    powers = ws.step.y_new.start + ws.model.n_q + ws.model.n_u
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        for r in range(3):
            impulse = active.force[r]
            # work of driven bodies, which prescribe a part of the rates
            ws.floats[powers + DRIVEN] -= impulse * contact.prescribed_rate[r]
            ws.floats[powers + EXCHANGED] += abs(impulse * contact.prescribed_rate[r])
            if r != NORMAL_ROW and not active.sticks:
                # the mean of the slips before and after the impulse
                rate = 0.5 * add_product(ws, 2.0 * contact.rate[r], active.index, r, ws.problem.forces.start)
                lost = -impulse * rate
                ws.floats[powers + FRICTION_LOSS] += lost
                ws.floats[powers + EXCHANGED] += abs(lost)


@kernel()
def _store_points(ws: Workspace) -> None:
    """Evaluate the grouped contacts at the present state, and store their contact points as those before a jump [m]."""
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        evaluate_geometry(ws, contact.index)
        contact.point_a_before_jump, contact.point_b_before_jump = contact.point_a, contact.point_b


@kernel("i8(ws, f8, f8)")
def _jumping_contact(ws: Workspace, h: float, rate: float) -> int:
    """Contact whose point jumps in the time ``h`` [s]: it moves much faster than its bodies, to where they approach.

    Their gap rate there must be below ``rate`` [m/s]. The speed of the bodies is that of slip and relative turning.
    They must be evaluated at the end of that time. The point is that on the second body. The last such contact is
    returned, or ``NO_CONTACT``. Evaluates geometry and rates of the grouped contacts.
    """
    which = NO_CONTACT
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        evaluate_geometry(ws, contact.index)
        evaluate_rates(ws, contact.index)
        spin_a, spin_b = frame_at(ws.floats, contact.frame_a).spin, frame_at(ws.floats, contact.frame_b).spin
        turning, moved = minus(spin_b, spin_a), minus(contact.point_b, contact.point_b_before_jump)
        speed = length(contact.slip) + contact.size * math.sqrt(dot(turning, turning))
        if contact.normal_rate < rate and dot(moved, moved) > (_LEAST_SPEED_RATIO * h * speed) ** 2:
            which = contact.index
    return which


@kernel()
def evaluate_force_round_off(ws: Workspace) -> None:
    """Write the force that counts as zero after a jump to ``force_round_off`` of the grouped contacts [N].

    It is a part of the largest normal force, or force that would stop the bias, the acceleration at constant
    velocities. Forces before the jump are no measure of it: close to the flat place they may be unbounded.
    """
    right_hand_side(ws, ws.island.time, ws.island.y.start, may_choose=False, of_all_bodies=True)
    largest = 0.0
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        largest = max(largest, abs(contact.force[0]))
        # slip acceleration per unit of friction [1/kg], as a measure of the inverse mass
        if contact.slip_per_force > 0.0:
            largest = max(largest, abs(contact.bias[0]) / contact.slip_per_force)
    for i in range(ws.island.n_grouped):
        ws.contacts[ws.island.grouped[i]].force_round_off = NO_FORCE * largest


@kernel("b1(ws, f8)")
def jump_contact_points(ws: Workspace, h: float) -> bool:
    """Write the state after the time ``h`` [s], which is too short for a step, to ``y_new``, if a contact point jumps.

    A point jumps if it moves much faster than its bodies, as where a flat part of a surface rolls over another one. The
    jump is made in short stretches, with impulses that keep the contacts closed in the middle of each. True if one
    jumps. ``slopes`` must hold the slope at ``y``, and the closed contacts must be grouped. ``release`` becomes the
    cause by which the impulses released a contact.
    """
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        # a compliant contact has a known force and needs no impulse
        if contact.is_compliant:
            return False
        contact.release = NO_RELEASE
    _store_points(ws)
    # coordinates along a straight line; impulses change the velocities
    for i in range(ws.model.n_y):
        ws.step.y_new[i] = ws.island.y[i] + (h * ws.island.slopes[i] if i < ws.model.n_q else 0.0)
    evaluate_bodies(ws, ws.island.time + h, ws.step.y_new.start)
    # any approach at the new point counts
    if _jumping_contact(ws, h, rate=0.0) == NO_CONTACT:
        return False
    n_stretches = _store_displacements(ws)
    for stretch in range(n_stretches):
        for group in range(ws.island.n_groups):
            activate_group(ws, group)
            # in the middle of the stretch
            _apply_impulses(ws, (stretch + 0.5) / n_stretches)
        # the next stretch begins with the new velocities
        evaluate_bodies(ws, ws.island.time + h, ws.step.y_new.start)
    return True


@kernel("i8(ws)")
def contact_past_flat_place(ws: Workspace) -> int:
    """Closed contact whose point jumped within the step that was taken, or ``NO_CONTACT``.

    After such a step the bodies approach faster than the tolerances allow: a face has fallen flat, and now the other
    side of its rim is the lower one. Compliant and averaged contacts may approach, and past the end of its features a
    contact has no rate. If some contact approaches, evaluates the bodies at the end of the step.
    """
    approaches, allowed = False, ALLOWED * ws.tolerance.velocity
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        is_held = not contact.is_compliant and not contact.is_averaged and contact.past_feature_at_end <= 0.0
        if is_held and contact.velocity_at_end[0] < -allowed:
            approaches = True
    if not approaches:
        return NO_CONTACT
    _store_points(ws)
    evaluate_bodies(ws, ws.island.time + ws.step.h, ws.step.y_new.start)
    return _jumping_contact(ws, ws.step.h, -allowed)
