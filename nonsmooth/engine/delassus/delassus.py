"""The Delassus matrix of the active contacts and what their forces do to the velocities.

It is stored by blocks, of contacts that share a movable linkage only (:mod:`nonsmooth.engine.delassus.blocks`).
"""

from __future__ import annotations

from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, kernel, room


@kernel("void(F, i8, i8, i8, i8)")
def _add_block(w: Floats, jacobian: int, response: int, n_u: int, out: int) -> None:
    for r in range(3):
        for s in range(3):
            total = 0.0
            for i in range(n_u):
                total += w[jacobian + r * n_u + i] * w[response + s * n_u + i]
            w[out + 3 * r + s] += total


@room()
def assemble_delassus(S: Scalars, w: Floats, k: Integers) -> None:
    """Write the blocks of G = [W N]^T K [W N] of the active contacts, rows and columns (n, t1, t2) each."""
    for a in range(S.n_active):
        c = k[S.active + a]
        row = S.block_start + S.first_grouped + a
        for block in range(k[row], k[row + 1]):
            d = k[S.active + k[S.block_column + block]]
            out = S.delassus + 9 * block
            for i in range(9):
                w[out + i] = 0.0
            for side in range(2):
                linkage = k[S.linkage_a + c] if side == 0 else k[S.linkage_b + c]
                jacobian = k[S.jacobian_a + c] if side == 0 else k[S.jacobian_b + c]
                n_u = k[S.linkage_nu + linkage]
                if n_u > 0 and k[S.linkage_a + d] == linkage:
                    _add_block(w, jacobian, k[S.response_a + d], n_u, out)
                if n_u > 0 and k[S.linkage_b + d] == linkage:
                    _add_block(w, jacobian, k[S.response_b + d], n_u, out)


@kernel("i8(S, I, i8)")
def own_block(S: Scalars, k: Integers, a: int) -> int:
    """Return where the block of the active contact ``a`` on the diagonal stands."""
    return int(S.delassus + 9 * k[S.own_block + S.first_grouped + a])


@kernel("f8(S, F, I, f8, i8, i8, i8)")
def add_product(S: Scalars, w: Floats, k: Integers, total: float, a: int, r: int, x: int) -> float:
    """Return ``total`` plus row ``r`` (n, t1, t2) of the active contact ``a`` of G times the vector at ``x``."""
    row = S.block_start + S.first_grouped + a
    for block in range(k[row], k[row + 1]):
        g = S.delassus + 9 * block + 3 * r
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
        row = S.block_start + S.first_grouped + a
        for block in range(k[row], k[row + 1]):
            for r in range(3):
                for s in range(3):
                    line = S.matrix + (3 * a + r) * width + 3 * k[S.block_column + block]
                    w[line + s] = w[S.delassus + 9 * block + 3 * r + s]


@kernel("void(S, F, I, i8, i8)")
def add_response(S: Scalars, w: Floats, k: Integers, f: int, du: int) -> None:
    """Add K (W f_N + N f_T) of the active contacts' forces or impulses at ``f`` to ``du``."""
    for i in range(S.n_active):
        c = k[S.active + i]
        for side in range(2):
            linkage = k[S.linkage_a + c] if side == 0 else k[S.linkage_b + c]
            response = k[S.response_a + c] if side == 0 else k[S.response_b + c]
            n_u = k[S.linkage_nu + linkage]
            start = du + k[S.linkage_u + linkage]
            for r in range(3):
                force = w[f + 3 * i + r]
                for j in range(n_u):
                    w[start + j] += w[response + r * n_u + j] * force
