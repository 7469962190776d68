"""The Delassus matrix of the active contacts and what their forces do to the velocities.

It is stored by blocks, of contacts that share a movable articulation only (:mod:`nonsmooth.engine.delassus.blocks`).
"""

from __future__ import annotations

from typing import Any

from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.native.kernel import (
    Floats,
    Integers,
    Scalars,
    active_at,
    articulation_at,
    contact_at,
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
def assemble_delassus(S: Scalars, w: Floats, k: Integers) -> None:
    """Write the blocks of G = [W N]^T K [W N] of the active contacts, rows and columns (n, t1, t2) each."""
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        contact = contact_at(S, w, k, active.slot)
        for block in range(active.first_block, active.end_block):
            pushing = contact_at(S, w, k, k[S.active + k[S.block_column + block]])
            out = S.delassus + DELASSUS * block
            for i in range(DELASSUS):
                w[out + i] = 0.0
            for side in range(2):
                articulation = contact.articulation_a if side == 0 else contact.articulation_b
                jacobian = contact.jacobian_a if side == 0 else contact.jacobian_b
                n_u = articulation_at(S, w, k, articulation).nu
                if n_u > 0 and pushing.articulation_a == articulation:
                    _add_block(w, jacobian, pushing.response_a, n_u, out)
                if n_u > 0 and pushing.articulation_b == articulation:
                    _add_block(w, jacobian, pushing.response_b, n_u, out)


@kernel("D(S, F, I, i8)")
def diagonal_block(S: Scalars, w: Floats, k: Integers, a: int) -> Any:
    """Return the block of the active contact ``a`` on the diagonal."""
    return delassus_block(w, S.delassus, active_at(S, w, k, a).diagonal_block)


@kernel("f8(S, F, I, f8, i8, i8, i8)")
def add_product(S: Scalars, w: Floats, k: Integers, total: float, a: int, r: int, x: int) -> float:
    """Return ``total`` plus row ``r`` (n, t1, t2) of the active contact ``a`` of G times the vector at ``x``."""
    active = active_at(S, w, k, a)
    for block in range(active.first_block, active.end_block):
        g = S.delassus + DELASSUS * block + 3 * r
        other = x + 3 * k[S.block_column + block]
        for s in range(3):
            total += w[g + s] * w[other + s]
    return total


@kernel()
def write_dense(S: Scalars, w: Floats, k: Integers) -> None:
    """Write all of G, row by row, to ``matrix``."""
    width = 3 * S.n_active
    for i in range(width * width):
        w[S.matrix + i] = 0.0
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        for block in range(active.first_block, active.end_block):
            for r in range(3):
                for s in range(3):
                    line = S.matrix + (3 * a + r) * width + 3 * k[S.block_column + block]
                    w[line + s] = w[S.delassus + DELASSUS * block + 3 * r + s]


@kernel("void(S, F, I, i8, i8)")
def add_response(S: Scalars, w: Floats, k: Integers, f: int, du: int) -> None:
    """Add K (W f_N + N f_T) of the active contacts' forces or impulses at ``active_forces`` to ``du``."""
    for i in range(S.n_active):
        contact = contact_at(S, w, k, k[S.active + i])
        for side in range(2):
            articulation = articulation_at(S, w, k, contact.articulation_a if side == 0 else contact.articulation_b)
            response = contact.response_a if side == 0 else contact.response_b
            n_u, start = articulation.nu, du + articulation.u
            for r in range(3):
                force = w[f + 3 * i + r]
                for j in range(n_u):
                    w[start + j] += w[response + r * n_u + j] * force
