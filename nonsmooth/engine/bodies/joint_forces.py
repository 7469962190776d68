"""Forces of joints: the multipliers mu of the rows of an articulation, for the forces F that act at a state.

From A u' + b = 0 and M u' = F + A^T mu follows mu = -(A M^-1 A^T)^-1 (A M^-1 F + b). They are not needed for the
motion, which uses K (:mod:`nonsmooth.engine.bodies.articulations`). So they are evaluated for the output only.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.articulations import solve_factorised
from nonsmooth.engine.bodies.compliance import write_wrench
from nonsmooth.engine.bodies.equations import force_without_contacts
from nonsmooth.engine.memory.layout import FIRST_ROW
from nonsmooth.engine.native.kernel import Articulation, Workspace, kernel
from nonsmooth.engine.numerics.linear import product


@kernel("void(ws, i8)")
def _add_contact_forces(ws: Workspace, forces: int) -> None:
    """Add the forces of the closed contacts to the generalised forces of all bodies at offset ``forces``.

    ``FIRST_ROW`` of the Jacobians of the contacts and ``NORMAL_ROW`` of their responses are overwritten.
    """
    for i in range(ws.island.n_grouped):
        c = ws.island.grouped[i]
        contact = ws.contacts[c]
        write_wrench(ws, c, contact.force)
        for side in range(2):
            articulation = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b]
            # write_wrench has put the generalised forces there
            row = (contact.jacobian_a if side == 0 else contact.jacobian_b) + FIRST_ROW * articulation.n_u
            for j in range(articulation.n_u):
                ws.floats[forces + articulation.u + j] += ws.floats[row + j]


@kernel("void(ws, Articulation, i8)")
def _solve_rows(ws: Workspace, articulation: Articulation, forces: int) -> None:
    """Write the multipliers mu of the joint rows of an articulation [N or N m], from the generalised forces F.

    mu = -(A M^-1 A^T)^-1 (A M^-1 F + b), with the Jacobian A and the biases b of the rows. F of all bodies is at offset
    ``forces``. The factor of the matrix and A M^-1, the response, must be evaluated.
    """
    n, m = articulation.n_u, articulation.n_rows
    # the right-hand side of each row; the solution replaces it
    for line in range(m):
        row, bias = articulation.response + line * n, ws.floats[articulation.bias + line]
        ws.floats[articulation.forces + line] = -product(ws.floats, bias, row, forces + articulation.u, n)
    solve_factorised(ws.floats, articulation.factor, m, articulation.forces, stride=1)


@kernel()
def evaluate_joint_forces(ws: Workspace) -> None:
    """Write the force of every row of the joints [N or N m], for the output. The contact forces must be evaluated.

    A row that others imply gets no force. ``FIRST_ROW`` of the Jacobians of the contacts and ``NORMAL_ROW`` of their
    responses are overwritten.
    """
    # no step is in progress, so its work array y_stage can hold the generalised forces of all bodies
    forces = ws.step.y_stage.start
    for body in ws.bodies:
        without_contacts = force_without_contacts(ws, body)
        for i in range(body.n_u):
            ws.floats[forces + body.u + i] = without_contacts[i]
    _add_contact_forces(ws, forces)
    for articulation in ws.articulations:
        if articulation.n_rows > 0:
            _solve_rows(ws, articulation, forces)
