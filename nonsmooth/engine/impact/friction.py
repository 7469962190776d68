"""Friction inside an impact: which contacts stick, which slip, and in which direction a slip starts.

Where a phase changes, contacts at rest must choose. Their modes solve the problem of Coulomb friction for the slopes of
the velocities, Eq. (17) with impulses in place of forces:

1. Slips at rest are stopped exactly. What is left of them is round-off, but its direction would act as that of a slip.
2. If all contacts at rest can stick, they do. If not, the search for modes of the motion
   (:mod:`nonsmooth.engine.contact.search`) finds which do, and the exact directions of the others. Next to the static
   bound the directions decide whether a slip grows. If the search finds none, contacts slip and stop one by one.

Between two choices the directions of slips follow from their velocities. :func:`count_stopped_slips`, :func:`orient`
and :func:`count_slow_step` keep them well-defined.
"""

from __future__ import annotations

from nonsmooth.engine.contact.forces import friction_of_slip, resolve
from nonsmooth.engine.contact.implicit_slip import oppose_slips
from nonsmooth.engine.contact.problem import friction_coefficient, slip_coefficient
from nonsmooth.engine.contact.search import find_modes
from nonsmooth.engine.contact.trial import NO_FORCE, find_tried_forces, verify
from nonsmooth.engine.delassus.delassus import diagonal_block, slip_acceleration
from nonsmooth.engine.impact.guards import GuardKind, guard_of
from nonsmooth.engine.impact.rates import evaluate_impact_rates, slip_slope
from nonsmooth.engine.impact.state import NOISE, is_loaded, normal_force, state_of
from nonsmooth.engine.memory.layout import FIRST_ROW, SECOND_ROW
from nonsmooth.engine.memory.modes import Mode, Phase
from nonsmooth.engine.memory.solvers import Solver
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, entry_point, kernel
from nonsmooth.engine.numerics.arrays import clear
from nonsmooth.engine.numerics.vectors import length, unit

_PATIENCE = 20
"""Number of steps that a slip may take next to rest without slowing down, before friction is chosen again."""


# --- the choice at a change of phase ----------------------------------------------------------------------------------


@entry_point("void(ws, f8, b1)")
def choose_friction(ws: Workspace, probe: float, turns_rate: bool) -> None:
    """Decide which contacts at rest stick and in which direction the others start to slide, where a phase begins.

    ``probe`` is the pseudo-time after which forces are compared if none has built up yet. ``turns_rate`` is true if the
    sign of a gap rate has just changed. Before, the slips of contacts at rest are stopped exactly, by impulses.
    """
    evaluate_impact_rates(ws, ws.impact.y.start)
    has_contact_at_rest = False
    for active in ws.actives:
        _find_rest(ws, active, turns_rate)
        has_contact_at_rest = has_contact_at_rest or active.is_at_rest
    if has_contact_at_rest:
        _stop_slips(ws)
    for active in ws.actives:
        _write_problem(ws, active, probe)
    if has_contact_at_rest:
        # slopes of rates have no part without contact forces
        clear(ws.floats, ws.problem.free_accelerations.start, 3 * len(ws.actives))
        _find_modes(ws)
    for active in ws.actives:
        # without a normal force no friction holds the contact
        if active.normal_force <= 0.0:
            active.sticks = False
        ws.contacts[active.contact].direction = active.direction


@kernel("void(ws, ActiveContact, b1)")
def _find_rest(ws: Workspace, active: ActiveContact, turns_rate: bool) -> None:
    """Write direction and coefficients of the friction of an active contact, and whether it is at rest and may stick.

    A contact that sticks is at rest, and so is one with a slow slip, unless that is about to grow. Without friction
    nothing holds a contact, and nothing can stop a slip, however slow.
    """
    speed = length(active.slip)
    active.direction = ws.contacts[active.contact].direction
    active.static_coefficient = friction_coefficient(ws, active.contact, speed=0.0)
    active.friction_coefficient = slip_coefficient(ws, active.contact, speed)
    gets_away = turns_rate and _gets_away(ws, active)
    is_slow = (speed <= active.rest_slip and not gets_away) or active.sticks
    # a law may have sliding friction but no static one: then only a slip of exactly zero has to choose a direction
    is_still = speed == 0.0 and active.friction_coefficient > 0.0
    active.is_at_rest = is_slow and (active.static_coefficient > 0.0 or is_still)


@kernel("b1(ws, ActiveContact)")
def _gets_away(ws: Workspace, active: ActiveContact) -> bool:
    """True if the slip of an active contact is more than round-off and grows.

    Such a slip is not stopped where the sign of a gap rate changes. No force jumps there, so the slip would start
    again, and stopping it would change the rates of other contacts.
    """
    if length(active.slip) <= NOISE * ws.impact.speed_scale:
        return False
    (v1, v2), (growth_1, growth_2) = active.slip, slip_slope(ws, active)
    return v1 * growth_1 + v2 * growth_2 > 0.0


@kernel()
def _stop_slips(ws: Workspace) -> None:
    """Bring the slip velocities of the contacts at rest to exactly zero, by the impulses of least norm.

    What is left of such a slip is round-off, whose direction would act as that of a slip. The energy counts as
    dissipated by friction.
    """
    for active in ws.actives:
        # the equations of forces, posed with rates: friction impulses of the contacts at rest are the only unknowns
        active.is_normal_force_unknown = False
        active.sticks = active.is_at_rest
        active.normal_force = active.friction_coefficient = 0.0
        for r in range(3):
            active.free[r] = active.rate[r]
    # TODO: contacts closer than about 1e-4 of the size slip so slowly, too, if the bodies turn about them; the impulse
    # that stops them is then larger than friction can give
    resolve(ws)
    for active in ws.actives:
        state = state_of(ws, active)
        for r in range(1, 3):
            state.impulse[r] += active.force[r]
            # the mean of the rates before and after is half of that before
            state.dissipated -= 0.5 * active.force[r] * active.rate[r]
    evaluate_impact_rates(ws, ws.impact.y.start)


@kernel("void(ws, ActiveContact, f8)")
def _write_problem(ws: Workspace, active: ActiveContact, probe: float) -> None:
    """Write the data for the choice of friction of an active contact: coefficient, slip direction, normal force [N].

    The normal force of a held contact is unknown, that of a loaded one follows from its deformation. ``probe`` is a
    short pseudo-time. Friction is written as if the contact slid.
    """
    speed = length(active.slip)
    active.friction_coefficient = slip_coefficient(ws, active.contact, speed)
    if speed == 0.0 and max(active.friction_coefficient, active.static_coefficient) > 0.0:
        # stopping the slips of others has stopped this one, too
        active.is_at_rest = True
    active.has_given_force = active.phase != Phase.HELD
    active.sticks = False
    active.given_force = 0.0
    if is_loaded(active):
        # a deformation that has not begun is taken a short pseudo-time later
        deformation = state_of(ws, active).deformation
        if not deformation > 0.0:
            deformation = -probe * active.gap_rate
        active.given_force = normal_force(ws, active, deformation)
    active.normal_force = active.given_force
    active.direction = ws.contacts[active.contact].direction
    if not active.is_at_rest and speed > 0.0:
        active.direction = unit(active.slip)
    friction_of_slip(ws, active.index)


@kernel()
def _find_modes(ws: Workspace) -> None:
    """Find which contacts at rest stick, and in which directions the others start to slip.

    The modes fulfil the contact laws exactly, or are the last ones that the search has tried.
    """
    # of several solutions, the one in which most contacts stick is taken, so that is tried first
    ws.problem.effort = ws.problem.acceleration_scale = 0.0
    for active in ws.actives:
        may_stick = active.is_at_rest and active.static_coefficient > 0.0
        active.mode_past = Mode.STICK if may_stick else Mode.SLIDE
        # without a normal force no friction holds the contact
        if active.has_given_force and not active.given_force > 0.0:
            active.mode_past = Mode.OPEN
        active.mode_tried = active.mode_past
        # the largest acceleration under a contact's own normal force
        own = diagonal_block(ws, active.index)
        acceleration = max(own.nn, own.t11, own.t22) * active.given_force
        ws.problem.acceleration_scale = max(ws.problem.acceleration_scale, acceleration)
    all_stick = not _is_too_fast(ws) and verify(ws, is_lenient=False)
    if not (all_stick or find_modes(ws, Solver.NEWTON) or find_modes(ws, Solver.GAUSS_SEIDEL)):
        _exchange_modes(ws)
    for active in ws.actives:
        active.sticks = active.mode_tried == Mode.STICK


@kernel("b1(ws)")
def _is_too_fast(ws: Workspace) -> bool:
    """True if friction within its bounds cannot keep all contacts in mode ``STICK`` from slipping.

    Let a be the slip accelerations of these contacts without their friction. Friction f that stops them fulfils
    G f = -a, so |a|^2 = -(G a) . f, and within its bounds this is at most the sum of mu f_n |G a| over the contacts.
    It takes two products, no solution. An unknown normal force f_n makes the result False.
    """
    for active in ws.actives:
        if not active.has_given_force:
            return False
        active.normal_force, active.friction = active.given_force, (0.0, 0.0)
        if active.mode_tried == Mode.SLIDE:
            friction_of_slip(ws, active.index)
    for active in ws.actives:
        active.acceleration[FIRST_ROW], active.acceleration[SECOND_ROW] = slip_acceleration(ws, active)
    square = reach = 0.0
    for active in ws.actives:
        active.normal_force, active.friction = 0.0, (0.0, 0.0)
        if active.mode_tried == Mode.STICK:
            active.friction = active.slip_acceleration
            square += active.friction[0] ** 2 + active.friction[1] ** 2
    for active in ws.actives:
        if active.mode_tried == Mode.STICK:
            reach += active.static_coefficient * active.given_force * length(slip_acceleration(ws, active))
    return square > (1.0 + NO_FORCE) * reach


@kernel()
def _exchange_modes(ws: Workspace) -> None:
    """Find modes by releasing contacts that exceed their bound, and stopping those that would slip back, one by one."""
    for active in ws.actives:
        if active.mode_past == Mode.STICK:
            active.mode_past, active.mode_tried = Mode.SLIDE, Mode.STICK
        null_space_force = ws.contacts[active.contact].null_space_force
        for r in range(3):
            # redundant impulses are those of least norm; the motion chooses its forces anew after the impact
            null_space_force[r] = 0.0
    if not oppose_slips(ws):
        find_tried_forces(ws)


# --- between two choices ----------------------------------------------------------------------------------------------


@kernel("void(ws, ActiveContact)")
def break_away(ws: Workspace, active: ActiveContact) -> None:
    """Let an active contact that sticks slip in the direction opposite to its friction.

    Without friction the last direction is kept.
    """
    t1, t2 = active.friction
    active.sticks = False
    if length(active.friction) > 0.0:
        ws.contacts[active.contact].direction = unit((-t1, -t2))


@kernel("b1(ActiveContact)")
def has_stopped(active: ActiveContact) -> bool:
    """True if an active contact slides with friction at a speed that counts as rest: it must choose friction."""
    slides = not active.sticks and active.friction_coefficient != 0.0
    return slides and length(active.slip) <= active.rest_slip


@kernel()
def count_stopped_slips(ws: Workspace) -> None:
    """Make the stops of slips in an accepted implicit step final: the contacts stick. Each stop counts as a phase."""
    if ws.impact.is_step_implicit:
        ws.impact.is_step_implicit = False
        # slips may have turned by any angle within the step
        orient(ws)
    for active in ws.actives:
        # a stop that is still marked would be undone with the next attempt of a step
        if active.was_halted:
            ws.event.n_phases += 1
        active.was_halted = False


@kernel()
def orient(ws: Workspace) -> None:
    """Set the slip directions of the step that begins to those of the present slips.

    The friction guard is the component of the slip along this direction, so it becomes the speed of the slip. Slips
    that count as rest keep the direction of before.
    """
    for active in ws.actives:
        speed = length(active.slip)
        if active.phase != Phase.IDLE and not active.sticks and speed > active.rest_slip:
            ws.contacts[active.contact].direction = unit(active.slip)
            # NOISE is in every friction guard, so that round-off does not fire it
            guard_of(ws, active, GuardKind.FRICTION).value = NOISE + speed / ws.impact.speed_scale


@kernel("b1(ws)")
def count_slow_step(ws: Workspace) -> bool:
    """True if friction must be chosen again: a slip next to rest slows down, or slips have been there for many steps.

    Next to rest the direction of a slip is stiff, and its speed is below the error. Counts the steps in ``slow_steps``,
    which is zero again after True, or after a step without such a slip.
    """
    is_slow = False
    for active in ws.actives:
        if active.phase == Phase.IDLE or not has_stopped(active):
            continue
        (v1, v2), (growth_1, growth_2) = active.slip, slip_slope(ws, active)
        is_slow = True
        # a slip that slows down is stopped at once: this step makes the count exceed its limit
        if v1 * growth_1 + v2 * growth_2 < 0.0:
            ws.impact.slow_steps = _PATIENCE
    ws.impact.slow_steps = ws.impact.slow_steps + 1 if is_slow else 0
    if ws.impact.slow_steps <= _PATIENCE:
        return False
    ws.impact.slow_steps = 0
    return True
