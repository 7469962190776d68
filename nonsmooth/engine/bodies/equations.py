"""The equations of motion by name, for the code of plug-in engines and of this one.

Of each body dq/dt = B(q) u and M u' = h + W lambda_N + N lambda_T. The blocks that bodies and contacts write hold the
matrices one behind another; an engine reads them by these names, and needs no place in a block. Evaluate the bodies
first (:func:`nonsmooth.engine.bodies.bodies.evaluate_bodies`), and contacts before their Jacobians
(:func:`nonsmooth.engine.bodies.kinematics.evaluate_contact`).
"""

from __future__ import annotations

from nonsmooth.engine.native.kernel import BodyRecord, ContactRecord, Floats, Workspace, at, kernel


@kernel("F(ws, BodyRecord)")
def coordinate_rates(ws: Workspace, body: BodyRecord) -> Floats:
    """View of dq/dt of a body, shape [n_q]: the first numbers behind its frames (``tail``)."""
    return at(ws.floats, body.tail)


@kernel("F(ws, BodyRecord)")
def force_without_contacts(ws: Workspace, body: BodyRecord) -> Floats:
    """View of the generalised forces of a body without contacts [N or N m], shape [n_u]: they follow dq/dt."""
    return at(ws.floats, body.tail + body.n_q)


@kernel("F(ws, BodyRecord)")
def inverse_mass(ws: Workspace, body: BodyRecord) -> Floats:
    """View of M^-1 of a body, row by row [1/kg or 1/(kg m^2)], shape [n_u * n_u]: it follows dq/dt and the forces."""
    return at(ws.floats, body.tail + body.n_q + body.n_u)


@kernel("F(ws, BodyRecord)")
def energies(ws: Workspace, body: BodyRecord) -> Floats:
    """View of kinetic and potential energy of a body [J], shape [2]: the last numbers of its output block."""
    return at(ws.floats, body.tail + body.n_q + body.n_u + body.n_u * body.n_u)


@kernel("F(ws, ContactRecord)")
def jacobian_of_first(ws: Workspace, contact: ContactRecord) -> Floats:
    """View of the Jacobian W^T, N^T of a contact for the first body and those tied to it by joints: rows n, t1, t2."""
    return at(ws.floats, contact.jacobian_a)


@kernel("F(ws, ContactRecord)")
def jacobian_of_second(ws: Workspace, contact: ContactRecord) -> Floats:
    """View of the Jacobian W^T, N^T of a contact for the second body and those tied to it by joints: rows n, t1, t2."""
    return at(ws.floats, contact.jacobian_b)


@kernel("F(ws, ContactRecord)")
def response_of_first(ws: Workspace, contact: ContactRecord) -> Floats:
    """View of M^-1 W, M^-1 N of a contact for the first body and those tied to it by joints: columns n, t1, t2."""
    return at(ws.floats, contact.response_a)


@kernel("F(ws, ContactRecord)")
def response_of_second(ws: Workspace, contact: ContactRecord) -> Floats:
    """View of M^-1 W, M^-1 N of a contact for the second body and those tied to it by joints: columns n, t1, t2."""
    return at(ws.floats, contact.response_b)
