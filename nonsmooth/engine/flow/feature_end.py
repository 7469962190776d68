"""End or change of the features of a closed contact, if no step leads there.

A contact is at the nearest points of two features, a local minimum of their distance. If that minimum merges with
another one and vanishes, its point becomes infinitely fast, and the gap of the features behind it jumps by the size of
the bodies. The depth of a corner jumps in the same way if it leaves another body by its cap instead of its side, and so
does the force of a spring. No step crosses such a jump, because its stages beyond it meet another force. So steps
shrink to the time tolerance in front of it. Then straight lines over a few time tolerances find the features that end.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.kinematics import evaluate_geometry
from nonsmooth.engine.flow.guard_values import feature_guard
from nonsmooth.engine.memory.modes import NO_CONTACT
from nonsmooth.engine.native.kernel import Workspace, kernel

_DOUBLINGS = 3
"""Doublings of the time tolerance that are tried. A step shrinks at most to a fifth, so five tolerances have failed."""


@kernel("i8(ws)")
def find_feature_end(ws: Workspace) -> int:
    """Closed contact whose features end or change within eight time tolerances, or ``NO_CONTACT``.

    It is the cause if no step meets the tolerance. The motion is followed along a straight line. The time at which the
    end is found is written to ``step.h`` [s], the state there to ``y_new``. ``slopes`` must hold the slope at ``y``,
    and the closed contacts must be grouped.
    """
    # steps of up to five time tolerances have failed, so 1, 2, 4 and 8 of them are tried
    ws.step.h = ws.tolerance.time
    for _doubling in range(_DOUBLINGS + 1):
        for i in range(ws.model.n_y):
            ws.step.y_new[i] = ws.island.y[i] + ws.step.h * ws.island.slopes[i]
        evaluate_bodies(ws, ws.island.time + ws.step.h, ws.step.y_new.start)
        for i in range(ws.island.n_grouped):
            c = ws.island.grouped[i]
            evaluate_geometry(ws, c)
            # the end guard is negative past the end of the features, and if they have changed
            if feature_guard(ws, ws.contacts[c]) < 0.0:
                return c
        ws.step.h *= 2.0
    return NO_CONTACT
