"""Rates of the multiple impact in pseudo-time: forces, impulses, deformations, energies, Eqs. (19) to (28).

The paper integrates over the impulse of a primary contact, Eqs. (24) to (27). Its start is singular: no energy is
stored yet, so the ratio of two forces is 0 / 0. Here one clock s drives the impulses of all contacts, dP_i = F_i ds. No
contact is primary then, and the start is regular:

    z = z_0 + G P                                  gap rate g' and slip v of all contacts, G the Delassus matrix
    dP_i/ds = (F_i, T_i)                           F_i = f_i(x_i), Eqs. (20) and (23); T_i by Coulomb's law
    dx_i/ds = -g'_i                                in compression
    dx_i/ds = -g'_i / efficiency(g'_i)             in expansion, Eq. (28)

The path in velocities and energies is that of Eqs. (24) to (28). It depends on the ratios of the stiffnesses only.

The state of a contact is (P_n, P_1, P_2, x, W, D, E, L): its impulses, its deformation, the work of its normal force,
the energy dissipated by its friction, its stored energy, and the part of that which is lost when it opens.

A lone contact, the last one with a load, has the clock s = P_n: its normal force is 1. Its energy replaces its
deformation. Forces and rates are then linear in s while a slip keeps its direction, so every phase is a polynomial,
which the integrator follows exactly. With the common clock the end of an expansion is not smooth, and costs many steps.
"""

from __future__ import annotations

from typing import Protocol

from nonsmooth.engine.contact.forces import friction_of_slip, resolve
from nonsmooth.engine.contact.problem import follow_slip
from nonsmooth.engine.delassus.delassus import add_product
from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.memory.layout import IMPACT_STATE
from nonsmooth.engine.memory.modes import Phase
from nonsmooth.engine.native.kernel import (
    ActiveContact,
    Floats,
    Workspace,
    at,
    call_scalar,
    entry_point,
    impact_state,
    kernel,
)
from nonsmooth.engine.numerics.vectors import Pair

NOISE = 1e-12
"""Rate that does not switch a phase, relative to the largest speed of the impact. It is round-off."""
_SEPARATES = 1e-300
"""Least gap rate of an expansion [m/s]. At rate 0 a law returns :func:`returned_part`, not an efficiency."""


class ContactState(Protocol):
    """Numbers of an active contact in the state of an impact, or their slopes in pseudo-time."""

    impulse: Floats
    """Impulse, n, t1, t2 [N s]; one by one below."""
    normal_force: float
    """Normal impulse; its slope is the normal force [N]."""
    friction: Pair
    """Tangential impulse; its slope is the friction [N]."""
    deformation: float
    """Deformation x [m]."""
    work: float
    """Work W of the normal force on the bodies [J]."""
    dissipated: float
    """Energy D dissipated by friction [J]."""
    energy: float
    """Stored energy E [J]."""
    lost: float
    """Part L of the stored energy that is lost when the contact opens [J]."""


# --- the state --------------------------------------------------------------------------------------------------------


@kernel("i8(ws)")
def state_size(ws: Workspace) -> int:
    """Number of floats of the state of the active contacts."""
    return IMPACT_STATE * len(ws.actives)


@kernel("impact_state(ws, i8, ActiveContact)")
def state_at(ws: Workspace, y: int, active: ActiveContact) -> ContactState:
    """Numbers of an active contact in the state, or the slope, of the impact at ``y``."""
    state: ContactState = impact_state(ws.floats, y, active.index)
    return state


@kernel("impact_state(ws, ActiveContact)")
def state_of(ws: Workspace, active: ActiveContact) -> ContactState:
    """Numbers of an active contact in the state of the impact."""
    return state_at(ws, ws.impact.y.start, active)


@kernel("b1(ActiveContact)")
def is_loaded(active: ActiveContact) -> bool:
    """True if an active contact is in compression or in expansion: its force follows from its deformation."""
    return active.phase == Phase.COMPRESSION or active.phase == Phase.EXPANSION


@kernel("b1(ws, ActiveContact)")
def is_lone(ws: Workspace, active: ActiveContact) -> bool:
    """True if the impulse of an active contact is the clock."""
    return active.index == ws.impact.lone_contact


# --- laws -------------------------------------------------------------------------------------------------------------


@kernel("f8(ws, ActiveContact, f8)")
def normal_force(ws: Workspace, active: ActiveContact, deformation: float) -> float:
    """Normal force of an active contact at a ``deformation`` [m], Eq. (20) [N]; 1 if its impulse is the clock."""
    if is_lone(ws, active):
        return 1.0
    if deformation <= 0.0:
        return 0.0
    contact = ws.contacts[active.contact]
    return call_scalar(contact.impact_force_function, deformation, at(ws.floats, contact.impact_force_parameters))


@kernel("f8(ws, ActiveContact, f8)")
def efficiency(ws: Workspace, active: ActiveContact, rate: float) -> float:
    """Efficiency of the energy transfer of an active contact at a gap ``rate`` [m/s], Eq. (28) [1]."""
    if active.is_lossless:
        return 1.0
    contact = ws.contacts[active.contact]
    return call_scalar(contact.efficiency_function, rate, at(ws.floats, contact.efficiency_parameters))


@kernel("f8(ws, ActiveContact, f8)")
def expansion_efficiency(ws: Workspace, active: ActiveContact, rate: float) -> float:
    """Efficiency of the expansion of an active contact at a gap ``rate`` [m/s], Eq. (28) [1]."""
    return efficiency(ws, active, max(rate, _SEPARATES))


@kernel("f8(ws, ActiveContact)")
def returned_part(ws: Workspace, active: ActiveContact) -> float:
    """Part of the stored energy that an active contact gives up before it opens [1]: less than 1 if under load."""
    return efficiency(ws, active, 0.0)


@kernel("f8(ws, ActiveContact)")
def least_efficiency(ws: Workspace, active: ActiveContact) -> float:
    """Smaller one of the two numbers by which an active contact loses energy [1]: at its opening, and on the way."""
    return min(returned_part(ws, active), efficiency(ws, active, _SEPARATES))


# --- rates and forces -------------------------------------------------------------------------------------------------


@kernel("void(ws, ActiveContact, i8)")
def write_rates(ws: Workspace, active: ActiveContact, y: int) -> None:
    """Write z = z_0 + G P of an active contact, its gap rate and slip velocity [m/s], at the impact state ``y``."""
    z0, (z1, z2) = active.gap_rate_before, active.slip_before
    for block in range(active.first_block, active.end_block):
        p = impact_state(ws.floats, y, ws.island.block_column[block]).impulse
        p0, p1, p2 = p[0], p[1], p[2]
        g = at(ws.floats, ws.island.delassus.start + DELASSUS * block)
        z0 += g[0] * p0 + g[1] * p1 + g[2] * p2
        z1 += g[3] * p0 + g[4] * p1 + g[5] * p2
        z2 += g[6] * p0 + g[7] * p1 + g[8] * p2
    active.gap_rate, active.slip = z0, (z1, z2)


@kernel("void(ws, i8)")
def evaluate_impact_rates(ws: Workspace, y: int) -> None:
    """Write gap rates and slip velocities [m/s] of all active contacts at the impact state ``y``."""
    for active in ws.actives:
        write_rates(ws, active, y)


@kernel("f8(ws, ActiveContact)")
def gap_rate_slope(ws: Workspace, active: ActiveContact) -> float:
    """Slope of the gap rate of an active contact under the present forces, G f [m/s per pseudo-time]."""
    return add_product(ws, 0.0, active.index, 0, ws.problem.forces.start)


@kernel("v2(ws, ActiveContact)")
def slip_slope(ws: Workspace, active: ActiveContact) -> Pair:
    """Slope of the slip velocity of an active contact under the present forces, G f [m/s per pseudo-time]."""
    forces = ws.problem.forces.start
    return add_product(ws, 0.0, active.index, 1, forces), add_product(ws, 0.0, active.index, 2, forces)


@kernel("b1(ws, ActiveContact, i8)")
def _write_force(ws: Workspace, active: ActiveContact, y: int) -> bool:
    """Write rates and force of an active contact at the impact state ``y``. True if a part of its force is unknown.

    Friction that sticks and the normal force of a held contact are unknown. An idle contact has no force. Its rates are
    for its guard only, and are written with that.
    """
    if active.phase == Phase.IDLE:
        active.is_normal_force_unknown, active.normal_force, active.friction = False, 0.0, (0.0, 0.0)
        return False
    write_rates(ws, active, y)
    active.normal_force = normal_force(ws, active, state_at(ws, y, active).deformation) if is_loaded(active) else 0.0
    active.is_normal_force_unknown = active.phase == Phase.HELD
    if active.sticks:
        return True
    follow_slip(ws, active.index, active.slip, active.rest_slip, ws.impact.is_step_implicit)
    friction_of_slip(ws, active.index)
    return active.is_normal_force_unknown


@kernel()
def _complete_forces(ws: Workspace) -> None:
    """Find the unknown forces: those that keep gap rates and slips of what is held and what sticks."""
    for i in range(3 * len(ws.actives)):
        ws.problem.free_accelerations[i] = 0.0
    resolve(ws)


@entry_point("void(ws, i8)")
def evaluate_impact_forces(ws: Workspace, y: int) -> None:
    """Write the forces of the active contacts [N] at the impact state ``y``, in the present phases."""
    has_unknown = False
    for active in ws.actives:
        has_unknown = _write_force(ws, active, y) or has_unknown
    if has_unknown:
        _complete_forces(ws)


# --- slopes -----------------------------------------------------------------------------------------------------------


@entry_point("void(ws, i8, i8)")
def impact_slope(ws: Workspace, y: int, out: int) -> None:
    """Write d(P, x, W, D, E, L)/ds of all active contacts at the impact state ``y`` to ``out``."""
    has_unknown = False
    for active in ws.actives:
        has_unknown = _write_force(ws, active, y) or has_unknown
        _write_slope(ws, active, out)
    if has_unknown:
        _complete_forces(ws)
        write_impact_slope(ws, out)


@kernel("void(ws, i8)")
def write_impact_slope(ws: Workspace, out: int) -> None:
    """Write the slope of all active contacts, whose rates and forces are evaluated, to ``out``."""
    for active in ws.actives:
        _write_slope(ws, active, out)


@kernel("void(ws, ActiveContact, i8)")
def _write_slope(ws: Workspace, active: ActiveContact, out: int) -> None:
    """Write the slope of an active contact, whose rate and force are evaluated, to ``out``."""
    slope, rate, (v1, v2) = state_at(ws, out, active), active.gap_rate, active.slip
    force, (t1, t2) = active.normal_force, active.friction
    deforming = 0.0
    if active.phase == Phase.COMPRESSION:
        deforming = -rate
    elif active.phase == Phase.EXPANSION:
        deforming = -rate / expansion_efficiency(ws, active, rate)
    slope.normal_force, slope.friction = force, (t1, t2)
    slope.deformation = 0.0 if is_lone(ws, active) else deforming
    slope.work = slope.dissipated = 0.0
    if active.phase != Phase.IDLE:
        # the rates of an idle contact may be those of a rejected step, and not finite
        slope.work = force * rate
        slope.dissipated = -(t1 * v1 + t2 * v2)
    slope.energy = force * deforming
    slope.lost = 0.0
