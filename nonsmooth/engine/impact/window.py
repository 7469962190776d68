"""A large multiple impact, of which only the contacts near a travelling wave are evaluated.

Most contacts of a long chain are idle at any time of its impact. A window holds the contacts that are not idle, and
their neighbours in a few layers. Where the wave reaches the rim of the window, the bodies get the impulses so far, and
the next window is drawn about the contacts that are not idle then:

    gather ---> draw ---> load ---> integrate ---> store ---> collect
                  ^                                  |
                  +------------ rim reached ---------+

Phases, deformations and energies continue as they are, so no step differs from one of an integration of all contacts. A
chain of n balls then costs in proportion to n, and the Delassus matrix of all contacts is never needed. Without windows
the cost would grow with n^2: every step would evaluate all contacts.

Contacts have no list of their neighbours. Each articulation has a list of its colliding contacts: of entries that are
linked, one for each side of a contact.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.kinematics import row
from nonsmooth.engine.delassus.blocks import link_active
from nonsmooth.engine.delassus.delassus import add_response, assemble_delassus
from nonsmooth.engine.impact.end import account
from nonsmooth.engine.impact.integration import MOST_STEPS, run_impact
from nonsmooth.engine.impact.phases import start_phases
from nonsmooth.engine.impact.scales import CIRCLING, scale_impact
from nonsmooth.engine.impact.state import NOISE, state_of
from nonsmooth.engine.impact.step_length import first_step
from nonsmooth.engine.memory.modes import NO_CONTACT, ImpactOutcome, Phase, Truncation
from nonsmooth.engine.native.kernel import ActiveContact, ContactRecord, Workspace, entry_point, kernel
from nonsmooth.engine.numerics.arrays import copy_numbers

LARGE = 16
"""Number of contacts of an impact above which windows are used. A window would hold most of fewer contacts."""
_LAYERS = 4
"""Number of layers of neighbours in a window. The more there are, the more rarely a wave reaches the rim."""
_OUTSIDE = -1
"""Layer of a contact that is not in the window."""
_NO_ENTRY = -1
"""Number in place of an entry at the end of a list."""


@entry_point("ImpactOutcome(ws)")
def windowed_impact(ws: Workspace) -> ImpactOutcome:
    """Integrate a large impact of the active contacts, of which only those near the wave are evaluated at a time.

    These contacts form a window, which is drawn anew whenever the wave reaches its rim, the outermost layer. Results
    and outcome are those of :func:`nonsmooth.engine.impact.integration.energetic_impact`. After too many windows the
    outcome is ``ENDLESS``.
    """
    # a contact that is left alone may become the variable of integration
    ws.impact.may_be_lone, ws.impact.is_step_implicit = True, False
    ws.event.truncation = Truncation.NONE
    ws.impact.slow_steps = 0
    fastest = _gather(ws)
    outcome = _run_window(ws, fastest, is_first=True)
    for _ in range(1, MOST_STEPS):
        if outcome != ImpactOutcome.MOVED:
            break
        outcome = _run_window(ws, fastest, is_first=False)
    # other impacts have no windows
    ws.impact.faint_rate = 0.0
    _collect(ws)
    return ImpactOutcome.ENDLESS if outcome == ImpactOutcome.MOVED else outcome


@kernel("ImpactOutcome(ws, f8, b1)")
def _run_window(ws: Workspace, fastest: float, is_first: bool) -> ImpactOutcome:
    """Draw a window and integrate until the impact ends or reaches its rim. ``fastest`` is the fastest approach [m/s].

    Behind the wave, rates within the error cannot be distinguished from rest. If all contacts are in the window, none
    is behind the wave.
    """
    _draw(ws, fastest, is_first)
    has_all = len(ws.actives) == ws.impact.n_colliding
    ws.impact.faint_rate = 0.0 if has_all else CIRCLING * ws.tolerance.impact
    _load(ws)
    ws.impact.lone_contact = NO_CONTACT
    # the rates in later windows are smaller: the fastest approach of the impact remains their scale
    shortest = scale_impact(ws, fastest)
    if not shortest > 0.0:
        return ImpactOutcome.INVALID
    if is_first:
        ws.impact.h = first_step(ws, shortest)
        # seed: the speed of an impact without collision, and this one has an approach
        start_phases(ws, ws.impact.h, seed=0.0)
    outcome = run_impact(ws, ws.impact.h, shortest, is_windowed=True)
    _store(ws)
    return outcome


# --- the contacts of the impact ---------------------------------------------------------------------------------------


@kernel("f8(ws)")
def _gather(ws: Workspace) -> float:
    """List the active contacts, all idle, as those of the impact, and by articulation, so that neighbours are found.

    Copies the velocities, to which the windows add their impulses. Returns the fastest approach [m/s].
    """
    fastest = 0.0
    ws.impact.n_colliding = len(ws.actives)
    for articulation in ws.articulations:
        articulation.first_colliding = _NO_ENTRY
    copy_numbers(ws.floats, ws.island.velocities, ws.model.n_u, ws.impact.u.start)
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        fastest = max(fastest, -contact.normal_rate)
        ws.impact.colliding[active.index] = contact.index
        _clear(contact)
        _add_entry(ws, contact.articulation_a, contact.index)
        _add_entry(ws, contact.articulation_b, ws.model.n_slots + contact.index)
    return fastest


@kernel("void(ContactRecord)")
def _clear(contact: ContactRecord) -> None:
    """Set the impulse and the energies of a contact to zero, and its phase to idle, before the first window."""
    contact.window_phase, contact.window_sticks, contact.n_waves = Phase.IDLE, False, 0
    for r in range(3):
        contact.window_impulse[r] = 0.0
    contact.window_stored = contact.window_returned = contact.window_dissipated = 0.0
    contact.window_deformation = contact.window_energy = contact.window_lost = 0.0


@kernel("void(ws, i8, i8)")
def _add_entry(ws: Workspace, number: int, entry: int) -> None:
    """Add an entry to the linked list of articulation ``number``: a contact, plus ``n_slots`` for its second side.

    ``chain`` holds the next entry of each one.
    """
    articulation = ws.articulations[number]
    ws.impact.chain[entry] = articulation.first_colliding
    articulation.first_colliding = entry


@kernel()
def _collect(ws: Workspace) -> None:
    """Make the contacts of the impact the active ones again, with their impulses [N s] and energies [J]."""
    ws.problem.n_active = ws.impact.n_colliding
    for active in ws.actives:
        active.contact = ws.impact.colliding[active.index]
        contact = ws.contacts[active.contact]
        for r in range(3):
            active.impulse[r] = contact.window_impulse[r]
        active.energy_stored, active.energy_returned = contact.window_stored, contact.window_returned
        active.energy_dissipated = contact.window_dissipated


# --- a window ---------------------------------------------------------------------------------------------------------


@kernel("void(ws, f8, b1)")
def _draw(ws: Workspace, fastest: float, is_first: bool) -> None:
    """Draw the window: make the contacts that are not idle, and their neighbours in some layers, the active ones.

    In the first window all contacts are idle, and it is drawn about those that approach. ``fastest`` is the fastest
    approach [m/s].
    """
    ws.problem.n_active = 0
    for i in range(ws.impact.n_colliding):
        contact = ws.contacts[ws.impact.colliding[i]]
        contact.layer, contact.is_at_rim = _OUTSIDE, False
        approaches = is_first and contact.normal_rate < -NOISE * fastest
        if approaches or contact.window_phase != Phase.IDLE:
            _add(ws, contact, layer=0)
    # each layer adds the neighbours of the layer before, from begin to end
    begin = 0
    for layer in range(1, _LAYERS + 1):
        end = ws.problem.n_active
        for i in range(begin, end):
            contact = ws.contacts[ws.problem.active[i]]
            _add_neighbours(ws, contact.articulation_a, layer)
            _add_neighbours(ws, contact.articulation_b, layer)
        begin = end


@kernel("void(ws, ContactRecord, i8)")
def _add(ws: Workspace, contact: ContactRecord, layer: int) -> None:
    """Add a contact to the window, in a ``layer`` counted from the contacts that are not idle.

    The last layer is the rim.
    """
    contact.layer, contact.is_at_rim = layer, layer == _LAYERS
    ws.problem.active[ws.problem.n_active] = contact.index
    ws.problem.n_active += 1


@kernel("void(ws, i8, i8)")
def _add_neighbours(ws: Workspace, number: int, layer: int) -> None:
    """Add the contacts of articulation ``number`` that are outside the window. An immovable one transmits nothing."""
    articulation = ws.articulations[number]
    entry = articulation.first_colliding if articulation.n_u > 0 else _NO_ENTRY
    while entry != _NO_ENTRY:
        # an entry is a contact, plus n_slots for its second side
        neighbour = ws.contacts[entry if entry < ws.model.n_slots else entry - ws.model.n_slots]
        if neighbour.layer == _OUTSIDE:
            _add(ws, neighbour, layer)
        entry = ws.impact.chain[entry]


@kernel()
def _load(ws: Workspace) -> None:
    """Write Delassus matrix, rates and state of the window. Its structure takes the place of that of the island.

    Rates follow from the velocities after the windows before.
    """
    link_active(ws)
    assemble_delassus(ws)
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        # part of the driven bodies, and part of the velocities
        for r in range(3):
            active.rate_before[r] = contact.prescribed_rate[r] + row(ws, contact.index, r, ws.impact.u.start)
        _load_state(ws, active, contact)


@kernel("void(ws, ActiveContact, ContactRecord)")
def _load_state(ws: Workspace, active: ActiveContact, contact: ContactRecord) -> None:
    """Continue the phase, the deformation and the energy of a contact. Impulses and accounts start from zero."""
    state = state_of(ws, active)
    for r in range(3):
        state.impulse[r] = 0.0
    state.work = state.dissipated = 0.0
    state.deformation, state.energy = contact.window_deformation, contact.window_energy
    state.lost = contact.window_lost
    active.energy_stored = active.energy_returned = active.work_accounted = 0.0
    active.phase, active.sticks = contact.window_phase, contact.window_sticks
    active.was_halted = False


@kernel()
def _store(ws: Workspace) -> None:
    """Give the bodies the impulses of the window, and store the state in which it ends, for the next window.

    Impulses and energies are summed over the windows.
    """
    for active in ws.actives:
        state, contact = state_of(ws, active), ws.contacts[active.contact]
        account(ws, active)
        for r in range(3):
            active.impulse[r] = state.impulse[r]
            contact.window_impulse[r] += active.impulse[r]
        contact.window_stored += active.energy_stored
        contact.window_returned += active.energy_returned
        contact.window_dissipated += state.dissipated
        contact.window_deformation, contact.window_energy = state.deformation, state.energy
        contact.window_lost = state.lost
        contact.window_phase, contact.window_sticks = active.phase, active.sticks
    add_response(ws, ws.impact.impulse.start, ws.impact.u.start)
