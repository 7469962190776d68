"""Forces that are not unique, chosen anew where they come to a bound, and the instant from which on there is no choice.

The motion does not depend on the choice.  So where forces chosen at the start of a step come to a bound within it, the
step goes on if others do not, and only where there are none it is asked up to when there are: choice after choice,
each of which would be kept until it comes to a bound, leads there in ever shorter steps.
"""

from __future__ import annotations

from nonsmooth.engine.delassus.islands import group_closed
from nonsmooth.engine.flow.flight import state_within
from nonsmooth.engine.flow.flow import right_hand_side
from nonsmooth.engine.flow.guard_numbers import contact_of, first_own_guard, is_friction_guard, number_of_guards
from nonsmooth.engine.flow.guards import has_fired
from nonsmooth.engine.memory.modes import OPEN
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, contact_at, guard_at, kernel


@kernel("i8(S, F, I, i8)")
def is_of_choice(S: Scalars, w: Floats, k: Integers, guard: int) -> int:
    """Return 1 if the ``guard`` is that of a force which is not unique."""
    if guard >= first_own_guard(S):
        return 0
    contact = contact_at(S, w, k, contact_of(S, guard))
    slips = is_friction_guard(S, guard) == 1 and contact.holds == 0
    return 0 if contact.mode == OPEN or contact.redundant == 0 or slips else 1


@kernel("i8(S, F, I)")
def choose_anew(S: Scalars, w: Floats, k: Integers) -> int:
    """Choose the forces that are not unique anew; return 1 if all closed contacts can keep their bounds.

    A second time within the time tolerance there is no choice: then all forces vanish.
    """
    if S.t - S.chosen_t <= S.time_tolerance:
        return 0
    S.chosen_t = S.t
    group_closed(S, w, k)
    return int(right_hand_side(S, w, k, S.t, S.y, 1, 1))


@kernel("i8(S, F, I)")
def _others_fired(S: Scalars, w: Floats, k: Integers) -> int:
    """Return 1 if a guard has fired that is not of a choice."""
    for i in range(number_of_guards(S)):
        guard = guard_at(S, w, k, i)
        own = i >= first_own_guard(S)
        fired = guard.value < 0.0 and guard.armed == 1 if own else has_fired(S, w, k, i) == 1
        if fired and is_of_choice(S, w, k, i) == 0:
            return 1
    return 0


@kernel("i8(S, F, I)")
def may_choose(S: Scalars, w: Floats, k: Integers) -> int:
    """Return 1 if only forces chosen where the explicit step began have fired."""
    return 1 if S.chosen_t == S.t and S.stage_time == 0.0 and _others_fired(S, w, k) == 0 else 0


@kernel("f8(S, F, I, f8, f8)")
def first_without_choice(S: Scalars, w: Floats, k: Integers, h: float, high: float) -> float:
    """Return the fraction of the step, up to ``high``, from which on forces cannot be chosen, or 0 if there all can."""
    low, theta = 0.0, high
    while (high - low) * h > S.time_tolerance:
        state_within(S, w, k, h, theta, S.y_stage)
        if right_hand_side(S, w, k, S.t + theta * h, S.y_stage, 1, 0) == 0:
            high = theta
        elif theta == high:
            return 0.0
        else:
            low = theta
        theta = 0.5 * (low + high)
    return high
