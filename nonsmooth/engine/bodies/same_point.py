"""Contacts at one point: several pairs of features of the same bodies, with the same normal.

Where the borders of two faces cross, a vertex over a face and two edges that cross are the same point. Their gap rates
differ by the turning times the distance of their points, which is tiny. No impulse can distinguish them, so one of them
takes part in an event, and the others stay open. When its features end, another one takes its place. The last of them
is kept, a vertex over faces: its features end where its point may become two.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.kinematics import motion_of
from nonsmooth.engine.memory.layout import NO_PAIR
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import ContactRecord, Workspace, kernel
from nonsmooth.engine.numerics.tolerances import NEGLIGIBLE
from nonsmooth.engine.numerics.vectors import ALIKE, Vector, are_alike, cross, distance, minus, scaled


@kernel("b1(ContactRecord, ContactRecord)")
def coincide(one: ContactRecord, other: ContactRecord) -> bool:
    """True if two different rigid contacts of the same frames have the same point and normal within ``ALIKE``."""
    if one.index == other.index or one.frame_a != other.frame_a or one.frame_b != other.frame_b:
        return False
    is_rigid = not one.is_compliant and not other.is_compliant
    is_same_point = distance(one.point_b, other.point_b) <= ALIKE * one.size
    return is_rigid and is_same_point and are_alike(one.normal, other.normal)


@kernel()
def leave_out_coincident(ws: Workspace) -> None:
    """Let an open contact of convex shapes take no part if it is at the point of another one that takes part.

    A closed contact takes part in any case. Of open ones it is the one that approaches fastest.
    """
    for contact in ws.contacts:
        is_open = contact.is_touching and contact.mode == Mode.OPEN
        if is_open and contact.pair != NO_PAIR and ws.pairs[contact.pair].is_guarded and _is_redundant(ws, contact):
            contact.is_touching = False


@kernel("v3(ws, ContactRecord)")
def _sliding_of(ws: Workspace, contact: ContactRecord) -> Vector:
    """Velocity at which the first witness point of a contact slides over its body, in the world [m/s]."""
    motion = motion_of(ws, contact)
    return minus(scaled(motion.u1, contact.tangent), scaled(-motion.u2, cross(contact.normal, contact.tangent)))


@kernel("b1(ws, ContactRecord)")
def _is_redundant(ws: Workspace, contact: ContactRecord) -> bool:
    """True if another touching contact coincides with an open one, and approaches as fast within the tolerance.

    The contact points of both must move at the same velocity. Otherwise they become two points: if a corner slides past
    an edge, two crossings of edges begin at its point. In a collision of two open contacts the velocity of the points
    is ignored, because several contacts at one point would count the impact several times.
    """
    slow, collides = NEGLIGIBLE * ws.tolerance.velocity, contact.normal_rate < -ws.tolerance.velocity
    for other in ws.contacts:
        is_as_fast = other.is_touching and other.normal_rate <= contact.normal_rate + ws.tolerance.velocity
        if is_as_fast and other.pair == contact.pair and coincide(contact, other):
            if collides and other.mode == Mode.OPEN:
                return True
            if distance(_sliding_of(ws, contact), _sliding_of(ws, other)) <= slow:
                return True
    return False
