"""Collisions: the impact law gives the impulses of each island, and the velocities jump.

An impact lasts for a contact time. Bodies that are so close that they meet within it, as in a row of balls, would
otherwise collide one after the other, with another result than a shock that runs through the row. So contacts that the
collision closes before it is over take part in it.

An impact is also what resolves a jam, where sliding contacts hold a body fast, and Painleve's paradox, where a sliding
contact has no force: both are impacts without an approach.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.anisotropy import on_unit_tangents, release_sticking_anisotropic
from nonsmooth.engine.bodies.compliance import accelerate_by_compliance
from nonsmooth.engine.bodies.courses import end_own_steps_of, has_own_step
from nonsmooth.engine.bodies.kinematics import evaluate_bias, evaluate_jacobian
from nonsmooth.engine.bodies.touching import find_touching
from nonsmooth.engine.contact.forces import reduced_coefficient
from nonsmooth.engine.contact.problem import accelerate_touching
from nonsmooth.engine.delassus.delassus import add_response, assemble_delassus
from nonsmooth.engine.delassus.islands import activate_group, group_touching
from nonsmooth.engine.events.accumulation import set_provisional_mode, slow_speed
from nonsmooth.engine.events.record import begin_event, impact_code, record_event
from nonsmooth.engine.impact.end import how_over
from nonsmooth.engine.impact.instant import jam_slips, map_impact
from nonsmooth.engine.impact.integration import energetic_impact
from nonsmooth.engine.impact.window import LARGE, windowed_impact
from nonsmooth.engine.memory.event_rows import DRIVEN_WORK, FRICTION_LOSS, RESTITUTION_LOSS
from nonsmooth.engine.memory.modes import (
    NO_CONTACT,
    NO_RELEASE,
    Cause,
    ImpactOutcome,
    Mode,
    Painleve,
    Status,
    Truncation,
)
from nonsmooth.engine.native.kernel import ContactRecord, Workspace, entry_point, kernel
from nonsmooth.engine.numerics.tolerances import ALLOWED
from nonsmooth.engine.numerics.vectors import length


@entry_point("Status(ws, Cause, i8, f8)")
def collide(ws: Workspace, cause: Cause, which: int, seed: float) -> Status:
    """Apply the impact law to the touching contacts, island by island, and record the impact.

    ``RUNNING``, or why an island has no impulses; then the velocities are those before. An impact without collision
    starts from rest and needs a speed ``seed`` [m/s] to begin with. ``which`` is the contact that is recorded.
    """
    begin_event(ws)
    # the end of an impact needs free accelerations: which rates are too slow to bounce depends on them
    accelerate_touching(ws)
    accelerate_by_compliance(ws)
    group_touching(ws)
    n_phases, truncation = 0, Truncation.NONE
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        if not _takes_part(ws, cause, which):
            continue
        status = _collide_island(ws, cause, seed)
        if status != Status.RUNNING:
            _restore_velocities(ws)
            return status
        # the record counts the phases of all islands, and has the worst of their truncations
        n_phases += ws.event.n_phases
        if ws.event.truncation > truncation:
            truncation = ws.event.truncation
    ws.event.n_phases, ws.event.truncation = n_phases, truncation
    _add_to_totals(ws)
    _set_provisional_modes(ws)
    record_event(ws, cause, which, ws.event.n_phases)
    return Status.RUNNING


@kernel("b1(ws, Cause, i8)")
def _takes_part(ws: Workspace, cause: Cause, which: int) -> bool:
    """True if the active contacts collide: one of them approaches, or it is ``which``, the cause of the event.

    Of a jam or of Painleve's paradox, only the island of ``which`` has impulses.
    """
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        approaches = contact.normal_rate < -ws.tolerance.velocity
        if contact.index == which or (cause == Cause.IMPACT and approaches):
            return True
    return False


@kernel("Status(ws, Cause, f8)")
def _collide_island(ws: Workspace, cause: Cause, seed: float) -> Status:
    """Apply the impact law to the active contacts, and its impulses to the bodies. ``RUNNING``, or why it fails.

    Large islands are solved in windows, which assemble their own parts of the Delassus matrix.
    """
    # a map of velocities needs all contacts at once; an impact without collision has no approach to begin a window with
    is_large = len(ws.actives) > LARGE and ws.options.impact_map == 0 and cause == Cause.IMPACT
    if not is_large:
        assemble_delassus(ws)
    _write_rates_before(ws, cause == Cause.PAINLEVE and ws.options.painleve_policy == Painleve.COMPLIANT)
    # an integrated impact counts its phases; any other one has a single phase
    ws.event.n_phases, ws.event.truncation = 1, Truncation.NONE
    ws.event.slow_speed = slow_speed(ws)
    status = _find_impulses(ws, cause, seed, is_large)
    if status != Status.RUNNING:
        return status
    for i in range(3 * len(ws.actives)):
        if not abs(ws.impact.impulse[i]) < math.inf:
            return Status.NOT_FINITE
    add_response(ws, ws.impact.impulse.start, ws.island.y.start + ws.model.n_q)
    _account_for_impulses(ws, is_large)
    return Status.RUNNING


@kernel("void(ws, b1)")
def _write_rates_before(ws: Workspace, is_lossless: bool) -> None:
    """Write the rates of the active contacts before the impact [m/s], and whether their restitution is to be 1.

    A gap rate within the velocity tolerance is written as zero: it must not begin a compression. The bits of Eq. (29)
    for the record are taken here, too.
    """
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        contact.code_during = impact_code(ws, contact.index)
        active.is_lossless = is_lossless
        is_zero = not abs(contact.normal_rate) > ws.tolerance.velocity
        active.rate_before[0] = 0.0 if is_zero else contact.normal_rate
        for r in range(1, 3):
            active.rate_before[r] = contact.rate[r]


@kernel("Status(ws, Cause, f8, b1)")
def _find_impulses(ws: Workspace, cause: Cause, seed: float, is_large: bool) -> Status:
    """Find the impulses of the active contacts: of a jam, by a map of velocities, or by integration over the impact.

    A jam is a slip at the Painleve singularity. ``RUNNING`` if they are found. An endless impact may be cut short if
    what is left of the approach is negligible, or would be stopped by infinitely many compressions.
    """
    if cause == Cause.JAM:
        return Status.RUNNING if jam_slips(ws) else Status.NO_CONTACT_SOLUTION
    if ws.options.impact_map != 0:
        map_impact(ws)
        return Status.RUNNING
    outcome = windowed_impact(ws) if is_large else energetic_impact(ws, seed)
    if outcome == ImpactOutcome.INVALID:
        return Status.NOT_FINITE
    if outcome == ImpactOutcome.ENDLESS:
        # a large or interrupted impact that was cut short has no result
        ws.event.truncation = Truncation.NONE
        if not is_large and not ws.request.is_interrupted:
            ws.event.truncation = how_over(ws)
        if ws.event.truncation == Truncation.NONE:
            return Status.IMPACT_ENDLESS
    return Status.RUNNING


@kernel("void(ws, b1)")
def _account_for_impulses(ws: Workspace, is_large: bool) -> None:
    """Store the impulses of the active contacts, and add their losses and the work of driven bodies to the event.

    A gap rate that the impact took for zero (:func:`_write_rates_before`) adds its work, impulse times rate, by which
    the kinetic energy changes, too. Large impacts, in windows, take no rate for zero.
    """
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        neglected = 0.0 if is_large else contact.normal_rate - active.rate_before[0]
        ws.event.head[RESTITUTION_LOSS] += active.energy_stored - active.energy_returned - active.impulse[0] * neglected
        ws.event.head[FRICTION_LOSS] += active.energy_dissipated
        for r in range(3):
            impulse = active.impulse[r]
            contact.event_impulse[r] = impulse
            # work of the driven bodies against the impulse, at the rate that they prescribe
            ws.event.head[DRIVEN_WORK] -= impulse * contact.prescribed_rate[r]
        # the tangents of anisotropic friction are stretched; the record has unit tangents
        if contact.is_anisotropic:
            contact.event_friction = on_unit_tangents(ws, contact.index, contact.event_friction)


@kernel()
def _add_to_totals(ws: Workspace) -> None:
    """Add the energies of the event to the totals of the run."""
    ws.totals.n_impacts += 1
    ws.totals.driven_work += ws.event.head[DRIVEN_WORK]
    ws.totals.restitution_loss += ws.event.head[RESTITUTION_LOSS]
    ws.totals.friction_loss += ws.event.head[FRICTION_LOSS]


@kernel()
def _restore_velocities(ws: Workspace) -> None:
    """Restore the velocities before the event, because an island has no impulses."""
    # the impulses of other islands are lost, too; they are in no account yet
    for i in range(ws.model.n_u):
        ws.island.y[ws.model.n_q + i] = ws.event.u_before[i]


@kernel()
def _set_provisional_modes(ws: Workspace) -> None:
    """Give the contacts the modes that their rates after an impact suggest, until those of the instant are found."""
    # the bound of anisotropic friction then follows the direction of slip after the impact
    release_sticking_anisotropic(ws)
    find_touching(ws)
    for contact in ws.contacts:
        # the contact was closed before, or took part in the impact
        if contact.code_during != contact.code_before or contact.mode != Mode.OPEN:
            set_provisional_mode(ws, contact.index)
        # a release by a jump of the contact point is in the mode now
        contact.release = NO_RELEASE


@kernel("Status(ws, i8)")
def resolve_jam(ws: Workspace, which: int) -> Status:
    """Stop the slip of contact ``which``, which jams, by an impact of its island. ``RUNNING``, or why that fails.

    The user may have the run end at a jam instead.
    """
    if ws.options.painleve_policy == Painleve.REFUSE:
        return Status.PARADOX_REFUSED
    # seed: the impulses of a jam are found without an integration that it would begin
    return collide(ws, Cause.JAM, which, seed=0.0)


@kernel("Status(ws)")
def collide_without_approach(ws: Workspace) -> Status:
    """Start an impact from rest at the active contacts whose sliding has no force. ``RUNNING``, or why there is none.

    There the friction of a unit of normal force presses the contact together more than the force pushes it apart: the
    reduced normal coefficient is not positive. The fastest of their slips is the scale of the speeds of the impact.
    """
    for contact in ws.contacts:
        contact.has_no_force = False
    which, seed = NO_CONTACT, 0.0
    for active in ws.actives:
        # the force problem of the island has just failed, and has left its data
        if not active.is_at_rest and reduced_coefficient(ws, active.index) <= 0.0:
            which = active.contact
            ws.contacts[which].has_no_force = True
            seed = max(seed, length(ws.contacts[which].slip))
    if which == NO_CONTACT:
        return Status.NO_CONTACT_SOLUTION
    if ws.options.painleve_policy == Painleve.REFUSE:
        return Status.PARADOX_REFUSED
    return collide(ws, Cause.PAINLEVE, which, seed)


@kernel("b1(ws, ContactRecord)")
def _has_touching_contact(ws: Workspace, contact: ContactRecord) -> bool:
    """True if a contact of the same two frames touches. Then the bodies meet there, and not at this one."""
    for other in ws.contacts:
        if other.is_touching and other.frame_a == contact.frame_a and other.frame_b == contact.frame_b:
            return True
    return False


@kernel("i8(ws, f8)")
def add_closing_contacts(ws: Workspace, speed: float) -> int:
    """Let contacts touch whose gaps a collision at a ``speed`` [m/s] may close within its contact time.

    The collision lasts for that time, so they take part in it. Their gaps must be within the allowed one, because
    friction that acts over a larger gap would turn the bodies. The own steps (multirate) of these bodies end. Number of
    steps that ended: if it is not zero, the touching contacts must be found anew.
    """
    n_ended = 0
    for contact in ws.contacts:
        # past_feature > 0: the nearest point is past the end of an edge or a face, so the features do not meet there
        is_apart = not contact.is_touching and not contact.is_compliant and contact.past_feature <= 0.0
        near = min(contact.contact_time * speed, ALLOWED * ws.tolerance.gap)
        is_free = is_apart and contact.gap <= near and not has_own_step(ws, contact.index)
        if is_free and not _has_touching_contact(ws, contact):
            # as of every touching contact, its Jacobian and second-order terms are needed
            contact.is_touching = True
            evaluate_jacobian(ws, contact.index)
            evaluate_bias(ws, contact.index, rows=3)
            n_ended += end_own_steps_of(ws, contact.index)
    return n_ended
