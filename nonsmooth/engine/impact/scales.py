"""Scales of an impact: what counts as large and as small among its speeds, impulses, deformations and energies.

Guards, errors and thresholds are made relative to these scales, so that no unit and no stiffness enters them. A contact
takes up no more energy than the fastest approach would bring to it, and no more than the approaches of all contacts
bring. Without the first bound a heavy body would set the scale of its light neighbours; without the second, a contact
with a small effective inverse mass would set one that nothing reaches, and its errors would count as small.

The deformation of a contact that takes up its energy E follows from E = F(x) x, by a secant in the logarithms: force
laws are close to powers of x.
"""

from __future__ import annotations

import math

from nonsmooth.engine.delassus.delassus import diagonal_block
from nonsmooth.engine.impact.state import is_lone, state_of
from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, at, call_scalar, kernel

REST = 1e-9
"""Slip that counts as rest, relative to the largest speed of the impact. Slips within the error count as rest, too."""
CIRCLING = 30.0
"""Slip that counts as rest, relative to the error of a step. A slip that oscillates about zero by errors is smaller."""
_GROWTH = 2.0
"""Growth of an impulse scale [1] below which it stays as it is. A threshold need not change in every step."""
_CLOSE = 1e-6
"""Accuracy of the deformation scale, relative to the energy. A scale needs no more."""
_ITERATIONS = 4
"""Maximum number of steps of the secant. It is exact after one for a power law."""
_LEAST_RISE = 0.5001
"""Least ratio of the force at double deformation to the force. A law that falls faster has no deformation scale."""
_NO_SCALE = -1.0
"""Deformation scale of a force law that has none."""


@kernel("f8(ws, f8)")
def scale_impact(ws: Workspace, seed: float) -> float:
    """Set the scales of the active contacts, to which guards and errors of the impact are relative.

    Returns the duration of the shortest compression, in pseudo-time. It is negative if a force law has no scale. No
    speed is taken smaller than the ``seed`` [m/s], as an impact without collision has none. A contact takes up no more
    energy than the fastest approach would bring to it, and no more than any approach brings.
    """
    brought = _scale_speeds(ws, seed)
    shortest = math.inf
    for active in ws.actives:
        inverse_mass = diagonal_block(ws, active.index).nn
        energy = min(brought, ws.impact.speed_scale * ws.impact.speed_scale / inverse_mass)
        active.energy_scale = energy
        active.impulse_scale = math.sqrt(energy / inverse_mass)
        # the impulse of a lone contact is the variable of integration: its deformation is not needed
        deformation = 1.0 if is_lone(ws, active) else _deformation_scale(ws, active)
        if deformation < 0.0:
            return deformation
        active.deformation_scale = deformation
        active.force_scale = energy / deformation
        # pseudo-time is deformation over speed; that of a lone contact is its impulse, energy over speed
        shortest = min(shortest, (energy if is_lone(ws, active) else deformation) / ws.impact.speed_scale)
    _set_rest_slips(ws)
    return shortest


@kernel("f8(ws, f8)")
def _scale_speeds(ws: Workspace, seed: float) -> float:
    """Set the largest speed of the impact and the slip that counts as rest. Returns the largest energy [J].

    No speed is taken smaller than the ``seed`` [m/s]. An approach g' of effective inverse mass G_nn brings the energy
    g'^2 / G_nn, twice its kinetic energy.
    """
    ws.impact.speed_scale = seed
    brought = 0.0
    for active in ws.actives:
        speed = max(seed, -active.gap_rate_before)
        ws.impact.speed_scale = max(ws.impact.speed_scale, speed)
        if speed > 0.0:
            brought = max(brought, speed * speed / diagonal_block(ws, active.index).nn)
    ws.impact.rest_speed = max(REST, CIRCLING * ws.tolerance.impact) * ws.impact.speed_scale
    return brought


@kernel("f8(ws, ActiveContact)")
def _deformation_scale(ws: Workspace, active: ActiveContact) -> float:
    """Deformation x of an active contact with F(x) x = its energy scale [m], or ``_NO_SCALE`` if there is none.

    By a secant in the logarithms, because force laws are close to powers of x. It starts from 1 m. The last iterate is
    taken even if it is not accurate: it is a scale only.
    """
    contact, energy, x = ws.contacts[active.contact], active.energy_scale, 1.0
    parameters = at(ws.floats, contact.impact_force_parameters)
    for _ in range(_ITERATIONS):
        force = call_scalar(contact.impact_force_function, x, parameters)
        double = call_scalar(contact.impact_force_function, 2.0 * x, parameters)
        if not (force > 0.0 and double > _LEAST_RISE * force):
            return _NO_SCALE
        if abs(energy - force * x) <= _CLOSE * energy:
            break
        # log(2 double / force) / log(2) is the power with which F(x) x grows
        x *= (energy / (force * x)) ** (math.log(2.0) / math.log(2.0 * double / force))
    return x


@kernel("f8(ws, ActiveContact)")
def reached_energy(ws: Workspace, active: ActiveContact) -> float:
    """Energy to which errors of an active contact are relative [J]: its scale, or the largest of its energies."""
    # if friction blocks a light point, or slip presses bodies together, these far exceed what its approach brings
    state = state_of(ws, active)
    return float(max(active.energy_scale, abs(state.work), state.dissipated, state.energy))


@kernel()
def raise_impulse_scales(ws: Workspace) -> None:
    """Raise the scales of impulse to the energies that were reached, and with them the slips that count as rest.

    Errors grow with the energies. A scale is raised by at least the factor ``_GROWTH``, as each change costs work. The
    other scales stay.
    """
    has_grown = False
    for active in ws.actives:
        # an impulse P stands for the energy G_nn P^2, as in `scale_impact`
        energy, inverse_mass = reached_energy(ws, active), diagonal_block(ws, active.index).nn
        if energy > inverse_mass * (_GROWTH * active.impulse_scale) ** 2:
            active.impulse_scale = math.sqrt(energy / inverse_mass)
            has_grown = True
    if has_grown:
        _set_rest_slips(ws)


@kernel()
def _set_rest_slips(ws: Workspace) -> None:
    """Write the slip of every active contact that counts as rest [m/s]: one of little energy, or within the error."""
    for active in ws.actives:
        own = diagonal_block(ws, active.index)
        # largest slip that the impulse scale of a contact in the same island causes
        moved = 0.0
        for block in range(active.first_block, active.end_block):
            impulse = ws.actives[ws.island.block_column[block]].impulse_scale
            # the rows of the two tangents
            for i in range(3, DELASSUS):
                moved = max(moved, abs(ws.island.delassus[DELASSUS * block + i]) * impulse)
        inverse_mass, small = max(own.t11, own.t22), float(ws.impact.rest_speed)
        # a slip with a large effective mass has more energy
        if inverse_mass < own.nn:
            small *= math.sqrt(inverse_mass / own.nn)
        active.rest_slip = max(small, CIRCLING * ws.tolerance.impact * moved)
