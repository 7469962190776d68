"""From a System to the engine's memory."""

from __future__ import annotations

import numpy as np

from nonsmooth.engine.events.record import CODE_HEAD, EVENT_HEAD, LISTED, MOST_EVENTS
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.layout import BOOKED, N_ACCOUNTS
from nonsmooth.engine.memory.memory import Heap, allocate
from nonsmooth.engine.memory.tables import COUNTS
from nonsmooth.engine.native.kernel import entry_addresses
from nonsmooth.interfaces import Engine
from nonsmooth.model.articulations import articulations
from nonsmooth.model.block_ends import BlockEnds
from nonsmooth.model.checks import check_guards, check_start
from nonsmooth.model.contact_table import ContactTable
from nonsmooth.model.engine_parts import check_report, counts_of, laid_own, settings_of
from nonsmooth.model.laid_out import LaidOut, map_width
from nonsmooth.model.laying import lay_bodies, lay_guards, lay_joints, lay_loads
from nonsmooth.model.laying_contacts import by_kind, initial_state, lay_contacts
from nonsmooth.model.part_pairs import carriers_of, find_part_pairs, lay_part_pairs
from nonsmooth.model.pools import lay_pools
from nonsmooth.model.units import find_units, lay_units
from nonsmooth.system.system import System

_EVENTS = 2048
"""Events of the usual size that the buffers hold."""
_TYPICAL = 32
"""Contacts listed in an event of the usual size."""
_SAMPLE_ROWS = 4096


def assemble(system: System, engine: Engine) -> LaidOut:
    """Lay out a validated system.

    Raises
    ------
    InvalidInput
        If bodies overlap at the start, a joint is not closed there, or a guard has no value.
    """
    model = lay(system, engine)
    ends = BlockEnds.of(model.memory)
    _stand(model)
    check_start(model, ends)
    return model


def lay_out(system: System, engine: Engine) -> LaidOut:
    """Lay out a system, and list the contacts that are near each other at its start; look at nothing else there.

    Raises
    ------
    InvalidInput
        If these are too many.
    """
    model = lay(system, engine)
    _stand(model)
    return model


def _stand(model: LaidOut) -> None:
    model.memory[owners.Island.y][: model.n_q + model.n_u] = np.concatenate(model.system.starts())
    model.list_contacts()


def lay(system: System, engine: Engine) -> LaidOut:
    """Lay out a system that stands nowhere yet.

    Raises
    ------
    InvalidInput
        If the engine cannot run it or names what there is not, or a guard has no value where it was placed.
    """
    engine.check(system)
    check_report(engine)
    check_guards(system, 0.0, *system.starts())
    bodies, contacts = system.bodies, system.contacts
    n_q = sum(body.n_q for body in bodies)
    n_u = sum(body.n_u for body in bodies)
    kinds = by_kind(contacts)
    n_states = sum(len(numbers) * len(initial_state(contacts[numbers[0]])) for numbers in kinds)
    groups = articulations(system)
    table = ContactTable.of(bodies, contacts)
    units = find_units(contacts, table, bodies)
    pairs = find_part_pairs(contacts, table)
    n_y = n_q + n_u + N_ACCOUNTS + n_states
    head = EVENT_HEAD + n_u + n_y + BOOKED
    counts = {
        "n_bodies": len(bodies),
        "n_slots": units.n_slots,
        "n_declared": len(contacts),
        "n_spheres": len(units.radii),
        "n_partners": len(units.pairs),
        "n_paired": len(units.contacts),
        "n_half_spaces": len(units.walls) if len(units.radii) > 0 else 0,
        "n_searches": len(units.pools),
        "n_pairs": len(pairs),
        "n_carriers": len(carriers_of(pairs)),
        "n_own_guards": len(system.guards),
        "n_loads": len(system.loads),
        "n_joints": len(system.joints),
        "n_articulations": len(groups),
        "n_q": n_q,
        "n_u": n_u,
        "n_y": n_y,
        "n_states": n_states,
        "map_width": map_width([contacts[numbers[0]] for numbers in kinds]),
        "event_floats": _EVENTS * (head + LISTED * min(units.n_slots, _TYPICAL))
        + MOST_EVENTS * (head + LISTED * units.n_slots),
        "event_integers": _EVENTS * (CODE_HEAD + 2 * min(units.n_slots, _TYPICAL))
        + MOST_EVENTS * (CODE_HEAD + 2 * units.n_slots),
        "sample_capacity": _SAMPLE_ROWS,
    }
    free = [name for name in COUNTS if name not in counts]
    counts = dict.fromkeys(COUNTS, 0) | counts | {**counts_of(engine, units.n_slots, free)}
    settings = settings_of(engine, system.time_scale)
    memory = allocate(counts, laid_own(engine, counts))
    heap = Heap(memory)
    memory[owners.Model.entry_points][: len(entry_addresses())] = entry_addresses()
    places = lay_bodies(system, memory, heap)
    lay_joints(memory, heap, groups, places)
    lay_loads(system, memory, heap, places)
    lay_contacts(memory, heap, contacts, table, kinds, places)
    lay_units(memory, units, {(p.number, f): at for p in places.values() for f, at in enumerate(p.frames)})
    lay_part_pairs(memory, heap, pairs, places)
    lay_pools(memory, heap, units.pools, table, units.frames)
    lay_guards(system, memory, heap)
    model = LaidOut(system, heap.close(), n_q, n_u, n_states)
    for scalar, value in settings.items():
        model.memory[scalar] = value
    engine.prepare(model)
    return model
