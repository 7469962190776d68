"""The unknowns of the contact problem: components of contact forces, and turns of slip directions.

The matrices of the problem have one row per unknown. A list tells which contact and which component a row belongs to,
because contacts that stick, slide or have a given normal force have different numbers of unknowns.
"""

from __future__ import annotations

from nonsmooth.engine.memory.layout import NORMAL_ROW
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, kernel


@kernel("b1(ActiveContact)")
def starts_to_slide(active: ActiveContact) -> bool:
    """True if a contact at rest slides in the mode under trial."""
    return active.is_at_rest and active.mode_tried == Mode.SLIDE


@kernel("i8(ws, b1)")
def list_unknowns(ws: Workspace, with_turns: bool) -> int:
    """List the unknown forces of the active contacts: the rows of the linear system. Returns the number of unknowns.

    Unknown are the normal force if ``is_normal_force_unknown``, and the two components of friction if the contact
    ``sticks``. If ``with_turns``, the turn of the direction of each slip that begins is an unknown, too.
    """
    n = 0
    for active in ws.actives:
        active.first_unknown = n
        for r in range(3):
            if active.is_normal_force_unknown if r == NORMAL_ROW else active.sticks:
                unknown = ws.unknowns[n]
                unknown.contact, unknown.direction, unknown.is_turn = active.index, r, False
                n += 1
        if with_turns and starts_to_slide(active):
            unknown = ws.unknowns[n]
            # a turn is no component of a force: its direction is not read
            unknown.contact, unknown.direction, unknown.is_turn = active.index, NORMAL_ROW, True
            n += 1
    # one more entry: the end of the last contact's unknowns
    ws.problem.first_unknown[ws.problem.n_active] = n
    return n


@kernel("void(ws, i8)")
def count_as_unique(ws: Workspace, n: int) -> None:
    """Set the number of unknowns to ``n``, and count all forces as unique, unless a singular matrix shows otherwise."""
    ws.problem.n_unknown, ws.problem.is_deficient, ws.problem.is_null_space_banded = n, False, False
    for active in ws.actives:
        active.has_redundant_force = False


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
