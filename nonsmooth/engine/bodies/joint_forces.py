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
    for i in range(ws.island.n_grouped):
        c = ws.island.grouped[i]
        contact = ws.contacts[c]
        write_wrench(ws, c, contact.force)
        for side in range(2):
            articulation = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b]
            row = (contact.jacobian_a if side == 0 else contact.jacobian_b) + articulation.n_u
            for j in range(articulation.n_u):
                ws.floats[forces + articulation.u + j] += ws.floats[row + j]


@kernel("void(ws, i8, i8)")
def _solve_rows(ws: Workspace, number: int, forces: int) -> None:
    """Write the multipliers of an articulation's rows to its ``x``: -(A M^-1 A^T)^-1 (A M^-1 F + bias)."""
    articulation = ws.articulations[number]
    n, m, own = articulation.n_u, articulation.n_rows, forces + articulation.u
    for line in range(m):
        total = ws.floats[articulation.bias + line]
        for i in range(n):
            total += ws.floats[articulation.response + line * n + i] * ws.floats[own + i]
        ws.floats[articulation.forces + line] = -total
    substitute(ws.floats, articulation.factor, m, articulation.forces, 1)


@kernel()
def evaluate_joint_forces(ws: Workspace) -> None:
    """Write the force along every row of the joints to the ``x`` of its articulation, contact forces being known.

    A row that others imply bears none.
    """
    forces = ws.step.y_stage.start
    for number in range(ws.model.n_bodies):
        body = ws.bodies[number]
        h = body.tail + body.n_q
        for i in range(body.n_u):
            ws.floats[forces + body.u + i] = ws.floats[h + i]
    _add_contacts(ws, forces)
    for number in range(ws.model.n_articulations):
        if ws.articulations[number].n_rows > 0:
            _solve_rows(ws, number, forces)
