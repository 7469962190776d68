"""The Delassus matrix G = [W N]^T K [W N] of the active contacts, and the response of the bodies to contact forces.

G maps the contact forces to the accelerations of the contacts, or impulses to velocities [1/kg]. W and N are the
generalised directions of the normal and the tangents. K is the inverse mass matrix M^-1, less what the joints take of
it. Each contact has three rows and three columns, n, t1 and t2.

Only the blocks of contacts that share a movable articulation are stored (:mod:`nonsmooth.engine.delassus.blocks`). The
full matrix would grow with the square of the number of contacts.
"""

from __future__ import annotations

from typing import Any

from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.memory.layout import FIRST_ROW, SECOND_ROW
from nonsmooth.engine.native.kernel import ActiveContact, ContactRecord, Workspace, delassus_block, entry_point, kernel
from nonsmooth.engine.numerics.arrays import clear
from nonsmooth.engine.numerics.linear import product
from nonsmooth.engine.numerics.vectors import Pair


@entry_point()
def assemble_delassus(ws: Workspace) -> None:
    """Write the blocks of the Delassus matrix G of the active contacts: accelerations per unit of contact force [1/kg].

    Before: their Jacobians, and the responses of the bodies to unit forces, are written, and the list of the blocks
    that are not zero.
    """
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        for block in range(active.first_block, active.end_block):
            other = ws.contacts[ws.problem.active[ws.island.block_column[block]]]
            _write_block(ws, contact, other, ws.island.delassus.start + DELASSUS * block)


@kernel("void(ws, ContactRecord, ContactRecord, i8)")
def _write_block(ws: Workspace, contact: ContactRecord, other: ContactRecord, out: int) -> None:
    """Write a block of the Delassus matrix at ``out``: accelerations of ``contact`` per unit force of ``other`` [1/kg].

    Rows and columns are n, t1, t2.
    """
    clear(ws.floats, out, DELASSUS)
    for side in range(2):
        articulation = contact.articulation_a if side == 0 else contact.articulation_b
        jacobian = contact.jacobian_a if side == 0 else contact.jacobian_b
        n_u = ws.articulations[articulation].n_u
        # the other force acts through each movable articulation that both contacts share
        if n_u > 0 and other.articulation_a == articulation:
            _add_products(ws, jacobian, other.response_a, n_u, out)
        if n_u > 0 and other.articulation_b == articulation:
            _add_products(ws, jacobian, other.response_b, n_u, out)


@kernel("void(ws, i8, i8, i8, i8)")
def _add_products(ws: Workspace, jacobian: int, response: int, n_u: int, out: int) -> None:
    """Add the products of three Jacobian rows and three responses, of ``n_u`` numbers each, to the block at ``out``.

    ``jacobian`` and ``response`` are the offsets of the first of each. The block is stored row by row.
    """
    for r in range(3):
        for s in range(3):
            ws.floats[out + 3 * r + s] += product(ws.floats, 0.0, jacobian + r * n_u, response + s * n_u, n_u)


@kernel("delassus_block(ws, i8)")
def diagonal_block(ws: Workspace, a: int) -> Any:
    """Diagonal block of G of active contact ``a`` [1/kg]. Its nine entries have names, such as ``nn`` and ``t11``."""
    return delassus_block(ws.floats, ws.island.delassus.start, ws.actives[a].diagonal_block)


@kernel("f8(ws, f8, i8, i8, i8)")
def add_product(ws: Workspace, total: float, a: int, r: int, x: int) -> float:
    """``total`` plus a row of the Delassus matrix G, times the vector at ``x`` of three numbers per active contact.

    The row is ``r`` (n, t1, t2) of active contact ``a``. Only its blocks that are not zero are stored. With forces at
    ``x`` the product is an acceleration [m/s^2], with impulses a velocity [m/s].
    """
    active = ws.actives[a]
    for block in range(active.first_block, active.end_block):
        g = ws.island.delassus.start + DELASSUS * block + 3 * r
        other = x + 3 * ws.island.block_column[block]
        for s in range(3):
            total += ws.floats[g + s] * ws.floats[other + s]
    return total


@kernel("f8(ws, ActiveContact, i8)")
def acceleration(ws: Workspace, active: ActiveContact, r: int) -> float:
    """Row ``r`` (n, t1, t2) of a contact of b + G f: its acceleration under the present contact forces f [m/s^2]."""
    # b: without contact forces. In problems of impulses it is a velocity, and so is the result [m/s].
    return add_product(ws, active.free[r], active.index, r, ws.problem.forces.start)


@kernel("v2(ws, ActiveContact)")
def slip_acceleration(ws: Workspace, active: ActiveContact) -> Pair:
    """Tangential :func:`acceleration` of a contact, along t1 and t2, under the present contact forces [m/s^2]."""
    return acceleration(ws, active, FIRST_ROW), acceleration(ws, active, SECOND_ROW)


@kernel()
def write_dense(ws: Workspace) -> None:
    """Write the Delassus matrix G in full to ``matrix``, row by row [1/kg], for methods that need a full matrix.

    Blocks that are not stored belong to contacts that do not act on each other. They become zeros.
    """
    width = 3 * ws.problem.n_active
    clear(ws.floats, ws.problem.matrix.start, width * width)
    for active in ws.actives:
        for block in range(active.first_block, active.end_block):
            for r in range(3):
                first = (3 * active.index + r) * width + 3 * ws.island.block_column[block]
                for s in range(3):
                    ws.problem.matrix[first + s] = ws.island.delassus[DELASSUS * block + 3 * r + s]


@kernel("void(ws, i8, i8)")
def add_response(ws: Workspace, f: int, du: int) -> None:
    """Add the accelerations of the bodies under the contact forces at ``f`` to ``du``: K (W f_n + N f_t).

    K is the inverse mass matrix, W and N are the directions of normals and tangents. ``f`` is the offset of three
    numbers (n, t1, t2) per active contact, ``du`` that of the accelerations of all bodies. With impulses at ``f``,
    these are changes of the velocities.
    """
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        for side in range(2):
            articulation = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b]
            response = contact.response_a if side == 0 else contact.response_b
            n_u, start = articulation.n_u, du + articulation.u
            for r in range(3):
                force = ws.floats[f + 3 * active.index + r]
                for j in range(n_u):
                    ws.floats[start + j] += ws.floats[response + r * n_u + j] * force
