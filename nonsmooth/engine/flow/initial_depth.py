"""Contacts that begin at a depth: a foot of one body that comes over the rim of the other from beside.

Feet of a flat face stand out of it, and its rim is set back by their height. Two bodies that touch at such a rim are
deeper in each other, by up to the height of the feet of both, than bodies that touch at a foot. So a foot that slides
or rolls over the rim is below the face when its contact begins. No displacement lifts it, as that would change the
energy: the gap of this contact counts from the depth at which it began. The foot thus keeps its depth until it is
lifted out, or leaves the face.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.kinematics import NOT_EVALUATED
from nonsmooth.engine.flow.guard_numbers import normal_of
from nonsmooth.engine.flow.self_check import allowed_gap
from nonsmooth.engine.memory.layout import NO_PAIR
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Workspace, kernel
from nonsmooth.engine.pairs.apart import renewed_separation


@kernel("b1(ws)")
def begin_at_depth(ws: Workspace) -> bool:
    """Let the gaps of feet that come over a rim count from their present depth. True if there are such feet.

    Their depth is more than the tolerances allow, and at most the height of the feet of both bodies, and the bodies
    without feet do not overlap. Any other contact that is as deep ends the run. Contacts must be evaluated; those that
    change must be evaluated again.
    """
    has_begun = False
    for contact in ws.contacts:
        may_begin = contact.mode == Mode.OPEN and not contact.is_compliant and contact.pair != NO_PAIR
        if not may_begin or contact.initial_depth > 0.0 or contact.past_feature > ws.tolerance.gap:
            continue
        # up to the tolerance past the rim, the depth is stored apart
        depth, allowed = -min(contact.gap, contact.overlap), allowed_gap(ws, contact.index)
        if allowed < depth <= ws.pairs[contact.pair].clearance and _are_apart(ws, contact.pair, allowed):
            contact.initial_depth, contact.version_a, has_begun = depth, NOT_EVALUATED, True
    return has_begun


@kernel("b1(ws, i8, f8)")
def _are_apart(ws: Workspace, group: int, allowed: float) -> bool:
    """True if the convex parts of two shapes overlap by at most ``allowed`` [m]: parts have no feet."""
    for pair in ws.pairs:
        if pair.group == group and renewed_separation(ws, pair) < -allowed:
            return False
    return True


@kernel()
def end_depths(ws: Workspace) -> None:
    """Let the gaps of open contacts count from the face again, once a foot is lifted out of it or is past its rim.

    Gaps at the end of the last step, from which the step that begins starts, change with it.
    """
    for contact in ws.contacts:
        depth, is_past = contact.initial_depth, contact.past_feature_at_end > ws.tolerance.gap
        if depth == 0.0 or contact.mode != Mode.OPEN or (contact.gap_at_end < depth and not is_past):
            continue
        contact.initial_depth, contact.version_a = 0.0, NOT_EVALUATED
        # past the rim, the gap is a distance to it
        if not is_past:
            contact.gap_at_end -= depth
            normal_of(ws, contact).at_end = contact.gap_at_end
