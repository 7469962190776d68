"""The unknowns of the contact problem: components of forces, and the turns of directions."""

from __future__ import annotations

from nonsmooth.engine.native.kernel import Workspace, kernel


@kernel("void(ws, i8, i8, i8, b1)")
def list_unknown(ws: Workspace, i: int, a: int, r: int, turn: bool) -> None:
    """Let unknown ``i`` be the force of the active contact ``a`` along direction ``r``, or its turn (1)."""
    unknown = ws.unknowns[i]
    unknown.contact, unknown.direction, unknown.is_turn = a, r, turn


@kernel("f8(ws, i8)")
def force_of(ws: Workspace, i: int) -> float:
    """Return the force that unknown ``i`` is."""
    unknown = ws.unknowns[i]
    return float(ws.actives[unknown.contact].force[unknown.direction])


@kernel("void(ws, i8, f8)")
def set_force(ws: Workspace, i: int, value: float) -> None:
    """Set the force that unknown ``i`` is."""
    unknown = ws.unknowns[i]
    ws.actives[unknown.contact].force[unknown.direction] = value
