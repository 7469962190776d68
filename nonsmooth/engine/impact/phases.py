"""Phases of the contacts in an impact: where they start, and how they follow one another.

    idle -----> compression <-----> expansion -----> idle
     ^              |
     +--- held <----+   without restitution

compression  The contact approaches and stores energy. It ends where the gap rate is zero.
expansion    The contact separates and returns energy. It ends where its energy is used up, or in a new compression if
             another contact presses the bodies together again.
held         Without restitution the stored energy is lost at once, and the contact stays closed while it is pressed.
idle         No force acts. An approach begins a new compression.

The end of a phase is a root of a guard (:mod:`nonsmooth.engine.impact.guards`). Several guards may vanish together, as
in a symmetric impact, so all of them are checked wherever one fires.
"""

from __future__ import annotations

from nonsmooth.engine.impact.end import account, end_phase, lose_energy
from nonsmooth.engine.impact.friction import break_away, choose_friction, has_stopped
from nonsmooth.engine.impact.guards import TOGETHER, GuardKind, guard_of, is_rate_guard, prepare_guards
from nonsmooth.engine.impact.rates import evaluate_impact_forces, is_pressed
from nonsmooth.engine.impact.state import NOISE, is_loaded, least_efficiency, returned_part, state_of, state_size
from nonsmooth.engine.memory.modes import Phase
from nonsmooth.engine.native.kernel import ActiveContact, ImpactGuard, Workspace, kernel
from nonsmooth.engine.numerics.arrays import clear
from nonsmooth.engine.numerics.vectors import length, unit

_SEED = 1e-3
"""Deformation from which an impact without collision starts, relative to that of a full compression."""
_NO_RETURN = 2.0**-52
"""Efficiency that counts as none [1]: the spacing of doubles at 1. All of the stored energy is then lost."""
_FAINT = 0.5
"""Gap rate below which a phase of a contact that a wave of compression has passed ends.

It is relative to the gap rate above which such a phase begins. It is well below 1, so that a phase that has ended does
not begin again at once.
"""


# --- the start --------------------------------------------------------------------------------------------------------


@kernel("void(ws, f8, f8)")
def start_phases(ws: Workspace, probe: float, seed: float) -> None:
    """Set the phases in which the active contacts start, and their friction.

    ``probe`` is a short pseudo-time, after which forces are compared. ``seed`` is the speed of an impact without
    collision [m/s], or zero. A contact at rest that the other contacts press together takes part from the start.
    """
    clear(ws.floats, ws.impact.y.start, state_size(ws))
    ws.event.n_phases = 0
    for active in ws.actives:
        _start(ws, active, seed > 0.0)
    choose_friction(ws, probe, turns_rate=False)
    has_new = False
    for active in ws.actives:
        rests = active.phase == Phase.IDLE and active.gap_rate_before <= ws.impact.rest_speed
        if rests and is_pressed(ws, active):
            active.phase = Phase.COMPRESSION
            ws.event.n_phases += 1
            has_new = True
    # the new compressions have other forces
    if has_new:
        choose_friction(ws, probe, turns_rate=False)


@kernel("void(ws, ActiveContact, b1)")
def _start(ws: Workspace, active: ActiveContact, is_without_collision: bool) -> None:
    """Start an active contact: in compression if it approaches, or if the contact problem has no force for it.

    Such a contact needs an impact without collision, and starts with a small deformation, whose energy is neglected.
    Others start idle.
    """
    active.energy_stored = active.energy_returned = active.work_accounted = 0.0
    active.sticks = active.was_halted = False
    active.phase = Phase.IDLE
    has_no_force = is_without_collision and ws.contacts[active.contact].has_no_force
    if has_no_force:
        state_of(ws, active).deformation = _SEED * active.deformation_scale
    if has_no_force or active.gap_rate_before < -NOISE * ws.impact.speed_scale:
        active.phase = Phase.COMPRESSION
        ws.event.n_phases += 1


# --- changes ----------------------------------------------------------------------------------------------------------


@kernel("void(ws, f8, i8)")
def switch_phases(ws: Workspace, probe: float, fired: int) -> None:
    """Change the phases whose guards have come to zero: the guard ``fired``, and all that vanish together with it.

    The guards are evaluated before, and prepared for the next step after. ``probe`` is a short pseudo-time, after which
    forces are compared if none has built up yet.
    """
    needs_friction = False
    for active in ws.actives:
        needs_friction = _switch(ws, active, fired) or needs_friction
    if needs_friction:
        choose_friction(ws, probe, turns_rate=is_rate_guard(fired))
    prepare_guards(ws)


@kernel("b1(ws, ActiveContact, i8)")
def _switch(ws: Workspace, active: ActiveContact, fired: int) -> bool:
    """Change the phase or the friction of an active contact if a guard of it vanishes. True if friction must be chosen.

    The step ended at the guard ``fired``. At most one change is made: that of the energy, else of the gap rate, else of
    the friction. If a contact opens under load, the forces of the others jump, and friction is chosen.
    """
    if is_loaded(active) and _vanishes(guard_of(ws, active, GuardKind.ENERGY), fired):
        opens_under_load = state_of(ws, active).lost > 0.0
        _pass_wave(ws, active)
        return opens_under_load
    if _vanishes(guard_of(ws, active, GuardKind.RATE), fired):
        ws.event.n_phases += 1
        needs_friction = _turn(ws, active)
        # if joints leave one line to move along, slip and approach come to rest together
        return has_stopped(active) or needs_friction
    if _vanishes(guard_of(ws, active, GuardKind.FRICTION), fired):
        ws.event.n_phases += 1
        return _switch_friction(ws, active)
    return False


@kernel("b1(ImpactGuard, i8)")
def _vanishes(guard: ImpactGuard, fired: int) -> bool:
    """True if a guard is the one that has ``fired``, or vanishes together with it."""
    return guard.index == fired or guard.value < TOGETHER


@kernel("void(ws, ActiveContact)")
def _pass_wave(ws: Workspace, active: ActiveContact) -> None:
    """End the phase of an active contact, and count the wave of compression that has passed it.

    Behind a wave, errors must not be taken for a new one (see :func:`end_faint`).
    """
    end_phase(ws, active)
    ws.contacts[active.contact].n_waves += 1
    ws.event.n_phases += 1


@kernel("b1(ws, ActiveContact)")
def _turn(ws: Workspace, active: ActiveContact) -> bool:
    """Change the phase of an active contact whose gap rate or holding force vanishes. True if friction must be chosen.

    ``lost`` becomes the energy that an expansion does not return.
    """
    was = active.phase
    if was == Phase.COMPRESSION:
        account(ws, active)
        # without restitution there is no expansion
        if least_efficiency(ws, active) > _NO_RETURN:
            state = state_of(ws, active)
            # round-off may start a compression, which then stores nothing: an expansion would give energy from nowhere
            if not state.energy > 0.0:
                end_phase(ws, active)
                return False
            active.phase = Phase.EXPANSION
            state.lost = (1.0 - returned_part(ws, active)) * state.energy
            return False
        _hold(ws, active)
        return True
    # the force that holds the contact would have to pull
    if was == Phase.HELD:
        active.phase = Phase.IDLE
        active.sticks = False
        return False
    if was == Phase.EXPANSION:
        # one wave of compression has passed the contact, and another one comes
        account(ws, active)
        ws.contacts[active.contact].n_waves += 1
    # the bodies approach, or approach again; a contact that was loaded keeps its friction
    active.phase = Phase.COMPRESSION
    return was == Phase.IDLE


@kernel("void(ws, ActiveContact)")
def _hold(ws: Workspace, active: ActiveContact) -> None:
    """Lose the stored energy of an active contact without restitution. It is then held if it is pressed, else idle."""
    lose_energy(ws, active)
    active.phase = Phase.HELD
    evaluate_impact_forces(ws, ws.impact.y.start)
    # its force would have to pull
    if active.normal_force < 0.0:
        active.phase = Phase.IDLE


@kernel("b1(ws, ActiveContact)")
def _switch_friction(ws: Workspace, active: ActiveContact) -> bool:
    """Let an active contact that sticks break away, or a slip turn. True if a slip stops: friction must be chosen.

    The guard of a slip is its component along its first direction. A slip that has only turned far from it continues,
    and the guard takes its new direction. So does any slip of a contact without a normal force, which has no friction:
    to choose it would stop the slip, the others would start it again, and the impact would never end.
    """
    if active.sticks:
        break_away(ws, active)
        return False
    if active.normal_force > 0.0 and not length(active.slip) > active.rest_slip:
        return True
    ws.contacts[active.contact].direction = unit(active.slip)
    return False


# --- in a window ------------------------------------------------------------------------------------------------------


@kernel()
def end_faint(ws: Workspace) -> None:
    """End the phases of contacts of a window that the wave has passed, if energy and rate are below the tolerance.

    Without this, errors behind the wave would keep contacts in the window. The stored energy of a contact is known to
    the tolerance only. Force and deformation are known better, so their product decides. Prepares the guards.
    """
    # faint_rate: error of rates, relative to the largest speed of the impact; 0 if all contacts are in the window
    faint_rate = ws.impact.faint_rate
    for active in ws.actives:
        is_compressed_again = active.phase == Phase.COMPRESSION and ws.contacts[active.contact].n_waves > 0
        has_passed = active.phase == Phase.EXPANSION or is_compressed_again
        energy = active.normal_force * state_of(ws, active).deformation
        # energies are quadratic in rates
        is_weak = energy <= faint_rate * faint_rate * active.energy_scale
        # well below the rate at which a phase behind the wave begins, so that the two do not alternate
        if has_passed and is_weak and abs(active.gap_rate) <= _FAINT * faint_rate * ws.impact.speed_scale:
            _pass_wave(ws, active)
    prepare_guards(ws)


@kernel("b1(ws)")
def has_reached_rim(ws: Workspace) -> bool:
    """True if a contact in the outermost layer of the window is not idle, so that a new window must be drawn.

    Its neighbours, which may be outside, could take part.
    """
    for active in ws.actives:
        if active.phase != Phase.IDLE and ws.contacts[active.contact].is_at_rim:
            return True
    return False
