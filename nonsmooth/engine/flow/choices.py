"""Forces that are not unique, chosen anew where they come to a bound, and the instant from which on there is no choice.

The motion does not depend on the choice.  So where choice follows choice a step is taken blind to the bounds of others,
twice as long as the one before, and at its end, if they are passed, new ones are chosen.  Only where there are none it is
asked up to when there are: each choice kept until it comes to a bound, that instant is met in ever shorter steps.
"""

from __future__ import annotations

from nonsmooth.engine.delassus.islands import group_closed
from nonsmooth.engine.flow.flight import state_within
from nonsmooth.engine.flow.flow import right_hand_side
from nonsmooth.engine.flow.guard_numbers import first_own_guard
from nonsmooth.engine.flow.guards import is_of_choice, keep_end, write_guards
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, guard_at, kernel

_LONGER = 2.0
"""So many times as long as the way from choice to choice a blind step is: bounds are met, however short they last, that
come nearer as fast as the ways become shorter."""


@kernel("void(S, f8, f8)")
def _keep_choice(S: Scalars, t: float, way: float) -> None:
    """Keep that forces are chosen at ``t``, so long after the choice before if nothing else happened since, or 0."""
    S.chosen_t, S.choice_way = t, way
    if way > 0.0:
        S.h_first = _LONGER * way


@kernel("void(S)")
def may_be_blind(S: Scalars) -> None:
    """Let the explicit step that begins with a second choice in a row be blind to the bounds of what is chosen."""
    S.blind = 1 if S.follows_choice == 1 and S.choice_way > 0.0 and S.stage_time == 0.0 else 0


@kernel("i8(S, F, I)")
def choose_anew(S: Scalars, w: Floats, k: Integers) -> int:
    """Choose the forces that are not unique anew; return 1 if all closed contacts can keep their bounds.

    A second time within the time tolerance there is no choice: then all forces vanish.
    """
    if S.t - S.chosen_t <= S.time_tolerance:
        return 0
    _keep_choice(S, S.t, S.t - S.chosen_t if S.follows_choice == 1 else 0.0)
    group_closed(S, w, k)
    return int(right_hand_side(S, w, k, S.t, S.y, 1, 1))


@kernel("i8(S, F, I)")
def nearest_bound(S: Scalars, w: Floats, k: Integers) -> int:
    """Return the guard of a force that is not unique which has the least value, or -1."""
    nearest, least = -1, 1e300
    for i in range(first_own_guard(S)):
        value = guard_at(S, w, k, i).value
        if value < least and is_of_choice(S, w, k, i) == 1:
            nearest, least = i, value
    return nearest


@kernel("f8(S, F, I, f8)")
def end_of_choices(S: Scalars, w: Floats, k: Integers, h: float) -> float:
    """Return after what time of the step of ``h`` forces can be chosen no more, or -1 if they can at its end.

    There they are chosen if those at hand pass a bound.
    """
    right_hand_side(S, w, k, S.t + h, S.y_new, 0, 0)
    write_guards(S, w, k, S.t + h, S.y_new, 1)
    passed = nearest_bound(S, w, k)
    if passed < 0 or guard_at(S, w, k, passed).value >= 0.0:
        return -1.0
    if right_hand_side(S, w, k, S.t + h, S.y_new, 1, 0) == 1:
        write_guards(S, w, k, S.t + h, S.y_new, 1)
        keep_end(S, w, k)
        _keep_choice(S, S.t + h, h)
        return -1.0
    low, high = 0.0, h
    while high - low > S.time_tolerance:
        middle = 0.5 * (low + high)
        state_within(S, w, k, S.h, middle / S.h, S.y_stage)
        if right_hand_side(S, w, k, S.t + middle, S.y_stage, 1, 0) == 1:
            low = middle
        else:
            high = middle
    return high
