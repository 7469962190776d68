"""The instant in which the features of a closed contact end, or change, where no step leads.

A contact is at the nearest points of two features, a local minimum of their distance.  Where that minimum merges with
another one and vanishes, its point runs ever faster, and what the features report behind jumps by the size of the
bodies.  So does the depth of a corner where it leaves another body by its cap in place of its side, and with it the
force of a spring.  No step crosses that: a stage behind it meets another force.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.kinematics import evaluate_geometry
from nonsmooth.engine.flow.guard_values import feature_guard
from nonsmooth.engine.native.kernel import Workspace, kernel

_DOUBLINGS = 3
"""Steps shrink by a factor of five at once, so that the last one that failed is up to five tolerances long."""


@kernel("i8(ws)")
def find_feature_end(ws: Workspace) -> int:
    """Return a closed contact whose features end or change within the least times, the state there ``y_new``, or -1.

    So short a way, the time ``h``, is straight.  ``slopes`` must hold the slope at ``y``, and the closed contacts be
    grouped.
    """
    ws.step.h = ws.tolerance.time
    for _doubling in range(_DOUBLINGS + 1):
        for i in range(ws.model.n_y):
            ws.step.y_new[i] = ws.island.y[i] + ws.step.h * ws.island.slopes[i]
        evaluate_bodies(ws, ws.island.time + ws.step.h, ws.step.y_new.start)
        for i in range(ws.island.n_grouped):
            c = ws.island.grouped[i]
            evaluate_geometry(ws, c)
            if feature_guard(ws, ws.contacts[c]) < 0.0:
                return c
        ws.step.h *= 2.0
    return -1
