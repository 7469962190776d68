"""Averaged forces as time passes: where an averaging ends, and the next one of the same contacts begins."""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.compliance import accelerate_by_compliance, copy_inner_states
from nonsmooth.engine.bodies.kinematics import evaluate_contact
from nonsmooth.engine.contact.mean_forces import is_averaged, measure_spans
from nonsmooth.engine.contact.problem import free_acceleration
from nonsmooth.engine.delassus.islands import activate_group, group_closed
from nonsmooth.engine.flow.averaging_time import find_mean_forces
from nonsmooth.engine.flow.mean_work import account_for_mean_forces
from nonsmooth.engine.flow.projection import project_closed
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Workspace, kernel


@kernel()
def end_averaging_span(ws: Workspace) -> None:
    """Take the modes that averaged forces were to end in, where they end, the rates there being at hand."""
    measure_spans(ws)
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        if contact.is_averaged and contact.mode != Mode.OPEN:
            contact.mode = contact.mode_after_averaging
    ws.totals.closing_loss += project_closed(ws, at_event=True, averaged=True)
    for c in range(ws.island.n_contacts):
        ws.contacts[c].mean_gap_change = 0.0


@kernel("void(ws, b1)")
def start_averaging_span(ws: Workspace, follows: bool) -> None:
    """Find the mean forces of the closed contacts that are averaged, from now on; after the end of the last (1)."""
    ws.island.averaged_until = math.inf
    group_closed(ws)
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    copy_inner_states(ws, ws.island.y.start)
    for i in range(ws.island.n_grouped):
        c = ws.island.grouped[i]
        evaluate_contact(ws, c, 3)
        ws.contacts[c].is_touching = True
    account_for_mean_forces(ws)
    free_acceleration(ws, of_all_bodies=True)
    accelerate_by_compliance(ws)
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        if is_averaged(ws):
            find_mean_forces(ws, follows)
