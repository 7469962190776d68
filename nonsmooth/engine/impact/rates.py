"""Rates of the multiple impact in pseudo-time: forces, impulses, deformations, energies, Eqs. (19) to (28).

The paper integrates over the impulse of a primary contact, Eqs. (24) to (27). Its start is singular: no energy is
stored yet, so the ratio of two forces is 0 / 0. Here one clock s drives the impulses of all contacts, dP_i = F_i ds. No
contact is primary then, and the start is regular:

    z = z_0 + G P                                  gap rate g' and slip v of all contacts, G the Delassus matrix
    dP_i/ds = (F_i, T_i)                           F_i = f_i(x_i), Eqs. (20) and (23); T_i by Coulomb's law
    dx_i/ds = -g'_i                                in compression
    dx_i/ds = -g'_i / efficiency(g'_i)             in expansion, Eq. (28)

The path in velocities and energies is that of Eqs. (24) to (28). It depends on the ratios of the stiffnesses only.

The state of a contact is (P_n, P_1, P_2, x, W, D, E, L), see :mod:`nonsmooth.engine.impact.state`.

A lone contact, the last one with a load, has the clock s = P_n: its normal force is 1. Its energy replaces its
deformation. Forces and rates are then linear in s while a slip keeps its direction, so every phase is a polynomial,
which the integrator follows exactly. With the common clock the end of an expansion is not smooth, and costs many steps.
"""

from __future__ import annotations

import math

from nonsmooth.engine.contact.forces import friction_of_slip, resolve
from nonsmooth.engine.contact.problem import follow_slip
from nonsmooth.engine.delassus.delassus import add_product, diagonal_block
from nonsmooth.engine.impact.state import NOISE, expansion_efficiency, is_loaded, is_lone, normal_force, state_at
from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.memory.layout import FIRST_ROW, NORMAL_ROW, SECOND_ROW
from nonsmooth.engine.memory.modes import Phase
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, at, entry_point, impact_state, kernel
from nonsmooth.engine.numerics.arrays import clear
from nonsmooth.engine.numerics.vectors import Pair

# --- rates and forces -------------------------------------------------------------------------------------------------


@kernel("void(ws, ActiveContact, i8)")
def write_rates(ws: Workspace, active: ActiveContact, y: int) -> None:
    """Write z = z_0 + G P of an active contact, its gap rate and slip velocity [m/s], at the impact state ``y``."""
    # G has a block of 3 x 3 numbers for each contact that acts on this one
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
    # nothing is added to the product: only contact forces change rates in an impact
    return add_product(ws, 0.0, active.index, NORMAL_ROW, ws.problem.forces.start)


@kernel("b1(ws, ActiveContact)")
def is_pressed(ws: Workspace, active: ActiveContact) -> bool:
    """True if the present forces press an active contact together: its gap rate falls, by more than round-off.

    Round-off is relative to the bounds of the terms of G f, because an entry of G is itself a sum whose terms may
    cancel, as for two faces at right angles. The force f_j of a contact changes the gap rate of contact i by at most
    sqrt(G_ii tr G_jj) |f_j|, where G_ii is the normal entry, and tr G_jj the trace of a diagonal block.
    """
    bound = 0.0
    for block in range(active.first_block, active.end_block):
        other = ws.actives[ws.island.block_column[block]]
        own, force = diagonal_block(ws, other.index), other.force
        bound += math.sqrt((own.nn + own.t11 + own.t22) * (force[0] ** 2 + force[1] ** 2 + force[2] ** 2))
    return bool(gap_rate_slope(ws, active) < -NOISE * math.sqrt(diagonal_block(ws, active.index).nn) * bound)


@kernel("v2(ws, ActiveContact)")
def slip_slope(ws: Workspace, active: ActiveContact) -> Pair:
    """Slope of the slip velocity of an active contact under the present forces, G f [m/s per pseudo-time]."""
    # nothing is added to the products: only contact forces change rates in an impact
    forces, a = ws.problem.forces.start, active.index
    return add_product(ws, 0.0, a, FIRST_ROW, forces), add_product(ws, 0.0, a, SECOND_ROW, forces)


@kernel("b1(ws, ActiveContact, i8)")
def _write_force(ws: Workspace, active: ActiveContact, y: int) -> bool:
    """Write rates and force of an active contact at the impact state ``y``. True if a part of its force is unknown.

    The friction of a contact that sticks and the normal force of a held one are unknown. An idle contact has no force,
    and its rates are not written: only its guard needs them.
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
    """Find the unknown forces [N]: held contacts keep their gap rates under them, and sticking ones their slips."""
    # only contact forces change rates in an impact, so b of the equations b + G f = 0 is zero
    clear(ws.floats, ws.problem.free_accelerations.start, 3 * len(ws.actives))
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
    """Write d(P, x, W, D, E, L)/ds of all active contacts at the impact state ``y`` to ``out``.

    Writes their rates and forces, too.
    """
    has_unknown = False
    for active in ws.actives:
        has_unknown = _write_force(ws, active, y) or has_unknown
        _write_slope(ws, active, out)
    # unknown forces depend on the forces of all contacts: once they are found, the slopes are written again
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
    """Write the slope of an active contact in pseudo-time, Eqs. (19) to (28), to ``out``.

    Its rate and force are evaluated.
    """
    slope, rate, (v1, v2) = state_at(ws, out, active), active.gap_rate, active.slip
    force, (t1, t2) = active.normal_force, active.friction
    deforming = 0.0
    if active.phase == Phase.COMPRESSION:
        deforming = -rate
    elif active.phase == Phase.EXPANSION:
        deforming = -rate / expansion_efficiency(ws, active, rate)
    slope.normal_force, slope.friction = force, (t1, t2)
    # the energy of a lone contact replaces its deformation
    slope.deformation = 0.0 if is_lone(ws, active) else deforming
    slope.work = slope.dissipated = 0.0
    if active.phase != Phase.IDLE:
        # the rates of an idle contact may be those of a rejected step, and not finite
        slope.work = force * rate
        slope.dissipated = -(t1 * v1 + t2 * v2)
    slope.energy = force * deforming
    # the energy that an expansion will not return is known where it begins, and constant
    slope.lost = 0.0
