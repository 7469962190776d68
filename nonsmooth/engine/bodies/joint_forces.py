"""What joints bear: the multipliers of their rows, for the forces that act at a state."""

from __future__ import annotations

from nonsmooth.engine.bodies.articulations import substitute
from nonsmooth.engine.bodies.compliance import write_wrench
from nonsmooth.engine.native.kernel import (
    Workspace,
    kernel,
)


@kernel("void(ws, i8)")
def _add_contacts(ws: Workspace, forces: int) -> None:
    """Add what the grouped contacts do to generalised forces."""
    for i in range(ws.n_grouped):
        c = ws.grouped[i]
        contact = ws.contacts[c]
        write_wrench(ws, c, contact.force)
        for side in range(2):
            articulation = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b]
            row = (contact.jacobian_a if side == 0 else contact.jacobian_b) + articulation.nu
            for j in range(articulation.nu):
                ws.floats[forces + articulation.u + j] += ws.floats[row + j]


@kernel("void(ws, i8, i8)")
def _solve_rows(ws: Workspace, number: int, forces: int) -> None:
    """Write the multipliers of an articulation's rows to its ``x``: -(A M^-1 A^T)^-1 (A M^-1 F + bias)."""
    articulation = ws.articulations[number]
    n, m, own = articulation.nu, articulation.rows, forces + articulation.u
    for line in range(m):
        total = ws.floats[articulation.bias + line]
        for i in range(n):
            total += ws.floats[articulation.r + line * n + i] * ws.floats[own + i]
        ws.floats[articulation.x + line] = -total
    substitute(ws.floats, articulation.factor, m, articulation.x, 1)


@kernel()
def evaluate_joint_forces(ws: Workspace) -> None:
    """Write the force along every row of the joints to the ``x`` of its articulation, contact forces being known.

    A row that others imply bears none.
    """
    forces = ws.offsets.y_stage
    for number in range(ws.n_bodies):
        body = ws.bodies[number]
        h = body.tail + body.nq
        for i in range(body.nu):
            ws.floats[forces + body.u + i] = ws.floats[h + i]
    _add_contacts(ws, forces)
    for number in range(ws.n_articulations):
        if ws.articulations[number].rows > 0:
            _solve_rows(ws, number, forces)
