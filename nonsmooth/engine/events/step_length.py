"""Chooses the length of the next step between events.

The length is limited by the error tolerance, by expected events, and by the time until the neighbour list or a bound of
a gap expires.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_driven_bodies
from nonsmooth.engine.events.stopping import part_before_stop
from nonsmooth.engine.flow.averaging_time import deviation_of_gaps
from nonsmooth.engine.flow.clearance import ABOUT, first_of_flying, foresee, keep_falls
from nonsmooth.engine.flow.guard_numbers import normal_of
from nonsmooth.engine.flow.location import NEGLIGIBLE
from nonsmooth.engine.flow.step import relaxation_rate, try_length
from nonsmooth.engine.memory.modes import Limit, Mode, Status
from nonsmooth.engine.memory.tableau import ORDER
from nonsmooth.engine.native.kernel import ContactRecord, Workspace, kernel
from nonsmooth.engine.numerics.runge_kutta import SAFETY, SHRINK, step_factor
from nonsmooth.engine.numerics.tolerances import ADJACENT
from nonsmooth.engine.numerics.vectors import dot
from nonsmooth.engine.pairs.listing import overran_list

_FIRST_WAY = 1e-3
"""Largest displacement of surfaces in a compliant contact's first step, relative to the size of the smaller body."""
_SHORTEST = 0.01
"""Least length of a first step that an expected closing of a gap shortens, relative to its length without the closing.

The first step is the step after an event.
"""
_TURN = 0.5
"""Largest rotation, in one step, of a body in ballistic motion or of a body that may touch it [rad].

The rotation of the smaller of both shapes about its axis of revolution does not count: its surface does not move.

The bounds of gaps assume that no speed within a step exceeds the sum of the speeds at its ends.  Integrated bodies
fulfil this by their error control, which ballistic bodies do not have.
"""
_ASTRAY = 2.0
"""Largest deviation of a gap from its linear model in a step with averaged forces, relative to the allowed deviation.

A step with a larger deviation is repeated with half its length. Averaged forces are those of the time-stepping
fallback, and the linear model is that of :mod:`nonsmooth.engine.flow.averaging_time`.
"""


@kernel("f8(ws, ContactRecord)")
def _first_of_compliant(ws: Workspace, contact: ContactRecord) -> float:
    """Largest first step of a compliant contact that has just closed [s]; infinite for any other closed contact.

    A compliant contact that has just closed has no force yet. If a long step carried the bodies through each other
    before its second stage, no stage would have a contact force.
    """
    if not contact.is_compliant or normal_of(ws, contact).at_end > ADJACENT * ws.tolerance.gap:
        return math.inf
    speed = math.sqrt(dot(contact.velocity_at_end, contact.velocity_at_end))
    return float(_FIRST_WAY * contact.size / max(speed, ws.tolerance.velocity))


@kernel("b1(ws)")
def is_held(ws: Workspace) -> bool:
    """True if some contact is closed."""
    for contact in ws.contacts:
        if contact.mode != Mode.OPEN:
            return True
    return False


@kernel("f8(ws)")
def longest_wanted(ws: Workspace) -> float:
    """Upper bound of the next step [s], which also holds if bodies get own steps (multirate) before the step begins."""
    if not is_held(ws):
        return float(min(ws.island.free_step, ws.tolerance.largest_step))
    course = ws.island.own_steps_end - ws.island.time if ws.island.own_steps_end < math.inf else 0.0
    return float(min(ws.tolerance.largest_step, max(ws.island.closed_step, ws.island.own_step, course)))


@kernel("f8(ws)")
def _wanted(ws: Workspace) -> float:
    """Length of the step by error control alone [s].

    If only own steps of bodies (multirate) are under way, it is the time until the first of these steps ends.
    """
    if ws.island.n_integrated == 0 and ws.island.own_steps_end < math.inf:
        return float(min(ws.island.own_steps_end - ws.island.time, ws.tolerance.largest_step))
    return float(min(ws.island.closed_step if is_held(ws) else ws.island.free_step, ws.tolerance.largest_step))


@kernel("f8(ws, f8)")
def _first_attempt(ws: Workspace, wanted: float) -> float:
    """Length of the step that is tried first [s], at most ``wanted`` [s]."""
    ws.step.turning_step = _TURN / ws.island.fastest_turn if ws.island.fastest_turn > 0.0 else math.inf
    h = min(
        wanted,
        ws.step.listed_step,
        ws.request.sample_span,
        ws.island.resumed_step,
        ws.step.turning_step,
        ws.island.averaged_until - ws.island.time,
        ws.island.own_steps_end - ws.island.time,
    )
    ws.step.closing_step = ws.step.arrival_step = math.inf
    soonest = foresee(ws, h) if not ws.island.follows_a_step or ws.island.n_ballistic > 0 else math.inf
    if not ws.island.follows_a_step:
        for contact in ws.contacts:
            if contact.mode != Mode.OPEN:
                ws.island.first_step = min(ws.island.first_step, _first_of_compliant(ws, contact))
        h = min(h, ws.island.first_step)
        # let the first step end just after a gap is expected to close: its interpolant then gives the closing time
        ws.step.closing_step = max(_SHORTEST * h, ABOUT * soonest)
        keep_falls(ws, min(h, ws.step.closing_step))
    if ws.island.n_ballistic > 0 and soonest < h:
        ws.step.arrival_step = first_of_flying(ws, soonest)
    if ws.step.arrival_step < h:
        return float(ws.step.arrival_step)
    # stop at the expected closing only if the step becomes so much shorter that its error is negligible
    return float(ws.step.closing_step if ws.step.closing_step < NEGLIGIBLE ** (1.0 / ORDER) * h else h)


@kernel("Limit(ws, f8, f8)")
def _limit(ws: Workspace, wanted: float, h: float) -> Limit:
    """Cause that limits the first trial step of ``h`` [s]. ``wanted`` is the length by error control alone [s]."""
    if h == wanted or h == ws.island.own_steps_end - ws.island.time:
        return Limit.LARGEST_STEP if h == ws.tolerance.largest_step else Limit.ERROR
    if h == ws.step.listed_step:
        return Limit.NEIGHBOUR_LIST
    if h == ws.island.averaged_until - ws.island.time:
        return Limit.AVERAGING
    if h == ws.request.sample_span:
        return Limit.SAMPLES
    if h == ws.step.turning_step:
        return Limit.TURN
    if h == ws.step.arrival_step:
        return Limit.EVENT
    if h == ws.step.closing_step:
        return Limit.CLOSING_GAP
    return Limit.END if h == ws.island.resumed_step else Limit.FIRST_STEP


@kernel("b1(ws, f8)")
def _overran(ws: Workspace, h: float) -> bool:
    """True if the bodies move farther in the step of ``h`` [s] than the neighbour list is valid for."""
    if ws.model.n_spheres + ws.model.n_pairs == 0:
        return False
    evaluate_driven_bodies(ws, ws.island.time + h, ws.step.y_new.start)
    return overran_list(ws, h)


@kernel("void(ws, f8, f8, f8)")
def _remember_step(ws: Workspace, h: float, error: float, wanted: float) -> None:
    """Store the length [s] and the relative error of the accepted step, and propose the length of the next step.

    If the accepted step is shorter than ``wanted`` [s], the next step is at least ``wanted``.
    """
    ws.step.h, ws.step.error = h, error
    # remove the limit of the first step after an event: it does not hold for the next step
    ws.island.first_step = math.inf
    # a step that was shortened does not shorten the next one
    following = h * step_factor(error)
    if h < wanted:
        following = max(following, wanted)
    if not is_held(ws):
        ws.island.free_step = following
    elif ws.island.n_integrated > 0:
        ws.island.closed_step = following


@kernel("Status(ws)")
def accepted_step(ws: Workspace) -> Status:
    """Take a step that meets the tolerance, and store its length in ``ws.step.h`` [s].

    Returns ``RUNNING``, or the reason why no step was found.
    """
    wanted = _wanted(ws)
    ws.step.relaxation = relaxation_rate(ws)
    h = _first_attempt(ws, wanted)
    ws.step.limit = _limit(ws, wanted, h)
    explained = 0.0
    while True:
        if ws.request.is_interrupted:
            return Status.NOT_FINITE
        ws.step.halting_contact = -1
        error = try_length(ws, h)
        share = part_before_stop(ws, h) if error <= 1.0 and ws.island.stage_time > 0.0 else 1.0
        if error <= 1.0 and ws.island.singular_contact >= 0:
            # beyond the Painleve singularity the force of a sliding contact is unstable: the step must end before it
            h *= 0.5
            wanted = 0.0
            ws.step.limit = Limit.SINGULARITY
        elif error <= 1.0 and ws.island.averaged_until < math.inf and deviation_of_gaps(ws) > _ASTRAY:
            h *= 0.5
            ws.step.limit = Limit.AVERAGING
        elif error <= 1.0 and _overran(ws, h):
            h *= 0.5
            ws.step.limit = Limit.NEIGHBOUR_LIST
        elif share < 1.0:
            h *= share
            wanted = 0.0
            ws.step.limit = Limit.STOPPING_SLIP
        elif error <= 1.0:
            _remember_step(ws, h, error, wanted)
            return Status.RUNNING
        else:
            ws.totals.n_rejected += 1
            ws.step.limit = Limit.ERROR
            wanted = 0.0
            if not error < math.inf and 0.1 * h < ws.tolerance.time:
                return Status.NOT_FINITE
            factor = step_factor(error) if error < math.inf else 0.1
            if ws.island.stage_time > 0.0 and error > explained > 0.0:
                # if a slip velocity decays within the step, its error falls with a low power of the step length:
                # assume the first power
                factor = max(SHRINK, SAFETY / error)
            explained = factor * factor * error
            h *= factor
        if not h >= ws.tolerance.time:
            return Status.STEP_TOO_SMALL
