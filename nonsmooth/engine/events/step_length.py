"""How long a step is: as the tolerance allows, and no longer than what was looked at holds."""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_driven_bodies
from nonsmooth.engine.bodies.listing import overran_list
from nonsmooth.engine.events.stopping import share_before_stop
from nonsmooth.engine.flow.clearance import ABOUT, first_of_flying, foresee, keep_falls
from nonsmooth.engine.flow.guard_numbers import normal_guard
from nonsmooth.engine.flow.location import NEGLIGIBLE
from nonsmooth.engine.flow.mean_motion import astray
from nonsmooth.engine.flow.self_check import NEAR
from nonsmooth.engine.flow.step import relaxation, try_length
from nonsmooth.engine.memory.limits import (
    BY_AVERAGING,
    BY_CLOSING,
    BY_END,
    BY_ERROR,
    BY_EVENT,
    BY_FIRST,
    BY_LARGEST,
    BY_LIST,
    BY_SAMPLES,
    BY_SINGULARITY,
    BY_STOP,
    BY_TURN,
)
from nonsmooth.engine.memory.modes import NOT_FINITE, OPEN, RUNNING, STEP_TOO_SMALL
from nonsmooth.engine.memory.tableau import ORDER
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, contact_at, guard_at, kernel
from nonsmooth.engine.numerics.runge_kutta import SAFETY, SHRINK, step_factor
from nonsmooth.engine.numerics.vectors import dot

_FIRST_WAY = 1e-3
"""Way that surfaces go in the first step of one, in units of the smaller body."""
_SHORTEST = 0.01
"""A first step is no shorter than this part of what it would be."""
_TURN = 0.5
"""What flies turns by no more within a step [rad] where that moves surfaces: the bounds of gaps ask that speeds within
it are about those at its ends, which no control of an error sees to there."""
_ASTRAY = 2.0
"""A step leads gaps astray by no more than so many times what ends an averaging."""


@kernel("f8(S, F, I, i8)")
def _first_of_compliant(S: Scalars, w: Floats, k: Integers, c: int) -> float:
    """Return how long the first step of a closed contact may be: a compliant one that begins has no force as yet.

    Were it over before the second stage of the step, none would meet a force, and the bodies would pass each other.
    """
    contact = contact_at(S, w, k, c)
    if contact.normal_function == 0 or guard_at(S, w, k, normal_guard(c)).end > NEAR * S.gap_tolerance:
        return 1e300
    speed = math.sqrt(dot(contact.rate_end, contact.rate_end))
    return float(_FIRST_WAY * contact.size / max(speed, S.velocity_tolerance))


@kernel("i8(S, F, I)")
def is_held(S: Scalars, w: Floats, k: Integers) -> int:
    """Return 1 if some contact is closed."""
    for c in range(S.n_contacts):
        if contact_at(S, w, k, c).mode != OPEN:
            return 1
    return 0


@kernel("f8(S, F, I)")
def longest_wanted(S: Scalars, w: Floats, k: Integers) -> float:
    """Return what the next step is no longer than, whatever sets off on a course before it."""
    if is_held(S, w, k) == 0:
        return float(min(S.h_free, S.h_max))
    return float(min(S.h_max, max(S.h_closed, S.h_course, S.course_end - S.t if S.course_end < math.inf else 0.0)))


@kernel("f8(S, F, I)")
def _wanted(S: Scalars, w: Floats, k: Integers) -> float:
    """Return how long the step is if nothing cuts it short; if nothing is integrated, up to the end of the courses."""
    if S.n_integrated == 0 and S.course_end < math.inf:
        return float(min(S.course_end - S.t, S.h_max))
    return float(min(S.h_closed if is_held(S, w, k) == 1 else S.h_free, S.h_max))


@kernel("f8(S, F, I, f8)")
def _first_attempt(S: Scalars, w: Floats, k: Integers, wanted: float) -> float:
    """Return the step that is tried first, ``wanted`` if nothing cuts it short."""
    S.h_turn = _TURN / S.fastest_turn if S.fastest_turn > 0.0 else 1e300
    h = min(wanted, S.h_listed, S.sample_span, S.h_valid, S.h_turn, S.mean_until - S.t, S.course_end - S.t)
    S.h_closing = S.h_arrival = 1e300
    soonest = foresee(S, w, k, h) if S.fresh == 0 or S.n_flying > 0 else 1e300
    if S.fresh == 0:
        for c in range(S.n_contacts):
            contact = contact_at(S, w, k, c)
            if contact.mode != OPEN:
                S.h_first = min(S.h_first, _first_of_compliant(S, w, k, c))
        h = min(h, S.h_first)
        # a first step to where a gap is expected to close is short, and tells when it does
        S.h_closing = max(_SHORTEST * h, ABOUT * soonest)
        keep_falls(S, w, k, min(h, S.h_closing))
    if S.n_flying > 0 and soonest < h:
        S.h_arrival = first_of_flying(S, w, k, soonest)
    if S.h_arrival < h:
        return float(S.h_arrival)
    # a step that much shorter has an error that is negligible
    return float(S.h_closing if S.h_closing < NEGLIGIBLE ** (1.0 / ORDER) * h else h)


@kernel("i8(S, f8, f8)")
def _limit(S: Scalars, wanted: float, h: float) -> int:
    """Return what limits the step of ``h`` that is tried first, where ``wanted`` is how long it may be."""
    if h == wanted or h == S.course_end - S.t:
        return BY_LARGEST if h == S.h_max else BY_ERROR
    if h == S.h_listed:
        return BY_LIST
    if h == S.mean_until - S.t:
        return BY_AVERAGING
    if h == S.sample_span:
        return BY_SAMPLES
    if h == S.h_turn:
        return BY_TURN
    if h == S.h_arrival:
        return BY_EVENT
    if h == S.h_closing:
        return BY_CLOSING
    return BY_END if h == S.h_valid else BY_FIRST


@kernel("i8(S, F, I, f8)")
def _overran(S: Scalars, w: Floats, k: Integers, h: float) -> int:
    """Return 1 if the step of ``h`` leads farther than the list of contacts holds."""
    if S.n_units == 0:
        return 0
    evaluate_driven_bodies(S, w, k, S.t + h, S.y_new)
    return overran_list(S, w, k, h)


@kernel("void(S, F, I, f8, f8, f8)")
def _remember_step(S: Scalars, w: Floats, k: Integers, h: float, error: float, wanted: float) -> None:
    """Keep the accepted step of ``h`` and how long the next one may be."""
    S.h, S.step_error = h, error
    # the touch-down that was due is behind it, or is an event of it
    S.h_first = 1e300
    # what cut a step short says nothing of the next one
    following = h * step_factor(error)
    if h < wanted:
        following = max(following, wanted)
    if is_held(S, w, k) == 0:
        S.h_free = following
    elif S.n_integrated > 0:
        S.h_closed = following


@kernel("i8(S, F, I)")
def accepted_step(S: Scalars, w: Floats, k: Integers) -> int:
    """Find a step that meets the tolerance, in ``h``; return the status."""
    wanted = _wanted(S, w, k)
    S.relaxation = relaxation(S, w, k)
    h = _first_attempt(S, w, k, wanted)
    S.limit = _limit(S, wanted, h)
    explained = 0.0
    while True:
        if S.stopped == 1:
            return NOT_FINITE
        S.halting = -1
        error = try_length(S, w, k, h)
        share = share_before_stop(S, w, k, h) if error <= 1.0 and S.stage_time > 0.0 else 1.0
        if error <= 1.0 and S.singular >= 0:
            # beyond the Painleve singularity a sliding contact is balanced on an edge: not a step further
            h *= 0.5
            wanted = 0.0
            S.limit = BY_SINGULARITY
        elif error <= 1.0 and S.mean_until < 1e300 and astray(S, w, k) > _ASTRAY:
            h *= 0.5
            S.limit = BY_AVERAGING
        elif error <= 1.0 and _overran(S, w, k, h) == 1:
            h *= 0.5
            S.limit = BY_LIST
        elif share < 1.0:
            h *= share
            wanted = 0.0
            S.limit = BY_STOP
        elif error <= 1.0:
            _remember_step(S, w, k, h, error, wanted)
            return RUNNING
        else:
            S.rejected += 1
            S.limit = BY_ERROR
            wanted = 0.0
            if not error < 1e300 and 0.1 * h < S.time_tolerance:
                return NOT_FINITE
            factor = step_factor(error) if error < 1e300 else 0.1
            if S.stage_time > 0.0 and error > explained > 0.0:
                # a slip that settles within the step leaves an error of low order
                factor = max(SHRINK, SAFETY / error)
            explained = factor * factor * error
            h *= factor
        if not h >= S.time_tolerance:
            return STEP_TOO_SMALL
