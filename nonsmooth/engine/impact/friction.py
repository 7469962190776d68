"""Friction inside an impact: who sticks, who slips, and which way a slip starts."""

from __future__ import annotations

from nonsmooth.engine.contact.cone import SWEEPS, gauss_seidel
from nonsmooth.engine.contact.forces import friction_of_slip, resolve
from nonsmooth.engine.contact.polish import polish
from nonsmooth.engine.contact.problem import friction_coefficient, slip_coefficient
from nonsmooth.engine.contact.trial import hold_tried
from nonsmooth.engine.delassus.delassus import add_product, diagonal_block
from nonsmooth.engine.impact.guards import GUARDS, RATE_GUARD
from nonsmooth.engine.impact.rates import COMPRESSION, EXPANSION, HELD, NOISE, evaluate_impact_rates, normal_force
from nonsmooth.engine.memory.modes import OPEN, SLIDE, STICK
from nonsmooth.engine.native.kernel import (
    Workspace,
    entry_point,
    impact_state,
    kernel,
)
from nonsmooth.engine.numerics.vectors import length

_IDLE = 1e-10
"""A slip that starts with less than this part of the largest acceleration does not."""


@kernel()
def _stop_slips(ws: Workspace) -> None:
    """Bring the slip velocities of the contacts at rest to exactly zero, by the impulses of least norm.

    What is left there is round-off, but its direction would stiffen the slip that starts from it.
    """
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.is_normal_force_unknown = False
        active.sticks = active.is_at_rest
        active.normal_force = active.friction_coefficient = 0.0
        for r in range(3):
            active.free[r] = active.rate[r]
    resolve(ws)
    for a in range(ws.problem.n_active):
        active, state = ws.actives[a], impact_state(ws.floats, ws.impact.y.start, a)
        for r in range(1, 3):
            state.impulse[r] += active.force[r]
    evaluate_impact_rates(ws, ws.impact.y.start)


@kernel()
def _polish(ws: Workspace) -> None:
    """Make the directions of slips that start exact: next to the bound they decide whether and where these go."""
    ws.problem.acceleration_scale = 0.0
    for a in range(ws.problem.n_active):
        active, own = ws.actives[a], diagonal_block(ws, a)
        active.has_given_force = active.phase == COMPRESSION or active.phase == EXPANSION
        active.mode_tried = STICK if active.sticks else SLIDE
        if active.normal_force <= 0.0:
            active.mode_tried = OPEN
        active.direction_found = active.direction
        ws.problem.acceleration_scale = max(
            ws.problem.acceleration_scale, max(own.nn, own.t11, own.t22) * abs(active.normal_force)
        )
    if polish(ws) == 0:
        for a in range(ws.problem.n_active):
            active = ws.actives[a]
            active.direction = active.direction_found
        hold_tried(ws)


@kernel()
def _hold_idle(ws: Workspace) -> None:
    """Let stick who was found on its bound but does not start to slip.

    Where several contacts share their friction at will, some stand on their bounds by chance.
    """
    largest = 0.0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        largest = max(largest, diagonal_block(ws, a).nn * active.normal_force)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if active.is_at_rest and not active.sticks and active.static_coefficient > 0.0:
            growth = (
                add_product(ws, 0.0, a, 1, ws.problem.forces.start),
                add_product(ws, 0.0, a, 2, ws.problem.forces.start),
            )
            if length(growth) <= _IDLE * largest:
                active.sticks = True


@kernel("b1(ws, i8)")
def _gets_away(ws: Workspace, a: int) -> bool:
    """Return 1 if the active contact ``a`` slips faster and faster where a contact begins or ends to be pressed.

    No force jumps there.  To stop the slip would turn the rates of others by what it has, and it would start again.
    """
    active = ws.actives[a]
    if (
        ws.step.guard < 0
        or ws.step.guard % GUARDS != RATE_GUARD
        or length(active.slip) <= NOISE * ws.impact.speed_scale
    ):
        return False
    growth = active.slip[0] * add_product(ws, 0.0, a, 1, ws.problem.forces.start)
    growth += active.slip[1] * add_product(ws, 0.0, a, 2, ws.problem.forces.start)
    return growth > 0.0


@entry_point("void(ws, f8)")
def choose_friction(ws: Workspace, probe: float) -> None:
    """Decide which contacts at rest stick and which way the others start to slide.

    ``probe`` is the pseudo-time after which forces are compared where none has built up yet.
    """
    evaluate_impact_rates(ws, ws.impact.y.start)
    open_question = 0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        speed = length(active.slip)
        active.static_coefficient = friction_coefficient(ws, active.contact, 0.0)
        active.friction_coefficient = slip_coefficient(ws, active.contact, speed)
        slow = (speed <= active.rest_slip and not _gets_away(ws, a)) or active.sticks
        # without friction nothing holds a contact, and nothing can stop a slip, however slow
        active.is_at_rest = slow and (
            active.static_coefficient > 0.0 or (speed == 0.0 and active.friction_coefficient > 0.0)
        )
        open_question = max(open_question, active.is_at_rest)
    if open_question == 1:
        _stop_slips(ws)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        state = impact_state(ws.floats, ws.impact.y.start, a)
        c = active.contact
        contact = ws.contacts[c]
        v1, v2 = active.slip
        speed = length(active.slip)
        active.friction_coefficient = slip_coefficient(ws, c, speed)
        if speed == 0.0 and max(active.friction_coefficient, active.static_coefficient) > 0.0:
            # stopping the slips of others has stopped this one, too
            active.is_at_rest = True
        active.is_normal_force_unknown = active.phase == HELD
        active.sticks = False
        x = state.deformation
        active.normal_force = 0.0
        if active.phase == COMPRESSION or active.phase == EXPANSION:
            x = x if x > 0.0 else -probe * active.gap_rate
            active.normal_force = normal_force(ws, a, x)
        active.direction = contact.direction
        if not active.is_at_rest and speed > 0.0:
            active.direction = v1 / speed, v2 / speed
        friction_of_slip(ws, a)
    if open_question == 1:
        for i in range(3 * ws.problem.n_active):
            ws.problem.free_accelerations[i] = 0.0
        gauss_seidel(ws, SWEEPS)
        _polish(ws)
        _hold_idle(ws)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        c = active.contact
        contact = ws.contacts[c]
        if active.normal_force <= 0.0:
            active.sticks = False
        contact.direction = active.direction


@kernel("void(ws, i8)")
def break_away(ws: Workspace, a: int) -> None:
    """Let the active contact ``a`` slip against the friction that held it."""
    active = ws.actives[a]
    contact = ws.contacts[active.contact]
    t1, t2 = active.friction
    norm = length(active.friction)
    active.sticks = False
    if norm > 0.0:
        contact.direction = -t1 / norm, -t2 / norm
