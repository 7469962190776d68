"""The unknowns of the contact problem: components of contact forces, and turns of slip directions.

The matrices of the problem have one row per unknown. A list tells which contact and which component a row belongs to,
because contacts that stick, slide or have a given normal force have different numbers of unknowns.
"""

from __future__ import annotations

from nonsmooth.engine.memory.layout import NORMAL_ROW
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, kernel


@kernel("void(ws, i8, ActiveContact, i8)")
def list_force(ws: Workspace, i: int, active: ActiveContact, r: int) -> None:
    """Let unknown ``i`` be the force of a contact along direction ``r`` (n, t1, t2)."""
    unknown = ws.unknowns[i]
    unknown.contact, unknown.direction, unknown.is_turn = active.index, r, False


@kernel("void(ws, i8, ActiveContact)")
def list_turn(ws: Workspace, i: int, active: ActiveContact) -> None:
    """Let unknown ``i`` be the turn of the slip direction of a contact."""
    unknown = ws.unknowns[i]
    unknown.contact, unknown.direction, unknown.is_turn = active.index, NORMAL_ROW, True


@kernel("f8(ws, i8)")
def force_of(ws: Workspace, i: int) -> float:
    """Component of a contact force that is unknown ``i`` [N]."""
    unknown = ws.unknowns[i]
    return float(ws.actives[unknown.contact].force[unknown.direction])


@kernel("void(ws, i8, f8)")
def set_force(ws: Workspace, i: int, value: float) -> None:
    """Set the component of a contact force that is unknown ``i`` [N]."""
    unknown = ws.unknowns[i]
    ws.actives[unknown.contact].force[unknown.direction] = value
