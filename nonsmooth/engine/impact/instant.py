"""Impulses that need no integration: those of a law that maps velocities, and those that stop a jammed slip."""

from __future__ import annotations

from nonsmooth.engine.contact.forces import reduced_coefficient, resolve
from nonsmooth.engine.contact.problem import slip_coefficient
from nonsmooth.engine.delassus.delassus import add_product, diagonal_block, write_dense
from nonsmooth.engine.memory.blocks import GUARD, UNTOUCHED
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, at, call_map, kernel
from nonsmooth.engine.numerics.vectors import length, unit

_SINGULAR = 1e-3
"""Coefficient of the normal force with sliding friction that counts as singular, relative to the one without friction.
Steps that approach the singularity shrink without end, and stop short of it."""


# --- jams -------------------------------------------------------------------------------------------------------------


@kernel("b1(ws)")
def jam_slips(ws: Workspace) -> bool:
    """Stop the slips that are at the Painleve singularity, by impulses [N s]. True if there are any that press do that.

    In the limit of the singularity friction is at its bound and the gap stays closed, so the impulse is the one that
    brings slip and gap rate to rest together. The other contacts keep their modes. False if no slip jams, or if an
    impulse would have to pull: then the impulses are undefined.
    """
    has_jammed = False
    for active in ws.actives:
        has_jammed = _write_jam(ws, active) or has_jammed
    if not has_jammed:
        return False
    # the problem is posed with rates, so the forces that are found are impulses
    resolve(ws)
    for active in ws.actives:
        if not active.normal_force >= 0.0:
            return False
        for r in range(3):
            active.impulse[r] = active.force[r]
    _write_losses(ws)
    return True


@kernel("b1(ws, ActiveContact)")
def _write_jam(ws: Workspace, active: ActiveContact) -> bool:
    """Write the problem of an active contact that keeps its mode, or sticks if its slip jams. True if its slip jams.

    A slip jams if more normal force hardly accelerates the gap, because its friction presses the contact together.
    """
    contact = ws.contacts[active.contact]
    speed = length(contact.slip)
    # the problem is posed with rates in place of accelerations
    for r in range(3):
        active.free[r] = contact.rate[r]
    # friction of sliding; a contact that does not slip has none, or an unknown one if it sticks
    active.friction_coefficient = 0.0
    active.is_normal_force_unknown, active.sticks = True, contact.mode == Mode.STICK
    if contact.mode != Mode.SLIDE or contact.is_compliant or not speed > 0.0:
        return False
    active.friction_coefficient = slip_coefficient(ws, active.contact, speed)
    active.direction = unit(contact.slip)
    jams: bool = reduced_coefficient(ws, active.index) < _SINGULAR * diagonal_block(ws, active.index).nn
    if jams:
        active.sticks = True
    return jams


# --- maps of velocities -----------------------------------------------------------------------------------------------


@kernel()
def map_impact(ws: Workspace) -> None:
    """Let the user's law that maps velocities find the impulses of the active contacts [N s]. Writes their losses [J].

    The law gets the Delassus matrix, the rates before the impact and the parameters of the contacts. A law that writes
    past the end of the impulses is noted in ``run.n_past_map``, which is reported as its error.
    """
    n = len(ws.actives)
    for active in ws.actives:
        _write_parameters(ws, active)
    write_dense(ws)
    # numbers behind the impulses show whether the law writes past their end
    behind = ws.impact.impulse.start + 3 * n
    for i in range(GUARD):
        ws.floats[behind + i] = UNTOUCHED
    matrix, rates = at(ws.floats, ws.problem.matrix.start), at(ws.floats, ws.impact.rates_before.start)
    block, impulses = at(ws.floats, ws.impact.map_block.start), at(ws.floats, ws.impact.impulse.start)
    call_map(ws.options.impact_map, n, matrix, rates, block, impulses)
    for i in range(GUARD):
        if ws.floats[behind + i] != UNTOUCHED:
            # not zero: the law is at fault, with that number of contacts
            ws.run.n_past_map = n
    _write_losses(ws)


@kernel("void(ws, ActiveContact)")
def _write_parameters(ws: Workspace, active: ActiveContact) -> None:
    """Write the friction coefficient of an active contact for the law, then the parameters of the law.

    ``map_block`` has one row for each of these, with a column per contact.
    """
    contact, n = ws.contacts[active.contact], len(ws.actives)
    ws.impact.map_block[active.index] = slip_coefficient(ws, active.contact, length(contact.slip))
    for i in range(1, ws.model.map_width):
        ws.impact.map_block[i * n + active.index] = ws.floats[contact.map_parameters + i - 1]


@kernel()
def _write_losses(ws: Workspace) -> None:
    """Write the energies that the impulses take from the bodies, contact by contact [J].

    The work of an impulse is its product with the mean of the rates before and after it. That of the normal impulse is
    the loss to restitution, that of the friction impulse the loss to friction.
    """
    for active in ws.actives:
        normal = tangential = 0.0
        for r in range(3):
            impulse = active.impulse[r]
            # the impulses change the rates z by G P, so the mean is half of 2 z + G P
            mean = 0.5 * add_product(ws, 2.0 * active.rate_before[r], active.index, r, ws.impact.impulse.start)
            if r == 0:
                normal -= impulse * mean
            else:
                tangential -= impulse * mean
        # the loss to restitution is what is stored less what is returned
        active.energy_stored, active.energy_returned, active.energy_dissipated = normal, 0.0, tangential
