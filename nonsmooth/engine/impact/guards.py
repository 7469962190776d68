"""Guards: the event functions that end the phase of a contact within an impact.

A guard is positive while its phase is valid. The phase ends where the guard falls through zero. Each active contact has
three, all of order 1:

===========  ==========================  =========================================  ====================================
phase        guard of the rate           guard of the energy                        guard of the friction
===========  ==========================  =========================================  ====================================
idle         gap rate                    1                                          1
compression  approach                    deformation, with a slack                  slip along its initial direction, or
expansion    gap rate                    deformation; energy left if it opens       distance to the static bound if the
                                         under load or is lone                      contact sticks; 1 without friction
held         normal force                1
===========  ==========================  =========================================  ====================================

Round-off may turn the sign of a guard that is about zero. A guard is armed when it has been positive in its phase, and
an armed guard fires at zero. A disarmed guard fires only when it is negative by more than the error of a switch. Guards
of the motion divide out a known root instead. Here several guards may be about zero where a phase begins, and their
growth is not known before the first step.
"""

from __future__ import annotations

from enum import IntEnum

from nonsmooth.engine.contact.forces import evaluate_margins
from nonsmooth.engine.impact.rates import evaluate_impact_forces, write_rates
from nonsmooth.engine.impact.state import NOISE, ContactState, is_lone, state_at
from nonsmooth.engine.memory.layout import IMPACT_GUARDS
from nonsmooth.engine.memory.modes import Phase
from nonsmooth.engine.native.kernel import ActiveContact, ImpactGuard, Workspace, kernel, result
from nonsmooth.engine.numerics.vectors import length

NO_GUARD = -1
"""Number in place of a guard if no guard has fired."""
TOGETHER = 1e-13
"""Value [1] below which guards fire together. Round-off decides which of them is first."""
_SLACK = 1e-9
"""Deformation below zero at which a compression of round-off ends, relative to that of a full compression."""
_VIOLATED = -1e-7
"""Value [1] below which a disarmed guard fires. The error of a switch leaves less."""


@result
class GuardKind(IntEnum):
    """What a guard of an active contact is a function of."""

    RATE = 0
    """The gap rate, or the force of a held contact."""
    ENERGY = 1
    """The deformation, or the stored energy."""
    FRICTION = 2
    """The slip, or the distance of the friction to its static bound."""


@kernel("ImpactGuard(ws, ActiveContact, GuardKind)")
def guard_of(ws: Workspace, active: ActiveContact, kind: GuardKind) -> ImpactGuard:
    """The guard of an active contact of this ``kind``: a function whose root ends its phase."""
    return ws.impact_guards[IMPACT_GUARDS * active.index + kind]


@kernel("b1(i8)")
def is_rate_guard(guard: int) -> bool:
    """True if ``guard`` is the number of a guard of a gap rate; False if it is another, or ``NO_GUARD``."""
    return guard != NO_GUARD and guard % IMPACT_GUARDS == GuardKind.RATE


# --- evaluation -------------------------------------------------------------------------------------------------------


@kernel("void(ws, i8)")
def evaluate_impact_guards(ws: Workspace, y: int) -> None:
    """Evaluate the forces at the impact state ``y`` and write the guards."""
    evaluate_impact_forces(ws, y)
    write_impact_guards(ws, y)


@kernel("void(ws, i8)")
def write_impact_guards(ws: Workspace, y: int) -> None:
    """Write the guards of the active contacts at the impact state ``y``, at which the forces are evaluated."""
    evaluate_margins(ws)
    for active in ws.actives:
        # the forces do not need the rates of idle contacts, but their guards do
        if active.phase == Phase.IDLE:
            write_rates(ws, active, y)
        guard_of(ws, active, GuardKind.RATE).value = _rate_guard(ws, active)
        guard_of(ws, active, GuardKind.ENERGY).value = _energy_guard(ws, active, state_at(ws, y, active))
        guard_of(ws, active, GuardKind.FRICTION).value = _friction_guard(ws, active)


@kernel("f8(ws, ActiveContact)")
def _force_scale(ws: Workspace, active: ActiveContact) -> float:
    """Force scale of an active contact [N], or 1 for the lone one, whose normal force on its clock is 1."""
    return 1.0 if is_lone(ws, active) else active.force_scale


@kernel("f8(ws, ActiveContact)")
def _rate_guard(ws: Workspace, active: ActiveContact) -> float:
    """Guard of the gap rate of an active contact, relative to the largest speed, or of the force that holds it [1].

    It is positive while a compression approaches, and while an idle contact or an expansion separates. ``NOISE`` keeps
    a rate of round-off from firing it.
    """
    rate = active.gap_rate / ws.impact.speed_scale
    if active.phase == Phase.COMPRESSION:
        return NOISE - rate
    if active.phase == Phase.HELD:
        return NOISE + active.normal_force / _force_scale(ws, active)
    # faint_rate is the error of rates in a window of a large impact, 0 without windows: an approach behind the wave, of
    # a contact that a wave of compression has passed, may be such an error
    has_passed = active.phase == Phase.IDLE and ws.contacts[active.contact].n_waves > 0
    return (ws.impact.faint_rate if has_passed and ws.impact.faint_rate > 0.0 else NOISE) + rate


@kernel("f8(ws, ActiveContact, impact_state)")
def _energy_guard(ws: Workspace, active: ActiveContact, state: ContactState) -> float:
    """Guard of the deformation or of the energy of an active contact, relative to its scale [1].

    It is 1, and never fires, for a contact that is idle or held. So it is for the compression of a lone contact, which
    alone has a load and whose energy replaces its deformation: the gap rate ends it.
    """
    if active.phase == Phase.COMPRESSION and not is_lone(ws, active):
        # a compression of round-off may start with a deformation just below zero
        return _SLACK + state.deformation / active.deformation_scale
    if active.phase == Phase.EXPANSION:
        # a contact that opens under load does so before its deformation is zero
        if is_lone(ws, active) or state.lost > 0.0:
            return (state.energy - state.lost) / active.energy_scale
        return state.deformation / active.deformation_scale
    return 1.0


@kernel("f8(ws, ActiveContact)")
def _friction_guard(ws: Workspace, active: ActiveContact) -> float:
    """Guard of the slip of an active contact, or of its friction if it sticks, relative to its scale [1].

    It is 1, and never fires, for a contact that is idle or slides without friction.
    """
    if active.phase == Phase.IDLE or (not active.sticks and active.friction_coefficient == 0.0):
        return 1.0
    if active.sticks:
        # a slip that the step has stopped was sliding earlier in it: friction that would hold it there may be too large
        margin = max(0.0, active.static_margin) if active.was_halted else active.static_margin
        return NOISE + margin / _force_scale(ws, active)
    # a slip may turn by any angle in an implicit step
    if ws.impact.is_step_implicit:
        return NOISE + length(active.slip) / ws.impact.speed_scale
    d1, d2 = ws.contacts[active.contact].direction
    v1, v2 = active.slip
    return NOISE + (v1 * d1 + v2 * d2) / ws.impact.speed_scale


# --- arming and firing ------------------------------------------------------------------------------------------------


@kernel()
def prepare_guards(ws: Workspace) -> None:
    """Evaluate the guards where a phase begins, and arm the positive ones only."""
    # length of ws.impact_guards
    ws.impact.n_guards = IMPACT_GUARDS * len(ws.actives)
    for guard in ws.impact_guards:
        guard.is_armed = False
    evaluate_impact_guards(ws, ws.impact.y.start)
    arm_impact_guards(ws)


@kernel()
def arm_impact_guards(ws: Workspace) -> None:
    """Store the present values of the guards as those at the start of a step, and arm the positive ones, too."""
    for guard in ws.impact_guards:
        guard.at_start = guard.value
        if guard.value > 0.0:
            guard.is_armed = True


@kernel("i8(ws, i8)")
def first_fired(ws: Workspace, located: int) -> int:
    """Number of the first guard in their order that has fired, other than ``located``, or ``NO_GUARD``.

    ``located`` is the guard whose root is known already. An armed guard was positive in its phase. One that was not may
    be round-off about zero, so it fires only if it is clearly negative.
    """
    for guard in ws.impact_guards:
        has_fired = (guard.value < 0.0 and guard.is_armed) or guard.value < _VIOLATED
        if has_fired and guard.index != located:
            return guard.index
    return NO_GUARD
