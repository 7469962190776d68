"""What joints bear: the multipliers of their rows, for the forces that act at a state."""

from __future__ import annotations

from nonsmooth.engine.bodies.compliance import lay_wrench
from nonsmooth.engine.bodies.linkages import substitute
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, kernel


@kernel("void(S, F, I, i8)")
def _add_contacts(S: Scalars, w: Floats, k: Integers, forces: int) -> None:
    """Add what the grouped contacts do to generalised forces."""
    for i in range(S.n_grouped):
        c = k[S.grouped + i]
        lay_wrench(S, w, k, c, S.force + 3 * c)
        for side in range(2):
            linkage = k[S.linkage_a + c] if side == 0 else k[S.linkage_b + c]
            n_u = k[S.linkage_nu + linkage]
            row = (k[S.jacobian_a + c] if side == 0 else k[S.jacobian_b + c]) + n_u
            for j in range(n_u):
                w[forces + k[S.linkage_u + linkage] + j] += w[row + j]


@kernel("void(S, F, I, i8, i8)")
def _solve_rows(S: Scalars, w: Floats, k: Integers, linkage: int, forces: int) -> None:
    """Write the multipliers of a linkage's rows to its ``x``: -(A M^-1 A^T)^-1 (A M^-1 F + bias)."""
    n, m = k[S.linkage_nu + linkage], k[S.linkage_rows + linkage]
    x, own = k[S.linkage_x + linkage], forces + k[S.linkage_u + linkage]
    for line in range(m):
        total = w[k[S.linkage_bias + linkage] + line]
        for i in range(n):
            total += w[k[S.linkage_r + linkage] + line * n + i] * w[own + i]
        w[x + line] = -total
    substitute(w, k[S.linkage_factor + linkage], m, x, 1)


@kernel()
def evaluate_joint_forces(S: Scalars, w: Floats, k: Integers) -> None:
    """Write the force along every row of the joints to the ``x`` of its linkage, contact forces being known.

    A row that others imply bears none.
    """
    forces = S.y_stage
    for body in range(S.n_bodies):
        h = k[S.body_tail + body] + k[S.body_nq + body]
        for i in range(k[S.body_nu + body]):
            w[forces + k[S.body_u + body] + i] = w[h + i]
    _add_contacts(S, w, k, forces)
    for linkage in range(S.n_linkages):
        if k[S.linkage_rows + linkage] > 0:
            _solve_rows(S, w, k, linkage, forces)
