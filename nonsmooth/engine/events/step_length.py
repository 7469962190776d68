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
from nonsmooth.engine.native.kernel import Workspace, kernel
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


@kernel("f8(ws, i8)")
def _first_of_compliant(ws: Workspace, c: int) -> float:
    """Return how long the first step of a closed contact may be: a compliant one that begins has no force as yet.

    Were it over before the second stage of the step, none would meet a force, and the bodies would pass each other.
    """
    contact = ws.contacts[c]
    if not contact.is_compliant or ws.guards[normal_guard(c)].end > NEAR * ws.gap_tolerance:
        return 1e300
    speed = math.sqrt(dot(contact.rate_end, contact.rate_end))
    return float(_FIRST_WAY * contact.size / max(speed, ws.velocity_tolerance))


@kernel("b1(ws)")
def is_held(ws: Workspace) -> bool:
    """Return 1 if some contact is closed."""
    for c in range(ws.n_contacts):
        if ws.contacts[c].mode != OPEN:
            return True
    return False


@kernel("f8(ws)")
def longest_wanted(ws: Workspace) -> float:
    """Return what the next step is no longer than, whatever sets off on a course before it."""
    if not is_held(ws):
        return float(min(ws.h_free, ws.h_max))
    return float(
        min(ws.h_max, max(ws.h_closed, ws.h_course, ws.course_end - ws.t if ws.course_end < math.inf else 0.0))
    )


@kernel("f8(ws)")
def _wanted(ws: Workspace) -> float:
    """Return how long the step is if nothing cuts it short; if nothing is integrated, up to the end of the courses."""
    if ws.n_integrated == 0 and ws.course_end < math.inf:
        return float(min(ws.course_end - ws.t, ws.h_max))
    return float(min(ws.h_closed if is_held(ws) else ws.h_free, ws.h_max))


@kernel("f8(ws, f8)")
def _first_attempt(ws: Workspace, wanted: float) -> float:
    """Return the step that is tried first, ``wanted`` if nothing cuts it short."""
    ws.h_turn = _TURN / ws.fastest_turn if ws.fastest_turn > 0.0 else 1e300
    h = min(wanted, ws.h_listed, ws.sample_span, ws.h_valid, ws.h_turn, ws.mean_until - ws.t, ws.course_end - ws.t)
    ws.h_closing = ws.h_arrival = 1e300
    soonest = foresee(ws, h) if ws.fresh == 0 or ws.n_flying > 0 else 1e300
    if ws.fresh == 0:
        for c in range(ws.n_contacts):
            contact = ws.contacts[c]
            if contact.mode != OPEN:
                ws.h_first = min(ws.h_first, _first_of_compliant(ws, c))
        h = min(h, ws.h_first)
        # a first step to where a gap is expected to close is short, and tells when it does
        ws.h_closing = max(_SHORTEST * h, ABOUT * soonest)
        keep_falls(ws, min(h, ws.h_closing))
    if ws.n_flying > 0 and soonest < h:
        ws.h_arrival = first_of_flying(ws, soonest)
    if ws.h_arrival < h:
        return float(ws.h_arrival)
    # a step that much shorter has an error that is negligible
    return float(ws.h_closing if ws.h_closing < NEGLIGIBLE ** (1.0 / ORDER) * h else h)


@kernel("i8(ws, f8, f8)")
def _limit(ws: Workspace, wanted: float, h: float) -> int:
    """Return what limits the step of ``h`` that is tried first, where ``wanted`` is how long it may be."""
    if h == wanted or h == ws.course_end - ws.t:
        return BY_LARGEST if h == ws.h_max else BY_ERROR
    if h == ws.h_listed:
        return BY_LIST
    if h == ws.mean_until - ws.t:
        return BY_AVERAGING
    if h == ws.sample_span:
        return BY_SAMPLES
    if h == ws.h_turn:
        return BY_TURN
    if h == ws.h_arrival:
        return BY_EVENT
    if h == ws.h_closing:
        return BY_CLOSING
    return BY_END if h == ws.h_valid else BY_FIRST


@kernel("b1(ws, f8)")
def _overran(ws: Workspace, h: float) -> bool:
    """Return 1 if the step of ``h`` leads farther than the list of contacts holds."""
    if ws.n_units == 0:
        return False
    evaluate_driven_bodies(ws, ws.t + h, ws.offsets.y_new)
    return overran_list(ws, h)


@kernel("void(ws, f8, f8, f8)")
def _remember_step(ws: Workspace, h: float, error: float, wanted: float) -> None:
    """Keep the accepted step of ``h`` and how long the next one may be."""
    ws.h, ws.step_error = h, error
    # the touch-down that was due is behind it, or is an event of it
    ws.h_first = 1e300
    # what cut a step short says nothing of the next one
    following = h * step_factor(error)
    if h < wanted:
        following = max(following, wanted)
    if not is_held(ws):
        ws.h_free = following
    elif ws.n_integrated > 0:
        ws.h_closed = following


@kernel("i8(ws)")
def accepted_step(ws: Workspace) -> int:
    """Find a step that meets the tolerance, in ``h``; return the status."""
    wanted = _wanted(ws)
    ws.relaxation = relaxation(ws)
    h = _first_attempt(ws, wanted)
    ws.limit = _limit(ws, wanted, h)
    explained = 0.0
    while True:
        if ws.stopped == 1:
            return NOT_FINITE
        ws.halting = -1
        error = try_length(ws, h)
        share = share_before_stop(ws, h) if error <= 1.0 and ws.stage_time > 0.0 else 1.0
        if error <= 1.0 and ws.singular >= 0:
            # beyond the Painleve singularity a sliding contact is balanced on an edge: not a step further
            h *= 0.5
            wanted = 0.0
            ws.limit = BY_SINGULARITY
        elif error <= 1.0 and ws.mean_until < math.inf and astray(ws) > _ASTRAY:
            h *= 0.5
            ws.limit = BY_AVERAGING
        elif error <= 1.0 and _overran(ws, h):
            h *= 0.5
            ws.limit = BY_LIST
        elif share < 1.0:
            h *= share
            wanted = 0.0
            ws.limit = BY_STOP
        elif error <= 1.0:
            _remember_step(ws, h, error, wanted)
            return RUNNING
        else:
            ws.rejected += 1
            ws.limit = BY_ERROR
            wanted = 0.0
            if not error < 1e300 and 0.1 * h < ws.time_tolerance:
                return NOT_FINITE
            factor = step_factor(error) if error < 1e300 else 0.1
            if ws.stage_time > 0.0 and error > explained > 0.0:
                # a slip that settles within the step leaves an error of low order
                factor = max(SHRINK, SAFETY / error)
            explained = factor * factor * error
            h *= factor
        if not h >= ws.time_tolerance:
            return STEP_TOO_SMALL
