"""Forces of joints: the multipliers mu of the rows of an articulation, for the forces F that act at a state.

From A u' + b = 0 and M u' = F + A^T mu follows mu = -(A M^-1 A^T)^-1 (A M^-1 F + b). They are not needed for the
motion, which uses K (:mod:`nonsmooth.engine.bodies.articulations`). So they are evaluated for the output only.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.articulations import solve_factorised
from nonsmooth.engine.bodies.compliance import write_wrench
from nonsmooth.engine.native.kernel import Articulation, Workspace, kernel


@kernel("void(ws, i8)")
def _add_contact_forces(ws: Workspace, forces: int) -> None:
    """Add the forces of the closed contacts to the generalised forces at ``forces``."""
    for i in range(ws.island.n_grouped):
        c = ws.island.grouped[i]
        contact = ws.contacts[c]
        write_wrench(ws, c, contact.force)
        for side in range(2):
            articulation = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b]
            row = (contact.jacobian_a if side == 0 else contact.jacobian_b) + articulation.n_u
            for j in range(articulation.n_u):
                ws.floats[forces + articulation.u + j] += ws.floats[row + j]


@kernel("void(ws, Articulation, i8)")
def _solve_rows(ws: Workspace, articulation: Articulation, forces: int) -> None:
    """Write the multipliers of an articulation's rows [N], from the generalised forces at ``forces``."""
    n, m, own = articulation.n_u, articulation.n_rows, forces + articulation.u
    for line in range(m):
        total = ws.floats[articulation.bias + line]
        for i in range(n):
            total += ws.floats[articulation.response + line * n + i] * ws.floats[own + i]
        ws.floats[articulation.forces + line] = -total
    solve_factorised(ws.floats, articulation.factor, m, articulation.forces, 1)


@kernel()
def evaluate_joint_forces(ws: Workspace) -> None:
    """Write the force along every row of the joints [N], after the contact forces were evaluated.

    A row that others imply has no force.
    """
    forces = ws.step.y_stage.start
    for body in ws.bodies:
        own = body.tail + body.n_q
        for i in range(body.n_u):
            ws.floats[forces + body.u + i] = ws.floats[own + i]
    _add_contact_forces(ws, forces)
    for articulation in ws.articulations:
        if articulation.n_rows > 0:
            _solve_rows(ws, articulation, forces)
