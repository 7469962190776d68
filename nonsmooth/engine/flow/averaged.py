"""Averaged forces as time passes: where an averaging ends, and the next one of the same contacts begins."""

from __future__ import annotations

from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.compliance import push_compliant, refresh_states
from nonsmooth.engine.bodies.kinematics import evaluate_contact
from nonsmooth.engine.contact.mean_forces import is_averaged, measure_spans
from nonsmooth.engine.contact.problem import free_acceleration
from nonsmooth.engine.delassus.islands import activate_group, group_closed
from nonsmooth.engine.flow.mean_motion import find_mean_forces
from nonsmooth.engine.flow.mean_work import book_mean_forces
from nonsmooth.engine.flow.projection import project_closed
from nonsmooth.engine.memory.modes import OPEN
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, contact_at, kernel


@kernel("void(S, F, I)")
def reach_end(S: Scalars, w: Floats, k: Integers) -> None:
    """Take the modes that averaged forces were to end in, where they end, the rates there being at hand."""
    measure_spans(S, w, k)
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.averaged != OPEN and contact.mode != OPEN:
            contact.mode = contact.averaged
    S.closing_loss += project_closed(S, w, k, 1, 1)
    for c in range(S.n_contacts):
        contact_at(S, w, k, c).mean_way = 0.0


@kernel("void(S, F, I, i8)")
def renew_mean_forces(S: Scalars, w: Floats, k: Integers, follows: int) -> None:
    """Find the mean forces of the closed contacts that are averaged, from now on; after the end of the last (1)."""
    S.mean_until = 1e300
    group_closed(S, w, k)
    evaluate_bodies(S, w, k, S.t, S.y)
    refresh_states(S, w, k, S.y)
    for i in range(S.n_grouped):
        c = k[S.grouped + i]
        evaluate_contact(S, w, k, c, 3)
        contact_at(S, w, k, c).touching = 1
    book_mean_forces(S, w, k)
    free_acceleration(S, w, k, 1)
    push_compliant(S, w, k)
    for group in range(S.n_groups):
        activate_group(S, w, k, group)
        if is_averaged(S, w, k) == 1:
            find_mean_forces(S, w, k, follows)
