"""Which contacts touch at an instant, and how fast they slip."""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.compliance import evaluate_given_force, refresh_states
from nonsmooth.engine.bodies.kinematics import evaluate_contact, evaluate_geometry, evaluate_rates
from nonsmooth.engine.memory.blocks import GAP, GEOMETRY, PAST_END
from nonsmooth.engine.memory.modes import OPEN
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, kernel, room


@room("i8(S, F, I)")
def touch(S: Scalars, w: Floats, k: Integers) -> int:
    """Find and evaluate the touching contacts; return 1 if one of them approaches."""
    evaluate_bodies(S, w, k, S.t, S.y)
    refresh_states(S, w, k, S.y)
    approaching = 0
    for c in range(S.n_contacts):
        k[S.touching + c] = 1
        evaluate_geometry(S, w, k, c)
        evaluate_rates(S, w, k, c)
        rate = w[S.rate + 3 * c]
        if w[S.geometry + GEOMETRY * c + PAST_END] > S.gap_tolerance and w[S.geometry + GEOMETRY * c + GAP] > 0.0:
            k[S.touching + c] = 0
            continue
        if k[S.normal_function + c] != 0:
            _touch_compliant(S, w, k, c)
            continue
        near = max(S.gap_tolerance, S.time_tolerance * abs(rate))
        if k[S.mode + c] == OPEN and w[S.geometry + GEOMETRY * c + GAP] > near:
            k[S.touching + c] = 0
            continue
        evaluate_contact(S, w, k, c, 3)
        if rate < -S.velocity_tolerance:
            approaching = 1
    return approaching


@kernel("void(S, F, I, i8)")
def _touch_compliant(S: Scalars, w: Floats, k: Integers, c: int) -> None:
    """Find whether the compliant contact ``c`` touches, and evaluate it; it does not collide."""
    gap, rate = w[S.geometry + GEOMETRY * c + GAP], w[S.rate + 3 * c]
    end = 0.0 if k[S.mode + c] == OPEN else w[S.reach + c]
    slow = rate <= S.velocity_tolerance
    if gap > end + S.gap_tolerance or (gap > end - S.gap_tolerance and not slow):
        k[S.touching + c] = 0
        return
    evaluate_contact(S, w, k, c, 3)
    evaluate_given_force(S, w, k, c)


@kernel("f8(S, F, I, i8)")
def slip_speed(S: Scalars, w: Floats, k: Integers, c: int) -> float:
    """Return the slip speed of contact ``c`` [m/s]."""
    v1, v2 = w[S.rate + 3 * c + 1], w[S.rate + 3 * c + 2]
    return math.sqrt(v1 * v1 + v2 * v2)
