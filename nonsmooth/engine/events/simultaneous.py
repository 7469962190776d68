"""Contacts of other bodies that a collision closes before it is over: they take part in the collision.

An impact lasts for a contact time. Bodies that are so close that they meet within it, as in a row of balls, would
otherwise collide one after the other, with another result than a shock that runs through the row.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.courses import end_own_steps_of, has_own_step
from nonsmooth.engine.bodies.kinematics import evaluate_bias, evaluate_jacobian
from nonsmooth.engine.flow.self_check import ALLOWED
from nonsmooth.engine.native.kernel import Contact, Workspace, kernel


@kernel("b1(ws, Contact)")
def _has_touching_contact(ws: Workspace, contact: Contact) -> bool:
    """True if a contact of the same two frames touches. Then the features of this one follow only after those."""
    for other in ws.contacts:
        if other.is_touching and other.frame_a == contact.frame_a and other.frame_b == contact.frame_b:
            return True
    return False


@kernel("i8(ws, f8)")
def add_closing_contacts(ws: Workspace, speed: float) -> int:
    """Let contacts touch whose gaps a collision at a ``speed`` [m/s] may close within its contact time.

    Their gaps must be within the allowed one. Friction that acts over a larger gap would turn the bodies. Own steps of
    the bodies that touch end. Number of these steps: if it is not zero, the touching contacts must be found anew.
    """
    n_ended = 0
    for contact in ws.contacts:
        is_apart = not contact.is_touching and not contact.is_compliant and contact.past_feature <= 0.0
        near = min(contact.contact_time * speed, ALLOWED * ws.tolerance.gap)
        is_free = is_apart and contact.gap <= near and not has_own_step(ws, contact.index)
        if is_free and not _has_touching_contact(ws, contact):
            contact.is_touching = True
            evaluate_jacobian(ws, contact.index)
            evaluate_bias(ws, contact.index, 3)
            n_ended += end_own_steps_of(ws, contact.index)
    return n_ended
