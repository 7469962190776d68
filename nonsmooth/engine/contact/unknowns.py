"""The unknowns of the contact problem: components of forces, and the turns of directions."""

from __future__ import annotations

from nonsmooth.engine.native.kernel import Workspace, kernel


@kernel("void(ws, i8, i8, i8)")
def list_force(ws: Workspace, i: int, a: int, r: int) -> None:
    """Let unknown ``i`` be the force of the active contact ``a`` along direction ``r``."""
    unknown = ws.unknowns[i]
    unknown.contact, unknown.direction, unknown.is_turn = a, r, False


@kernel("void(ws, i8, i8)")
def list_turn(ws: Workspace, i: int, a: int) -> None:
    """Let unknown ``i`` be the turn of the slip direction of the active contact ``a``."""
    unknown = ws.unknowns[i]
    unknown.contact, unknown.direction, unknown.is_turn = a, 0, True


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
