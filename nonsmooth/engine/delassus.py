"""The Delassus matrix of the active contacts and what their forces do to the velocities."""

from __future__ import annotations

from nonsmooth.engine.kernel import Floats, Integers, Scalars, kernel


@kernel("void(F, i8, i8, i8, i8, i8)")
def _add_block(w: Floats, jacobian: int, response: int, n_u: int, out: int, width: int) -> None:
    for r in range(3):
        for s in range(3):
            total = 0.0
            for i in range(n_u):
                total += w[jacobian + r * n_u + i] * w[response + s * n_u + i]
            w[out + r * width + s] += total


@kernel()
def assemble_delassus(S: Scalars, w: Floats, k: Integers) -> None:
    """Write G = [W N]^T K [W N] of the active contacts, rows (n, t1, t2) of each in turn."""
    m = S.n_active
    width = 3 * m
    for i in range(width * width):
        w[S.delassus + i] = 0.0
    for i in range(m):
        c = k[S.active + i]
        for j in range(m):
            d = k[S.active + j]
            block = S.delassus + 3 * i * width + 3 * j
            for side in range(2):
                linkage = k[S.linkage_a + c] if side == 0 else k[S.linkage_b + c]
                jacobian = k[S.jacobian_a + c] if side == 0 else k[S.jacobian_b + c]
                n_u = k[S.linkage_nu + linkage]
                if n_u > 0 and k[S.linkage_a + d] == linkage:
                    _add_block(w, jacobian, k[S.response_a + d], n_u, block, width)
                if n_u > 0 and k[S.linkage_b + d] == linkage:
                    _add_block(w, jacobian, k[S.response_b + d], n_u, block, width)


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
