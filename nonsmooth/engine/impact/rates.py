"""Rates of the multiple impact in pseudo-time: forces, impulses, deformation, energies.

For every active contact the state holds (P_N, P_1, P_2, x, W, D, E, L): impulses, deformation, work of the
normal force, work rubbed away by friction, stored energy, and the part of it that is lost when the contact opens.
With F_i = f_i(x_i), Eqs. (23)-(28) divided by a common clock s read
dP_i/ds = (F_i, T_i),  dx_i/ds = -g'_i / efficiency(g'_i),  z = z_0 + G P.
A lone contact needs no deformation, only its energy: with F = 1 the clock is its impulse, and every phase is
a polynomial that the integrator follows exactly.
"""

from __future__ import annotations

from nonsmooth.engine.contact.forces import friction_of_slip, resolve
from nonsmooth.engine.contact.problem import follow_slip
from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.native.kernel import (
    Workspace,
    at,
    call_scalar,
    entry_point,
    impact_state,
    kernel,
)

IDLE, COMPRESSION, EXPANSION, HELD = 0, 1, 2, 3
"""Phase of a contact in an impact; HELD: closed without restitution, a unilateral constraint."""

DEFORMATION = 3
"""Where the deformation stands in the state of an impact, of every contact, behind the impulses."""
STRIDE = 8
"""Floats of one contact in that state."""

NOISE = 1e-12
"""Rates below this, relative to the impact speed, do not switch a phase."""


@kernel("f8(ws, i8, f8)")
def normal_force(ws: Workspace, a: int, x: float) -> float:
    """Return the force of the active contact ``a`` at the deformation ``x``, Eq. (20)."""
    active = ws.actives[a]
    if a == ws.impact.lone_contact:
        return 1.0
    if x <= 0.0:
        return 0.0
    contact = ws.contacts[active.contact]
    return call_scalar(contact.impact_force_function, x, at(ws.floats, contact.impact_force_parameters))


@kernel("f8(ws, i8, f8)")
def efficiency(ws: Workspace, a: int, rate: float) -> float:
    """Return the efficiency of the energy transfer of the active contact ``a``, Eq. (28)."""
    active = ws.actives[a]
    if active.is_lossless:
        return 1.0
    contact = ws.contacts[active.contact]
    return call_scalar(contact.efficiency_function, rate, at(ws.floats, contact.efficiency_parameters))


@kernel("void(ws, i8, i8)")
def write_rates(ws: Workspace, a: int, y: int) -> None:
    """Write z = z_0 + G P of the active contact ``a``, its gap rate and slip velocity, at the impact state ``y``."""
    active = ws.actives[a]
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
    """Write the rates of all active contacts at the impact state ``y``."""
    for a in range(ws.problem.n_active):
        write_rates(ws, a, y)


@kernel("i8(ws, i8, i8)")
def _act(ws: Workspace, a: int, y: int) -> int:
    """Write rates and force of the active contact ``a`` at the impact state ``y``; return 1 if it is held in part.

    An idle one has no force; its rates are for its guard alone, and written with that.
    """
    active = ws.actives[a]
    phase, loaded = active.phase, 0.0
    if phase == IDLE:
        active.is_normal_force_unknown, active.normal_force, active.friction = False, 0.0, (0.0, 0.0)
        return 0
    write_rates(ws, a, y)
    if phase == COMPRESSION or phase == EXPANSION:
        loaded = normal_force(ws, a, impact_state(ws.floats, y, a).deformation)
    active.normal_force = loaded
    active.is_normal_force_unknown = phase == HELD
    if active.sticks:
        return 1
    follow_slip(ws, a, active.slip, active.rest_slip)
    friction_of_slip(ws, a)
    return int(active.is_normal_force_unknown)


@kernel()
def _hold(ws: Workspace) -> None:
    """Complete the forces of what is held."""
    for i in range(3 * ws.problem.n_active):
        ws.problem.free_accelerations[i] = 0.0
    resolve(ws)


@entry_point("void(ws, i8)")
def evaluate_impact_forces(ws: Workspace, y: int) -> None:
    """Write the ``active_forces`` of the active contacts at the impact state ``y`` in the present phases."""
    held = 0
    for a in range(ws.problem.n_active):
        held += _act(ws, a, y)
    if held > 0:
        _hold(ws)


@entry_point("void(ws, i8, i8)")
def impact_slope(ws: Workspace, y: int, out: int) -> None:
    """Write d(P, x, W, D, E)/ds of all active contacts at the impact state ``y``."""
    held = 0
    for a in range(ws.problem.n_active):
        held += _act(ws, a, y)
        _write_slope(ws, a, out)
    if held > 0:
        _hold(ws)
        write_impact_slope(ws, out)


@kernel("void(ws, i8)")
def write_impact_slope(ws: Workspace, out: int) -> None:
    """Write the slope where rates and forces are evaluated."""
    for a in range(ws.problem.n_active):
        _write_slope(ws, a, out)


@kernel("void(ws, i8, i8)")
def _write_slope(ws: Workspace, a: int, out: int) -> None:
    """Write the slope of the active contact ``a``."""
    active, slope = ws.actives[a], impact_state(ws.floats, out, a)
    phase, rate, (v1, v2) = active.phase, active.gap_rate, active.slip
    force, (t1, t2) = active.normal_force, active.friction
    deforming = 0.0
    if phase == COMPRESSION:
        deforming = -rate
    elif phase == EXPANSION:
        deforming = -rate / efficiency(ws, a, max(rate, 1e-300))
    slope.normal_force, slope.friction = force, (t1, t2)
    slope.deformation = 0.0 if a == ws.impact.lone_contact else deforming
    slope.work = slope.rubbed = 0.0
    if phase != IDLE:
        # the rates of an idle contact may be those of a rejected step, and not finite
        slope.work = force * rate
        slope.rubbed = -(t1 * v1 + t2 * v2)
    slope.energy = force * deforming
    slope.lost = 0.0
