"""The Delassus matrix of the active contacts and what their forces do to the velocities.

It is stored by blocks, of contacts that share a movable articulation only (:mod:`nonsmooth.engine.delassus.blocks`).
"""

from __future__ import annotations

from typing import Any

from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.native.kernel import (
    Floats,
    Workspace,
    delassus_block,
    entry_point,
    kernel,
)
from nonsmooth.engine.numerics.linear import product


@kernel("void(F, i8, i8, i8, i8)")
def _add_block(w: Floats, jacobian: int, response: int, n_u: int, out: int) -> None:
    for r in range(3):
        for s in range(3):
            w[out + 3 * r + s] += product(w, 0.0, jacobian + r * n_u, response + s * n_u, n_u)


@entry_point()
def assemble_delassus(ws: Workspace) -> None:
    """Write the blocks of G = [W N]^T K [W N] of the active contacts, rows and columns (n, t1, t2) each."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        contact = ws.contacts[active.contact]
        for block in range(active.first_block, active.end_block):
            pushing = ws.contacts[ws.problem.active[ws.island.block_column[block]]]
            out = ws.island.delassus.start + DELASSUS * block
            for i in range(DELASSUS):
                ws.floats[out + i] = 0.0
            for side in range(2):
                articulation = contact.articulation_a if side == 0 else contact.articulation_b
                jacobian = contact.jacobian_a if side == 0 else contact.jacobian_b
                n_u = ws.articulations[articulation].n_u
                if n_u > 0 and pushing.articulation_a == articulation:
                    _add_block(ws.floats, jacobian, pushing.response_a, n_u, out)
                if n_u > 0 and pushing.articulation_b == articulation:
                    _add_block(ws.floats, jacobian, pushing.response_b, n_u, out)


@kernel("delassus_block(ws, i8)")
def diagonal_block(ws: Workspace, a: int) -> Any:
    """Return the block of the active contact ``a`` on the diagonal."""
    return delassus_block(ws.floats, ws.island.delassus.start, ws.actives[a].diagonal_block)


@kernel("f8(ws, f8, i8, i8, i8)")
def add_product(ws: Workspace, total: float, a: int, r: int, x: int) -> float:
    """Return ``total`` plus row ``r`` (n, t1, t2) of the active contact ``a`` of G times the vector at ``x``."""
    active = ws.actives[a]
    for block in range(active.first_block, active.end_block):
        g = ws.island.delassus.start + DELASSUS * block + 3 * r
        other = x + 3 * ws.island.block_column[block]
        for s in range(3):
            total += ws.floats[g + s] * ws.floats[other + s]
    return total


@kernel()
def write_dense(ws: Workspace) -> None:
    """Write all of G, row by row, to ``matrix``."""
    width = 3 * ws.problem.n_active
    for i in range(width * width):
        ws.problem.matrix[i] = 0.0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        for block in range(active.first_block, active.end_block):
            for r in range(3):
                for s in range(3):
                    line = ws.problem.matrix.start + (3 * a + r) * width + 3 * ws.island.block_column[block]
                    ws.floats[line + s] = ws.island.delassus[DELASSUS * block + 3 * r + s]


@kernel("void(ws, i8, i8)")
def add_response(ws: Workspace, f: int, du: int) -> None:
    """Add K (W f_N + N f_T) of the active contacts' forces or impulses at ``active_forces`` to ``du``."""
    for i in range(ws.problem.n_active):
        contact = ws.contacts[ws.problem.active[i]]
        for side in range(2):
            articulation = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b]
            response = contact.response_a if side == 0 else contact.response_b
            n_u, start = articulation.n_u, du + articulation.u
            for r in range(3):
                force = ws.floats[f + 3 * i + r]
                for j in range(n_u):
                    ws.floats[start + j] += ws.floats[response + r * n_u + j] * force
