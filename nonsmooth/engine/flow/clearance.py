"""Proof that open gaps stay open within a step, or a place where one has closed.

What is known of a gap are its values and rates at both ends of a part of a step, how fast it can change at most, from
the relative velocity and turning of the bodies and the levers of their shapes, and how fast its rate can fall, from
their relative accelerations.  Where these do not show that the gap stays open, the part is halved, until they do,
or the gap has closed at one of the ends, or no dip deeper than the gap tolerance has room.

The bounds hold if within a step no speed exceeds the sum of those at its ends, as the error control of the step sees
to.  Features that do not face each other have no rate: theirs are sampled (:mod:`nonsmooth.engine.flow.location`).
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_body, evaluate_driven_bodies
from nonsmooth.engine.bodies.kinematics import evaluate_geometry, evaluate_rates
from nonsmooth.engine.flow.guard_numbers import normal_guard
from nonsmooth.engine.flow.guards import grown, has_fired
from nonsmooth.engine.memory.blocks import (
    ACCELERATION,
    FRAME,
    GEOMETRY,
    NORMAL,
    SPIN,
    VELOCITY,
)
from nonsmooth.engine.memory.layout import FALL, LAST_STAGE, SECTOR, SECTORS
from nonsmooth.engine.memory.modes import OPEN
from nonsmooth.engine.native.kernel import (
    Floats,
    Integers,
    Scalars,
    body_at,
    contact_at,
    entry_point,
    frame_at,
    guard_at,
    kernel,
)
from nonsmooth.engine.numerics.runge_kutta import dense_part
from nonsmooth.engine.numerics.vectors import minus

_CURVED = 4.0
"""By so much a curved surface or an edge may turn the normal faster than its body turns."""
_THETA, _GAP, _RATE, _PAST, _ARM = 0, 1, 2, 3, 4
"""Where these stand in what is kept of an end of a part of a step."""
_NOW, _GROWTH, _TURNING = 0, 1, 2
"""Where these stand in how fast the rate of a gap can fall."""
WAY = 0.02
"""Part of the size of the smaller body that features may move unseen where they do not face each other."""
_RESTS = 10.0
"""A gap and a rate of so many tolerances at both ends are those of neighbours at rest, which are sampled."""
_COARSE = 0.125
"""Part of a step to which the gap of neighbours at rest is looked at."""


@kernel("f8(F, i8, i8)")
def _dot(w: Floats, a: int, b: int) -> float:
    return w[a] * w[b] + w[a + 1] * w[b + 1] + w[a + 2] * w[b + 2]


@kernel("void(F, i8, i8, f8, i8)")
def _add_cross(w: Floats, a: int, b: int, factor: float, out: int) -> None:
    """Add ``factor`` a x b."""
    w[out] += factor * (w[a + 1] * w[b + 2] - w[a + 2] * w[b + 1])
    w[out + 1] += factor * (w[a + 2] * w[b] - w[a] * w[b + 2])
    w[out + 2] += factor * (w[a] * w[b + 1] - w[a + 1] * w[b])


@kernel("void(S, F, i8, i8)")
def _relative_motion(S: Scalars, w: Floats, a: int, b: int) -> None:
    """Write place, velocity and turning of frame ``b`` relative to frame ``a``, as seen from it, to ``relative``."""
    d = S.relative
    for i in range(3):
        w[d + i] = w[b + i] - w[a + i]
        w[d + 3 + i] = w[b + VELOCITY + i] - w[a + VELOCITY + i]
        w[d + 6 + i] = w[b + SPIN + i] - w[a + SPIN + i]
    _add_cross(w, a + SPIN, d, -1.0, d + 3)


@kernel("f8(F, i8, i8)")
def _speed_seen(w: Floats, a: int, b: int) -> float:
    """Return the speed of the origin of frame ``b`` as seen from frame ``a`` [m/s]."""
    x, y, z = w[b] - w[a], w[b + 1] - w[a + 1], w[b + 2] - w[a + 2]
    ox, oy, oz = w[a + SPIN], w[a + SPIN + 1], w[a + SPIN + 2]
    vx = w[b + VELOCITY] - w[a + VELOCITY] - oy * z + oz * y
    vy = w[b + VELOCITY + 1] - w[a + VELOCITY + 1] - oz * x + ox * z
    vz = w[b + VELOCITY + 2] - w[a + VELOCITY + 2] - ox * y + oy * x
    return math.sqrt(vx * vx + vy * vy + vz * vz)


@kernel("void(S, F, I)")
def bound_speeds(S: Scalars, w: Floats, k: Integers) -> None:
    """Write how fast the gaps of the open contacts can change where the bodies stand, to ``speed_end``.

    Seen from one body the other's surface moves along a normal no faster than its origin, and its lever by turning.
    """
    last_a = last_b = -1
    speed = turning = 0.0
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.mode != OPEN:
            continue
        a, b, lever = contact.frame_a, contact.frame_b, contact.lever_b
        if lever > contact.lever_a:
            a, b, lever = b, a, contact.lever_a
        # the contacts of two bodies follow one another
        if a != last_a or b != last_b:
            speed, turning = _speed_seen(w, a, b), -1.0
            last_a, last_b = a, b
        if lever > 0.0 and turning < 0.0:
            x, y, z = w[b + SPIN] - w[a + SPIN], w[b + SPIN + 1] - w[a + SPIN + 1], w[b + SPIN + 2] - w[a + SPIN + 2]
            turning = math.sqrt(x * x + y * y + z * z)
        contact.speed_end = speed + turning * lever if lever > 0.0 else speed
        if lever > 0.0:
            _write_arm(S, w, k, c, S.arm_end + 3 * c)


@kernel("void(S, F, I, i8, i8)")
def _write_arm(S: Scalars, w: Floats, k: Integers, c: int, out: int) -> None:
    """Write where the witness point of the body with the smaller lever is from its origin; its geometry is known."""
    contact = contact_at(S, w, k, c)
    if contact.lever_b <= contact.lever_a:
        arm = minus(contact.point_b, frame_at(w, contact.frame_b).origin)
    else:
        arm = minus(contact.point_a, frame_at(w, contact.frame_a).origin)
    w[out], w[out + 1], w[out + 2] = arm


@kernel("void(S, F, I, i8, i8, i8, i8)")
def _frame_acceleration(S: Scalars, w: Floats, k: Integers, c: int, side: int, du: int, out: int) -> None:
    """Write the acceleration of the origin of a frame and its angular acceleration."""
    contact = contact_at(S, w, k, c)
    frame = contact.frame_a if side == 0 else contact.frame_b
    n_u = contact.nu_a if side == 0 else contact.nu_b
    first = du + body_at(S, w, k, contact.body_a if side == 0 else contact.body_b).u
    for r in range(6):
        total = w[frame + ACCELERATION + r]
        for j in range(n_u):
            total += w[frame + FRAME + r * n_u + j] * w[first + j]
        w[out + r] = total


@kernel("void(S, F, I, i8, i8, i8)")
def write_fall(S: Scalars, w: Floats, k: Integers, c: int, du: int, out: int) -> None:
    """Write how fast the rate of the gap of ``c`` can fall, where the bodies stand and ``du`` are their accelerations.

    The second number is by how much more for every second of a step, the third how fast the bodies turn.  With the
    normal fixed to the first body a convex second one is no nearer than along this normal, whatever the normal does;
    the terms of the turning bodies hold for all points of its surface.
    """
    contact = contact_at(S, w, k, c)
    second = contact.lever_b <= contact.lever_a
    a, b = (contact.frame_a, contact.frame_b) if second else (contact.frame_b, contact.frame_a)
    _relative_motion(S, w, a, b)
    d = S.relative
    velocity, turning, of_a, of_b, carried = d + 3, d + 6, d + 9, d + 15, d + 21
    _frame_acceleration(S, w, k, c, 0 if second else 1, du, of_a)
    _frame_acceleration(S, w, k, c, 1 if second else 0, du, of_b)
    for i in range(6):
        w[of_b + i] -= w[of_a + i]
    # what the turning of the first body takes away: alpha x d, omega x (omega x d), twice omega x velocity
    _add_cross(w, of_a + 3, d, -1.0, of_b)
    for i in range(3):
        w[carried + i] = 0.0
    _add_cross(w, a + SPIN, d, -1.0, carried)
    _add_cross(w, a + SPIN, carried, 1.0, of_b)
    _add_cross(w, a + SPIN, velocity, -2.0, of_b)
    _add_cross(w, a + SPIN, turning, -1.0, of_b + 3)
    along = _dot(w, S.geometry + GEOMETRY * c + NORMAL, of_b)
    speed, rate = math.sqrt(_dot(w, velocity, velocity)), math.sqrt(_dot(w, turning, turning))
    lever = min(contact.lever_a, contact.lever_b)
    fall = max(0.0, -along if second else along)
    fall += (math.sqrt(_dot(w, of_b + 3, of_b + 3)) + rate * rate) * lever
    grows = 0.0
    if lever > 0.0:
        fall += _CURVED * rate * rate * lever
        grows = _CURVED * rate * math.sqrt(_dot(w, of_b, of_b))
        if max(contact.lever_a, contact.lever_b) < 1e300:
            fall += _CURVED * rate * speed
    w[out + _NOW], w[out + _GROWTH], w[out + _TURNING] = fall, grows, rate


@kernel("void(S, F, I, f8)")
def foresee(S: Scalars, w: Floats, k: Integers, h: float) -> None:
    """Keep how fast the rates of gaps that will be doubtful after a step of ``h`` can fall where it starts.

    The bodies stand there; later they would have to be put there.
    """
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        faces = contact.mode == OPEN and contact.past_first <= 0.0
        if faces and guard_at(S, w, k, normal_guard(c)).end <= 2.0 * h * contact.speed_first:
            write_fall(S, w, k, c, S.slopes + S.n_q, S.fall_first + FALL * c)


@kernel("i8(f8, f8, f8, f8, f8)")
def _too_far(g0: float, past0: float, g1: float, past1: float, way: float) -> int:
    """Return 1 if a gap does not close by speed alone, the surfaces moving by ``way`` at most between its two ends.

    Only what faces each other says how far it is apart; of what does so at neither end the smaller number stands in.
    """
    if past0 > 0.0:
        return 1 if (min(g0, g1) if past1 > 0.0 else g1) > way else 0
    return 1 if (g0 if past1 > 0.0 else g0 + g1) > way else 0


@entry_point("void(S, F, I, f8)")
def find_doubtful(S: Scalars, w: Floats, k: Integers, h: float) -> None:
    """List the open contacts whose gaps may close within the step by the speeds alone; the bodies stand at its end.

    Those whose features do not face each other at an end of the step are a list of their own.  How fast the rates of
    the others can fall there is kept, for this step and the next one.
    """
    S.n_doubtful = S.n_astray = 0
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        contact.fall_end[_NOW] = -1.0
        if contact.mode != OPEN:
            continue
        start = 0.0 if guard_at(S, w, k, normal_guard(c)).deflated == 1 else guard_at(S, w, k, normal_guard(c)).first
        way = h * (contact.speed_first + contact.speed_end)
        if _too_far(start, contact.past_first, contact.gap_end, contact.past_end, way) == 1:
            continue
        if contact.past_first > 0.0 or contact.past_end > 0.0:
            k[S.astray + S.n_astray] = c
            S.n_astray += 1
            continue
        write_fall(S, w, k, c, S.slopes + LAST_STAGE * S.n_y + S.n_q, S.fall_end + FALL * c)
        k[S.doubtful + S.n_doubtful] = c
        S.n_doubtful += 1


@kernel("void(S, F, I, f8, f8, i8)")
def _put(S: Scalars, w: Floats, k: Integers, h: float, theta: float, c: int) -> None:
    """Put the two bodies of a contact where they are at a fraction of the step, and evaluate its geometry."""
    contact = contact_at(S, w, k, c)
    S.looked = 1
    for side in range(2):
        number = contact.body_a if side == 0 else contact.body_b
        body = body_at(S, w, k, number)
        if body.nu == 0:
            evaluate_driven_bodies(S, w, k, S.t + theta * h, S.y)
            continue
        state = S.y if theta == 0.0 else S.y_new
        if 0.0 < theta < 1.0:
            state = S.y_stage
            for part in range(2):
                i = body.q if part == 0 else S.n_q + body.u
                n = body.nq if part == 0 else body.nu
                dense_part(S, w, S.y + i, S.slopes + i, n, S.n_y, h, theta, state + i)
        evaluate_body(S, w, k, S.t + theta * h, state, number)
    evaluate_geometry(S, w, k, c)


@kernel("f8(S, F, I, f8, i8)")
def _largest_fall(S: Scalars, w: Floats, k: Integers, h: float, c: int) -> float:
    """Return how fast the rate of the gap of ``c`` can fall within the step, from how fast it can at its ends."""
    first, last = S.fall_first + FALL * c, S.fall_end + FALL * c
    if w[first + _NOW] < 0.0:
        _put(S, w, k, h, 0.0, c)
        write_fall(S, w, k, c, S.slopes + S.n_q, first)
    start, end = w[first + _NOW] + h * w[first + _GROWTH], w[last + _NOW] + h * w[last + _GROWTH]
    return float(max(start, end) + abs(end - start))


@kernel("void(S, F, I, f8, f8, i8, i8)")
def _keep(S: Scalars, w: Floats, k: Integers, h: float, theta: float, c: int, out: int) -> None:
    """Write an end of a part of the step, at whose fraction ``theta`` the gap of ``c`` has been evaluated."""
    contact = contact_at(S, w, k, c)
    gap = contact.gap
    contact.gap_rate = contact.rate[0]
    guard_at(S, w, k, normal_guard(c)).value = grown(S, w, k, normal_guard(c), gap, theta * h)
    if guard_at(S, w, k, normal_guard(c)).value > 0.0:
        guard_at(S, w, k, normal_guard(c)).armed = 1
    w[out + _THETA], w[out + _RATE] = theta, contact.rate[0]
    w[out + _GAP] = (
        gap - guard_at(S, w, k, normal_guard(c)).start if guard_at(S, w, k, normal_guard(c)).deflated == 1 else gap
    )
    w[out + _PAST] = contact.beyond
    _write_arm(S, w, k, c, out + _ARM)


@kernel("void(S, F, I, f8, f8, i8, i8)")
def _look(S: Scalars, w: Floats, k: Integers, h: float, theta: float, c: int, out: int) -> None:
    """Evaluate the gap of ``c`` at a fraction of the step and write an end of a part of it."""
    _put(S, w, k, h, theta, c)
    evaluate_rates(S, w, k, c)
    _keep(S, w, k, h, theta, c, out)


@kernel("i8(F, i8, i8, f8, f8, f8, f8, f8, f8)")
def stays_open(
    w: Floats, one: int, two: int, h: float, speed: float, fall: float, turning: float, lever: float, tolerance: float
) -> int:
    """Return 1 if a gap stays above minus the tolerance between two ends of a part of a step, by the bounds.

    It is above both parabolas that fall away from its ends, and lowest where they cross.  A witness point that moves
    farther on its body than the body turns, as on a rim next to flat, makes the rate fall by up to as much as two
    points so far apart can differ in.
    """
    span = (w[two + _THETA] - w[one + _THETA]) * h
    g0, r0, g1, r1 = w[one + _GAP], w[one + _RATE], w[two + _GAP], w[two + _RATE]
    if _too_far(g0, w[one + _PAST], g1, w[two + _PAST], span * speed) == 1:
        return 1
    if w[one + _PAST] > 0.0 or w[two + _PAST] > 0.0 or min(g0, g1) < -tolerance:
        return 0
    if turning > 0.0:
        arm0, arm1 = one + _ARM, two + _ARM
        x, y, z = w[arm1] - w[arm0], w[arm1 + 1] - w[arm0 + 1], w[arm1 + 2] - w[arm0 + 2]
        fall += 2.0 * turning * max(0.0, math.sqrt(x * x + y * y + z * z) / span - turning * lever)
    closing = fall * span + r1 - r0
    ahead = g0 - g1 + r1 * span + 0.5 * fall * span * span
    back = g1 - g0 - r0 * span + 0.5 * fall * span * span
    # the bound is not one if either parabola passes over the other end
    if min(ahead, back) < -tolerance:
        return 0
    if closing <= 0.0 or min(ahead, back) <= 0.0:
        return 1
    s = min(ahead / closing, span)
    return 1 if g0 + s * (r0 - 0.5 * fall * s) >= -tolerance else 0


@kernel("f8(S, F, I, f8, i8, f8, i8)")
def _first_dip(S: Scalars, w: Floats, k: Integers, h: float, c: int, high: float, stands: int) -> float:
    """Return a fraction of the step, up to ``high``, at which the gap of ``c`` has closed, or 0 if it stays open.

    It has been evaluated at ``high`` if the contact stands there (1).
    """
    contact = contact_at(S, w, k, c)
    left, n = S.sectors, 1
    deflated = guard_at(S, w, k, normal_guard(c)).deflated == 1
    w[left + _THETA] = 0.0
    w[left + _GAP] = contact.gap_first - (guard_at(S, w, k, normal_guard(c)).start if deflated else 0.0)
    w[left + _RATE], w[left + _PAST] = contact.gap_rate_first, contact.past_first
    right = left + SECTOR
    for r in range(3):
        w[left + _ARM + r], w[right + _ARM + r] = contact.arm_first[r], contact.arm_end[r]
    if high < 1.0:
        if stands == 1:
            _keep(S, w, k, h, high, c, right)
        else:
            _look(S, w, k, h, high, c, right)
    else:
        w[right + _THETA], w[right + _RATE], w[right + _PAST] = 1.0, contact.gap_rate_end, contact.past_end
        w[right + _GAP] = contact.gap_end - (guard_at(S, w, k, normal_guard(c)).start if deflated else 0.0)
    speed = contact.speed_first + contact.speed_end
    if (
        high < 1.0
        and _too_far(w[left + _GAP], w[left + _PAST], w[right + _GAP], w[right + _PAST], high * h * speed) == 1
    ):
        return 0.0
    fall = _largest_fall(S, w, k, h, c)
    turning = contact.fall_first[_TURNING] + contact.fall_end[_TURNING]
    lever = min(contact.lever_a, contact.lever_b)
    while n > 0:
        right = left + SECTOR * n
        span = w[right + _THETA] - w[left + _THETA]
        proved = stays_open(w, left, right, h, speed, fall, turning if lever > 0.0 else 0.0, lever, S.gap_tolerance)
        if proved == 0 and n < SECTORS:
            gaps = max(abs(w[left + _GAP]), abs(w[right + _GAP]))
            rates = max(abs(w[left + _RATE]), abs(w[right + _RATE]))
            rests = gaps <= _RESTS * S.gap_tolerance and rates <= _RESTS * S.velocity_tolerance
            astray = w[left + _PAST] > 0.0 or w[right + _PAST] > 0.0
            enough = span <= _COARSE and (rests or (astray and span * h * speed <= WAY * contact.size))
            if span * h > S.time_tolerance and not enough:
                n += 1
                S.gap_looks += 1
                _look(S, w, k, h, w[left + _THETA] + 0.5 * span, c, left + SECTOR * n)
                if has_fired(S, w, k, normal_guard(c)) == 1:
                    return w[left + SECTOR * n + _THETA]
                continue
        for i in range(SECTOR):
            w[left + i] = w[right + i]
        n -= 1
    return 0.0


@entry_point("f8(S, F, I, f8, f8, i8)")
def first_closing(S: Scalars, w: Floats, k: Integers, h: float, high: float, asked: int) -> float:
    """Return a fraction of the step, up to ``high``, by which a doubtful gap has closed, or 0 if all stay open.

    Contacts are to stand at ``high``, unless some are astray.  If none closes, those that were looked at stand at the
    end of the step again, if that is ``high``, and the contact ``asked`` at ``high`` in any case; what others report is
    not asked for at an event.
    """
    found = 0.0
    stands = 1 if S.n_astray == 0 else 0
    for i in range(S.n_doubtful):
        c = k[S.doubtful + i]
        S.looked = 0
        theta = _first_dip(S, w, k, h, c, high, stands)
        if theta > 0.0:
            found = high = theta
            stands = 0
        elif S.looked == 1 and (high == 1.0 or c == asked):
            _look(S, w, k, h, high, c, S.sectors)
    return found
