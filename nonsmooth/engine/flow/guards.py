"""Guards: what ends a mode.

Every contact has two guards, positive while its mode is valid:

* open: the gap; the second is not used.
* closed: the normal force, or, compliant, the way left to its reach; and, sticking, the distance to the static
  bound, sliding, the slip velocity along its direction at the start of the step.

Behind them stand the scenario's own, whatever the modes, and one more of every contact: closed, the way left to the end
of its features, negative if they are not the same any more.

An event lies in the half-open interval t0 < t* <= t1 of a step.  Of a guard that starts from zero (a gap
just after an impact, a slip just begun) the growth from there is taken, divided by the elapsed time, so that its
zero at the start does not fire while the next one does.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.bodies import evaluate_body, evaluate_driven_bodies, evaluate_free_bodies
from nonsmooth.engine.bodies.courses import is_on_course
from nonsmooth.engine.bodies.kinematics import evaluate_kinematics
from nonsmooth.engine.flow.flow import WRONG_FORCE, hold_guard, right_hand_side, slip_guard
from nonsmooth.engine.flow.guard_numbers import (
    contact_of,
    first_end_guard,
    first_own_guard,
    friction_guard,
    is_friction_guard,
    normal_guard,
    number_of_guards,
)
from nonsmooth.engine.flow.self_check import EXPLAINED, NOUGHT
from nonsmooth.engine.memory.modes import OPEN, SLIDE, STICK
from nonsmooth.engine.native.kernel import (
    Floats,
    Integers,
    Scalars,
    at,
    body_at,
    call_guard,
    contact_at,
    entry_point,
    guard_at,
    kernel,
    own_guard_at,
)

UNKNOWN_FALL = -1.0, 0.0, 0.0
"""How fast the rate of a gap can fall where that has not been looked at."""
_WRONG_SLIP = -0.05
"""A slip that is not armed fires below so many velocity tolerances all the same, a gap where nothing explains it."""
LATE = 2.0
"""A closed contact ends so many gap tolerances past the end of its features; up to one it may close."""


@kernel("f8(S, F, I, i8)")
def feature_guard(S: Scalars, w: Floats, k: Integers, c: int) -> float:
    """Return the way left to the end of the features of a closed contact, negative if it has other ones than before."""
    contact = contact_at(S, w, k, c)
    left = LATE * S.gap_tolerance - contact.beyond if contact.beyond != 0.0 else 1.0
    if left < 0.0 or contact.feature < 0 or int(contact.feature_now) == contact.feature:
        return float(left)
    return float(-left)


@kernel("i8(S, F, I, i8)")
def has_changed(S: Scalars, w: Floats, k: Integers, c: int) -> int:
    """Return 1 if contact ``c``, whose features are not those of before, has others; 0 if they have ended."""
    return 1 if contact_at(S, w, k, c).beyond <= S.gap_tolerance else 0


@kernel("void(S, F, I)")
def watch_features(S: Scalars, w: Floats, k: Integers) -> None:
    """Take the present features of the closed contacts as those of the step that begins.

    Right after a change there is a step that does not look: a contact may move along the border of two features.
    """
    looks = S.t - S.feature_t > S.time_tolerance
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        contact.feature = int(contact.feature_now) if looks and contact.mode != OPEN else -1


@kernel("void(S, F, I, i8)")
def _write_gap(S: Scalars, w: Floats, k: Integers, c: int) -> None:
    """Evaluate the open contact ``c`` and write its guards."""
    contact = contact_at(S, w, k, c)
    evaluate_kinematics(S, w, k, c)
    guard_at(S, w, k, normal_guard(c)).value = contact.gap
    guard_at(S, w, k, friction_guard(S, c)).value = 1.0
    contact.gap_rate = contact.rate[0]


@entry_point("void(S, F, I, f8, i8, i8)")
def write_guards(S: Scalars, w: Floats, k: Integers, t: float, y: int, forces: int) -> None:
    """Write the guards after the right-hand side at ``t`` and ``y``; of closed contacts if ``forces`` are known (1)."""
    _write_other_guards(S, w, k, t, y, forces)
    for c in range(S.n_contacts):
        if contact_at(S, w, k, c).mode == OPEN:
            _write_gap(S, w, k, c)
        elif is_on_course(S, w, k, c) == 1:
            # nothing of it ends before its course does
            _write_gap(S, w, k, c)
            guard_at(S, w, k, normal_guard(c)).value = 1.0


@kernel("void(S, F, I, f8, i8, i8)")
def _write_other_guards(S: Scalars, w: Floats, k: Integers, t: float, y: int, forces: int) -> None:
    """Write the guards that are no gaps."""
    if S.n_grouped == 0:
        evaluate_driven_bodies(S, w, k, t, y)
    elif forces == 1:
        for i in range(S.n_grouped):
            c = k[S.grouped + i]
            contact = contact_at(S, w, k, c)
            guard_at(S, w, k, normal_guard(c)).value = hold_guard(S, w, k, c)
            friction = guard_at(S, w, k, friction_guard(S, c))
            contact.gap_rate = contact.rate[0]
            if contact.mode == STICK:
                friction.value = contact.static_margin
            else:
                friction.value = slip_guard(S, w, k, c)
    for g in range(S.n_own_guards):
        own = own_guard_at(S, w, k, g)
        value = call_guard(own.function, t, at(w, y), at(w, y + S.n_q), at(w, own.parameters))
        guard_at(S, w, k, first_own_guard(S) + g).value = value
    for c in range(S.n_contacts):
        end, contact = guard_at(S, w, k, first_end_guard(S) + c), contact_at(S, w, k, c)
        end.value = 1.0
        if contact.mode != OPEN and forces == 1 and S.n_grouped > 0 and is_on_course(S, w, k, c) == 0:
            end.value = feature_guard(S, w, k, c)


@kernel("void(S, F, I, f8, i8, i8)")
def _evaluate_flying(S: Scalars, w: Floats, k: Integers, t: float, y: int, c: int) -> None:
    """Let the bodies of contact ``c`` that fly write their output blocks."""
    contact = contact_at(S, w, k, c)
    for side in range(2):
        number = contact.body_a if side == 0 else contact.body_b
        if body_at(S, w, k, number).flies == 1:
            evaluate_body(S, w, k, t, y, number)


@kernel("void(S, F, I, f8, i8)")
def _evaluate_doubtful(S: Scalars, w: Floats, k: Integers, t: float, y: int) -> None:
    """Evaluate the bodies that fly and may meet something in the step."""
    for i in range(S.n_doubtful):
        _evaluate_flying(S, w, k, t, y, k[S.doubtful + i])
    for i in range(S.n_astray):
        _evaluate_flying(S, w, k, t, y, k[S.astray + i])


@kernel("void(S, F, I, f8, i8)")
def stand_at(S: Scalars, w: Floats, k: Integers, t: float, y: int) -> None:
    """Evaluate the bodies that move at ``t`` and ``y``, but for those that fly and can meet nothing in the step."""
    evaluate_driven_bodies(S, w, k, t, y)
    evaluate_free_bodies(S, w, k, t, y, 0)
    _evaluate_doubtful(S, w, k, t, y)


@kernel("void(S, F, I, f8, i8, f8, i8)")
def evaluate_guards(S: Scalars, w: Floats, k: Integers, t: float, y: int, elapsed: float, forces: int) -> None:
    """Evaluate the motion at ``t`` and ``y`` and write the guards, deflated by the time elapsed in the step.

    Gaps that cannot close in the step, and bodies that fly and cannot meet anything in it, are left as they are at its
    end.
    """
    if forces == 1:
        right_hand_side(S, w, k, t, y, 0, 0)
        _evaluate_doubtful(S, w, k, t, y)
    else:
        stand_at(S, w, k, t, y)
    _write_other_guards(S, w, k, t, y, forces)
    for i in range(S.n_doubtful):
        _write_gap(S, w, k, k[S.doubtful + i])
    for i in range(S.n_astray):
        _write_gap(S, w, k, k[S.astray + i])
    deflate(S, w, k, elapsed)


@kernel("i8(S, F, I, i8)")
def _is_open(S: Scalars, w: Floats, k: Integers, i: int) -> int:
    """Return 1 if the contact whose normal or friction guard ``i`` is, is open."""
    return 1 if contact_at(S, w, k, contact_of(S, i)).mode == OPEN else 0


@kernel("f8(S, F, I, i8, f8, f8)")
def grown(S: Scalars, w: Floats, k: Integers, i: int, value: float, elapsed: float) -> float:
    """Return guard ``i`` of this value, or, if it started from zero, its growth divided by the time elapsed."""
    guard = guard_at(S, w, k, i)
    if guard.deflated == 0:
        return value
    rate = guard.first
    separates = i < first_own_guard(S) and _is_open(S, w, k, i) == 1 and rate > S.velocity_tolerance
    if separates and rate * elapsed <= NOUGHT * S.gap_tolerance:
        return float(rate)
    return float((value - guard.start) / elapsed)


@kernel("void(S, F, I, f8)")
def deflate(S: Scalars, w: Floats, k: Integers, elapsed: float) -> None:
    """Divide the growth of the guards that started from zero, or below it by round-off, by the time elapsed.

    As long as a gap has not grown beyond round-off its rate at the start stands.
    """
    for i in range(first_end_guard(S)):
        guard = guard_at(S, w, k, i)
        guard.value = grown(S, w, k, i, guard.value, elapsed)


@kernel()
def keep_end(S: Scalars, w: Floats, k: Integers) -> None:
    """Keep guards and rates of the end of a step, where the next one starts."""
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        contact.gap_rate_end = contact.gap_rate
        contact.gap_end = contact.gap
        contact.overlap_end = contact.overlap
        contact.past_end = contact.beyond
        contact.rate_end = contact.velocity
    for i in range(number_of_guards(S)):
        guard = guard_at(S, w, k, i)
        guard.end = guard.value


@kernel("void(S, F, I)")
def keep_start(S: Scalars, w: Floats, k: Integers) -> None:
    """Take what is known of the gaps at the end of the step before as what they start from."""
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        contact.gap_first, contact.gap_rate_first = contact.gap_end, contact.gap_rate_end
        contact.past_first, contact.speed_first = contact.past_end, contact.speed_end
        contact.fall_first = contact.fall_end if S.fresh == 1 else UNKNOWN_FALL
        contact.arm_first = contact.arm_end


@kernel("void(S, F, I, i8)")
def _start(S: Scalars, w: Floats, k: Integers, i: int) -> None:
    """Let guard ``i`` start from where the last step ended."""
    guard = guard_at(S, w, k, i)
    guard.deflated = 0
    guard.start = guard.first = guard.end


@kernel("void(S, F, I, i8)")
def _arm(S: Scalars, w: Floats, k: Integers, i: int) -> None:
    guard = guard_at(S, w, k, i)
    guard.armed = 1 if guard.first > 0.0 else 0


@kernel("f8(S, F, I, i8)")
def _least(S: Scalars, w: Floats, k: Integers, i: int) -> float:
    """Return above what guard ``i`` of a contact is armed: a force that counts as none is neither positive nor not."""
    contact = contact_at(S, w, k, contact_of(S, i))
    if contact.mode == OPEN or contact.normal_function != 0:
        return 0.0
    # the bound of friction is none where nothing presses
    presses = guard_at(S, w, k, normal_guard(contact_of(S, i))).first > contact.small_force_of
    return 0.0 if is_friction_guard(S, i) == 1 and (presses or contact.mode != STICK) else float(contact.small_force_of)


@kernel()
def arm_guards(S: Scalars, w: Floats, k: Integers) -> None:
    """Take the kept guards as those of the start: arm the positive ones, deflate those that start from zero."""
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        normal, friction = guard_at(S, w, k, normal_guard(c)), guard_at(S, w, k, friction_guard(S, c))
        _start(S, w, k, normal_guard(c))
        _start(S, w, k, friction_guard(S, c))
        if contact.mode == OPEN:
            if normal.first <= S.gap_tolerance:
                normal.deflated = 1
                normal.start = min(0.0, normal.start)
                if contact.gap_rate_end <= S.velocity_tolerance:
                    normal.start -= NOUGHT * S.gap_tolerance
                normal.first = contact.gap_rate_end
        elif contact.normal_function != 0 and normal.first <= S.gap_tolerance:
            # it has just touched down, and lets go when it comes back to here
            normal.deflated = 1
            normal.start = min(0.0, normal.start) - NOUGHT * S.gap_tolerance
            normal.first = -contact.gap_rate_end
        if contact.mode == SLIDE and friction.first <= S.velocity_tolerance:
            friction.deflated = 1
            friction.start = min(0.0, friction.start) - NOUGHT * S.velocity_tolerance
            friction.first = 0.0
        rests = contact.mode == OPEN and normal.deflated == 1
        normal.armed = 1 if rests or normal.first > _least(S, w, k, normal_guard(c)) else 0
        friction.armed = 1 if friction.first > _least(S, w, k, friction_guard(S, c)) else 0
    for g in range(S.n_own_guards):
        guard, own = guard_at(S, w, k, first_own_guard(S) + g), own_guard_at(S, w, k, g)
        _start(S, w, k, first_own_guard(S) + g)
        # one that has just fired starts from zero
        guard.deflated = own.spent
        if own.spent == 1:
            guard.first = 0.0
        own.spent = 0
        _arm(S, w, k, first_own_guard(S) + g)
    for i in range(first_end_guard(S), number_of_guards(S)):
        _start(S, w, k, i)
        _arm(S, w, k, i)


@kernel("void(S, F, I, i8)")
def arm_further(S: Scalars, w: Floats, k: Integers, forces: int) -> None:
    """Arm the guards that have become positive within the step."""
    for i in range(number_of_guards(S)):
        guard, own = guard_at(S, w, k, i), i >= first_own_guard(S)
        least = 0.0 if own else _least(S, w, k, i)
        if guard.value > least and (own or forces == 1 or _is_open(S, w, k, i) == 1):
            guard.armed = 1


@kernel("i8(S, F, I, i8)")
def _rests(S: Scalars, w: Floats, k: Integers, i: int) -> int:
    """Return 1 if guard ``i`` is a gap at rest, closed from the start or come over the end of a feature: it stays open.

    Beside contacts that hold the bodies a gap drifts with theirs.
    """
    guard, contact = guard_at(S, w, k, i), contact_at(S, w, k, contact_of(S, i))
    if contact.mode != OPEN or is_friction_guard(S, i) == 1:
        return 0
    if guard.deflated == 1:
        return 1 if contact.gap_rate > -NOUGHT * S.velocity_tolerance else 0
    rests = guard.value > -S.gap_tolerance and contact.gap_rate > -S.velocity_tolerance
    return 1 if contact.beyond != 0.0 and rests else 0


@kernel("f8(S, F, I, i8)")
def _wrong(S: Scalars, w: Floats, k: Integers, i: int) -> float:
    """Return below what guard ``i`` of a contact fires though it is not armed."""
    guard, contact = guard_at(S, w, k, i), contact_at(S, w, k, contact_of(S, i))
    if guard.deflated == 1:
        return float(_WRONG_SLIP * S.velocity_tolerance)
    normal = is_friction_guard(S, i) == 0
    if normal and (contact.mode == OPEN or contact.normal_function != 0):
        return float(-EXPLAINED * S.gap_tolerance)
    if normal or (contact.mode == STICK and contact.holds == 1):
        return float(WRONG_FORCE * contact.small_force_of)
    return float(_WRONG_SLIP * S.velocity_tolerance)


@kernel("i8(S, F, I, i8)")
def is_of_choice(S: Scalars, w: Floats, k: Integers, i: int) -> int:
    """Return 1 if guard ``i`` of a contact is that of a force which is not unique."""
    contact = contact_at(S, w, k, contact_of(S, i))
    slips = is_friction_guard(S, i) == 1 and contact.holds == 0
    return 0 if contact.mode == OPEN or contact.redundant == 0 or slips else 1


@kernel("i8(S, F, I, i8)")
def has_fired(S: Scalars, w: Floats, k: Integers, i: int) -> int:
    """Return 1 if guard ``i`` of a contact has fired; to those of forces that are chosen the step may be blind."""
    if S.blind == 1 and is_of_choice(S, w, k, i) == 1:
        return 0
    guard = guard_at(S, w, k, i)
    if guard.value < 0.0 and (guard.armed == 1 or guard.value < _wrong(S, w, k, i)):
        return 1 - _rests(S, w, k, i)
    return 0


@kernel("i8(S, F, I, i8)")
def is_gap(S: Scalars, w: Floats, k: Integers, i: int) -> int:
    """Return 1 if guard ``i`` is a gap whose rate is known."""
    if i >= first_own_guard(S) or _is_open(S, w, k, i) == 0:
        return 0
    return 1 if contact_at(S, w, k, contact_of(S, i)).beyond <= 0.0 else 0


@kernel("i8(S, F, I, i8)")
def kinematic(S: Scalars, w: Floats, k: Integers, i: int) -> int:
    """Return 1 if guard ``i`` is the gap of an open contact, 2 if the slip of a rigid one: they hang on no force."""
    if i >= first_own_guard(S):
        return 0
    contact = contact_at(S, w, k, contact_of(S, i))
    if is_friction_guard(S, i) == 0:
        return 1 if contact.mode == OPEN else 0
    return 2 if contact.mode == SLIDE and contact.normal_function == 0 else 0


@kernel("i8(S, F, I, i8)")
def _closes_now(S: Scalars, w: Floats, k: Integers, i: int) -> int:
    """Return 1 if guard ``i`` is a gap that has closed no longer ago than instants are told apart."""
    contact = contact_at(S, w, k, contact_of(S, i))
    late = max(S.gap_tolerance, S.time_tolerance * abs(contact.gap_rate))
    return 1 if is_gap(S, w, k, i) == 1 and contact.gap >= -late else 0


@kernel("i8(S, F, I, i8, i8)")
def first_fired(S: Scalars, w: Floats, k: Integers, forces: int, but: int) -> int:
    """Return the first guard that has fired, or -1; at the root of guard ``but`` those that fired before it.

    A gap that closes at the same instant did not.  Gaps that jump, a sign that another contact was passed, come last:
    where it was none of them has a root to look for.
    """
    jumps = -1
    for c in range(S.n_contacts):
        is_open = contact_at(S, w, k, c).mode == OPEN
        if forces == 0 and not is_open:
            continue
        for i in (normal_guard(c), friction_guard(S, c)):
            if i != but and has_fired(S, w, k, i) == 1 and (but < 0 or _closes_now(S, w, k, i) == 0):
                if not is_open or is_gap(S, w, k, i) == 1:
                    return i
                jumps = i if jumps < 0 else jumps
    if jumps >= 0:
        return jumps
    for i in range(first_own_guard(S), number_of_guards(S)):
        guard = guard_at(S, w, k, i)
        if i != but and guard.value < 0.0 and guard.armed == 1:
            return i
    return -1
