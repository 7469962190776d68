"""From a System to the engine's memory."""

from __future__ import annotations

import math

import numpy as np

from nonsmooth.engine.events.record import CODE_HEAD, EVENT_HEAD, LISTED, MOST_EVENTS
from nonsmooth.engine.memory.layout import BOOKED, COUNTS, N_ACCOUNTS
from nonsmooth.engine.memory.memory import Heap, allocate
from nonsmooth.engine.memory.modes import POLICIES
from nonsmooth.engine.memory.solvers import pivoted_contacts, solver_number
from nonsmooth.engine.native.kernel import room_addresses
from nonsmooth.model.checks import check_guards, check_start
from nonsmooth.model.laid_out import LaidOut, map_width
from nonsmooth.model.laying import lay_bodies, lay_guards, lay_joints, lay_loads
from nonsmooth.model.laying_contacts import initial_state, lay_contacts
from nonsmooth.model.linkages import linkages
from nonsmooth.model.options import Options
from nonsmooth.model.pools import lay_pools
from nonsmooth.model.units import find_units, lay_units
from nonsmooth.system.system import System

_EVENTS = 2048
"""Events of the usual size that the buffers hold."""
_TYPICAL = 32
"""Contacts listed in an event of the usual size."""
_SAMPLE_ROWS = 4096


def assemble(system: System, options: Options) -> LaidOut:
    """Lay out a validated system.

    Raises
    ------
    InvalidInput
        If bodies overlap at the start, a joint is not closed there, or a guard has no value.
    """
    model = lay_out(system, options)
    check_start(model)
    return model


def lay_out(system: System, options: Options) -> LaidOut:
    """Lay out a system, and list the contacts that are near each other at its start; look at nothing else there.

    Raises
    ------
    InvalidInput
        If these are too many.
    """
    model = lay(system, options)
    model.memory.array("y", model.n_q + model.n_u)[:] = np.concatenate(system.starts())
    model.list_contacts()
    return model


def lay(system: System, options: Options) -> LaidOut:
    """Lay out a system that stands nowhere yet.

    Raises
    ------
    InvalidInput
        If a guard has no value where the system was placed.
    """
    check_guards(system, 0.0, *system.starts())
    bodies, contacts = system.bodies, system.contacts
    n_q = sum(body.n_q for body in bodies)
    n_u = sum(body.n_u for body in bodies)
    n_states = sum(len(initial_state(contact)) for contact in contacts)
    groups = linkages(system)
    units = find_units(contacts)
    n_y = n_q + n_u + N_ACCOUNTS + n_states
    head = EVENT_HEAD + n_u + n_y + BOOKED
    counts = {
        "n_bodies": len(bodies),
        "n_slots": units.n_slots,
        "n_declared": len(contacts),
        "n_units": len(units.radii),
        "n_partners": len(units.pairs),
        "n_paired": len(contacts),
        "n_pools": len(units.pools),
        "n_own_guards": len(system.guards),
        "n_loads": len(system.loads),
        "n_joints": len(system.joints),
        "n_linkages": len(groups),
        "n_q": n_q,
        "n_u": n_u,
        "n_y": n_y,
        "n_states": n_states,
        "n_pivoted": pivoted_contacts(solver_number(options.solver), units.n_slots),
        "map_width": map_width(contacts),
        "event_floats": _EVENTS * (head + LISTED * min(units.n_slots, _TYPICAL))
        + MOST_EVENTS * (head + LISTED * units.n_slots),
        "event_integers": _EVENTS * (CODE_HEAD + 2 * min(units.n_slots, _TYPICAL))
        + MOST_EVENTS * (CODE_HEAD + 2 * units.n_slots),
        "sample_capacity": _SAMPLE_ROWS,
    }
    assert set(counts) == set(COUNTS)
    memory = allocate(counts)
    heap = Heap(memory)
    memory.array("rooms", len(room_addresses()))[:] = room_addresses()
    places = lay_bodies(system, memory, heap)
    lay_joints(memory, heap, groups, places)
    lay_loads(system, memory, heap, places)
    lay_contacts(memory, heap, contacts, places)
    lay_units(memory, units, {(i, f): at for i, place in places.items() for f, at in enumerate(place.frames)})
    lay_pools(memory, heap, units.pools, units.frames)
    lay_guards(system, memory, heap)
    model = LaidOut(system, heap.close(), n_q, n_u, n_states)
    _set_scalars(model, options)
    return model


def _set_scalars(model: LaidOut, options: Options) -> None:
    scalars = model.memory.scalars
    step = min(options.largest_step, model.system.time_scale / options.steps_per_period)
    values = {
        "solver": solver_number(options.solver),
        "policy": POLICIES.index(options.painleve),
        "rtol": options.tolerance,
        "impact_rtol": options.impact_tolerance,
        "time_tolerance": options.time_tolerance,
        "time_resolution": options.time_tolerance,
        "gap_tolerance": options.gap_tolerance,
        "velocity_tolerance": options.velocity_tolerance,
        "h_max": step,
        "h_free": step,
        "h_closed": step,
        "h_sampled": math.inf,
        "h_valid": math.inf,
        "last_event_t": -math.inf,
        "chosen_t": -math.inf,
        "feature_t": -math.inf,
        "driven_t": -math.inf,
    }
    for name, value in values.items():
        scalars[name] = value
