"""Averaged forces over time: the end of one averaging span, and the start of the next.

Averaged forces are a time-stepping fallback for an island whose instantaneous forces lead to an accumulation of events.
They are constant over a span of about one contact time (:mod:`nonsmooth.engine.contact.mean_forces`). At its end the
contacts get the modes that the step of the fallback predicts, and the next span starts.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.compliance import accelerate_by_compliance, copy_inner_states
from nonsmooth.engine.bodies.kinematics import evaluate_contact
from nonsmooth.engine.contact.mean_forces import is_averaged, set_spans
from nonsmooth.engine.contact.problem import free_acceleration
from nonsmooth.engine.delassus.islands import activate_group, group_closed
from nonsmooth.engine.flow.averaging_time import find_mean_forces
from nonsmooth.engine.flow.projection import project_closed
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Workspace, kernel


@kernel()
def end_averaging_span(ws: Workspace) -> None:
    """Give the contacts with averaged forces the modes after their span, and put them on their constraints.

    Averaged forces are constant over the span. The contacts must be evaluated at its end. Also writes how long the next
    span of each may be, and adds the energy that the projection removes to the closing loss [J].
    """
    set_spans(ws)
    for contact in ws.contacts:
        if contact.is_averaged and contact.mode != Mode.OPEN:
            contact.mode = contact.mode_after_averaging
    ws.totals.closing_loss += project_closed(ws, at_event=True, averaged=True)
    for contact in ws.contacts:
        # the projection has closed the gaps, so none has to come to rest
        contact.mean_gap_change = 0.0


@kernel("void(ws, b1)")
def start_averaging_span(ws: Workspace, follows: bool) -> None:
    """Find the forces of the islands that are averaged over time, constant over a span from the present time on.

    A span that ``follows`` another one may be longer than a first one. ``averaged_until`` becomes the first end of a
    span [s], infinite if no island is averaged.
    """
    # find_mean_forces lowers it to the end of each span
    ws.island.averaged_until = math.inf
    group_closed(ws)
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    copy_inner_states(ws, ws.island.y.start)
    for i in range(ws.island.n_grouped):
        c = ws.island.grouped[i]
        evaluate_contact(ws, c, rows=3)
        # closed contacts touch, and the accelerations by compliance are those of touching contacts
        ws.contacts[c].is_touching = True
    free_acceleration(ws, of_all_bodies=True)
    accelerate_by_compliance(ws)
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        if is_averaged(ws):
            find_mean_forces(ws, follows)
