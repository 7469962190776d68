"""What joints bear: the multipliers of their rows, for the forces that act at a state."""

from __future__ import annotations

from nonsmooth.engine.bodies.articulations import substitute
from nonsmooth.engine.bodies.compliance import write_wrench
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, articulation_at, body_at, contact_at, kernel


@kernel("void(S, F, I, i8)")
def _add_contacts(S: Scalars, w: Floats, k: Integers, forces: int) -> None:
    """Add what the grouped contacts do to generalised forces."""
    for i in range(S.n_grouped):
        c = k[S.grouped + i]
        contact = contact_at(S, w, k, c)
        write_wrench(S, w, k, c, contact.force)
        for side in range(2):
            articulation = articulation_at(S, w, k, contact.articulation_a if side == 0 else contact.articulation_b)
            row = (contact.jacobian_a if side == 0 else contact.jacobian_b) + articulation.nu
            for j in range(articulation.nu):
                w[forces + articulation.u + j] += w[row + j]


@kernel("void(S, F, I, i8, i8)")
def _solve_rows(S: Scalars, w: Floats, k: Integers, number: int, forces: int) -> None:
    """Write the multipliers of an articulation's rows to its ``x``: -(A M^-1 A^T)^-1 (A M^-1 F + bias)."""
    articulation = articulation_at(S, w, k, number)
    n, m, own = articulation.nu, articulation.rows, forces + articulation.u
    for line in range(m):
        total = w[articulation.bias + line]
        for i in range(n):
            total += w[articulation.r + line * n + i] * w[own + i]
        w[articulation.x + line] = -total
    substitute(w, articulation.factor, m, articulation.x, 1)


@kernel()
def evaluate_joint_forces(S: Scalars, w: Floats, k: Integers) -> None:
    """Write the force along every row of the joints to the ``x`` of its articulation, contact forces being known.

    A row that others imply bears none.
    """
    forces = S.y_stage
    for number in range(S.n_bodies):
        body = body_at(S, w, k, number)
        h = body.tail + body.nq
        for i in range(body.nu):
            w[forces + body.u + i] = w[h + i]
    _add_contacts(S, w, k, forces)
    for number in range(S.n_articulations):
        if articulation_at(S, w, k, number).rows > 0:
            _solve_rows(S, w, k, number, forces)
