"""Assembly: lays a System out in the memory of the engine.

All sizes are known before the memory is allocated: first the parts of the system are counted, then they are written.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from nonsmooth.binding.compile import parameter_names
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.event_rows import CODE_HEAD, EVENT_HEAD, LISTED, MOST_EVENTS
from nonsmooth.engine.memory.heap import Heap
from nonsmooth.engine.memory.layout import BOOKED, N_ACCOUNTS
from nonsmooth.engine.memory.memory import allocate
from nonsmooth.engine.memory.tables import SLOT_COUNTS
from nonsmooth.engine.native.kernel import entry_addresses
from nonsmooth.interfaces import Engine, ImpactLaw, ImpactMap
from nonsmooth.model.blocks import marks_behind_blocks
from nonsmooth.model.broad_phase import BroadPhase, find_broad_phase, lay_broad_phase
from nonsmooth.model.checks import check_guards, check_start
from nonsmooth.model.engine_parts import check_report, counts_of, laid_own, settings_of
from nonsmooth.model.feature_searches import lay_searches
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.laying import ArticulationLayout, articulations, lay_bodies, lay_guards, lay_joints, lay_loads
from nonsmooth.model.laying_contacts import Groups, groups_of, initial_state, lay_contacts
from nonsmooth.model.part_pairs import PartPair, carriers_of, find_part_pairs, lay_part_pairs
from nonsmooth.model.row_table import RowTable
from nonsmooth.model.scales import check_gap_tolerance, scales_of
from nonsmooth.system.system import System

_EVENTS = 2048
"""Number of events of the usual size that the buffers hold. To empty them costs little per event then."""
_CONTACTS_PER_EVENT = 32
"""Number of active contacts in an event of the usual size. Fewer events fit into the buffers if they are larger."""
_SAMPLES = 4096
"""Number of samples that the buffer holds."""


class _Parts(NamedTuple):
    """The parts of a system, found before the memory is allocated."""

    groups: Groups
    articulations: Sequence[ArticulationLayout]
    table: RowTable
    broad_phase: BroadPhase
    pairs: Sequence[PartPair]

    @classmethod
    def of(cls, system: System) -> _Parts:
        """Find the kinds of contacts, articulations, bounding spheres and pairs of convex parts of a system."""
        bodies, contacts = system.bodies, system.contacts
        table = RowTable.of(bodies, contacts)
        return cls(
            groups_of(contacts),
            articulations(system),
            table,
            find_broad_phase(contacts, table, bodies),
            find_part_pairs(contacts, table),
        )


def assemble(system: System, engine: Engine) -> LaidOut:
    """Layout of a system in the memory of an engine, at its start, which is checked. For a model that runs.

    Raises
    ------
    InvalidInput
        If bodies overlap at the start, a joint is not closed there, or a guard has no value.
    """
    model = lay_out(system, engine)
    check_start(model)
    return model


def lay_out(system: System, engine: Engine) -> LaidOut:
    """Layout of a system at its start, with the neighbour list there, but no check of the start.

    For queries that place bodies, which may overlap before that.

    Raises
    ------
    InvalidInput
        If a search finds more features near each other than there are contacts for them.
    """
    model = lay(system, engine)
    # coordinates, then velocities; energy accounts and inner states follow, and begin at zero
    model.memory[owners.Island.y][: model.n_q + model.n_u] = np.concatenate(system.starts())
    model.list_contacts()
    return model


def lay(system: System, engine: Engine) -> LaidOut:
    """Layout of a system whose memory holds no state yet: sizes, parameters, and addresses of functions.

    Counts and settings of the engine are read and checked before the memory is allocated. Bodies, joints, loads,
    contacts, bounding spheres and guards are then written in turn, as later ones refer to the places of earlier ones.

    Raises
    ------
    InvalidInput
        If the engine cannot run the system or declares something wrong, or a guard has no value at the start.
    """
    engine.check(system)
    check_report(engine)
    # t = 0 s, where each system starts
    check_guards(system, 0.0, *system.starts())
    contacts, parts = system.contacts, _Parts.of(system)
    counts = _counts(system, parts)
    slot_counts = functools.partial(_slot_counts, engine, counts["n_u"], counts["n_y"])
    counts |= slot_counts(parts.broad_phase.n_slots)
    scales = scales_of(system)
    settings = settings_of(engine, scales)
    check_gap_tolerance(system, settings.get(owners.Tolerance.gap, 0.0))
    memory = allocate(counts, laid_own(engine, counts))
    blocks = Heap(memory)
    # by these addresses functions of the engine call each other if they are compiled separately
    memory[owners.ModelNumbers.entry_points][: len(entry_addresses())] = entry_addresses()
    bodies = lay_bodies(system, memory, blocks, parts.articulations, scales.acceleration)
    lay_joints(memory, blocks, parts.articulations, bodies)
    lay_loads(system, memory, blocks, bodies)
    lay_contacts(memory, blocks, contacts, parts.table, parts.groups, bodies)
    # offset of each frame, by the numbers of body and frame
    frames = {(body.number, frame): at for body in bodies.values() for frame, at in enumerate(body.frames)}
    lay_broad_phase(memory, parts.broad_phase, frames)
    lay_part_pairs(memory, blocks, parts.pairs, frames)
    lay_searches(memory, blocks, parts.broad_phase.searches, parts.table, parts.broad_phase.frames)
    lay_guards(system, memory, blocks)
    # the arrays move to make room for the blocks behind them: views of the old memory are no longer valid
    memory = blocks.close()
    marks = marks_behind_blocks(memory)
    model = LaidOut(system, memory, slot_counts, counts["n_q"], counts["n_u"], counts["n_states"], marks)
    for scalar, value in settings.items():
        memory[scalar] = value
    # the engine evaluates numbers of its own that no run changes
    engine.prepare(model)
    return model


def _counts(system: System, parts: _Parts) -> dict[str, int]:
    """Counts of a system that the memory is allocated for, by name, without those that follow from slots."""
    contacts = system.contacts
    # number of velocities of the articulation of each body
    together = np.array([sum(body.n_u for body in one.bodies) for one in parts.articulations for _ in one.bodies])
    n_q = sum(body.n_q for body in system.bodies)
    n_u = sum(body.n_u for body in system.bodies)
    n_states = sum(len(row) * len(initial_state(row.laws.friction)) for row in contacts.rows)
    n_y = n_q + n_u + N_ACCOUNTS + n_states
    return {
        "n_bodies": len(system.bodies),
        "n_declared": len(contacts),
        "n_rows": len(contacts.rows),
        # the rows of a group have the same kinds
        "n_kinds": sum(len(contacts.rows[rows[0]]) for rows in parts.groups),
        **parts.broad_phase.lengths,
        "n_pairs": len(parts.pairs),
        "n_carriers": len(carriers_of(parts.pairs)),
        "n_own_guards": len(system.guards),
        "n_loads": len(system.loads),
        "n_joints": len(system.joints),
        "n_articulations": len(parts.articulations),
        "n_q": n_q,
        "n_u": n_u,
        "n_y": n_y,
        "n_states": n_states,
        "map_width": _map_width([contacts.rows[rows[0]].laws.impact for rows in parts.groups]),
        "most_velocities": int(together[parts.table.bodies].max(initial=0)),
        "sample_capacity": _SAMPLES,
    }


def _slot_counts(engine: Engine, n_u: int, n_y: int, n_slots: int) -> dict[str, int]:
    """Counts that follow from the number of slots for active contacts, in a system with ``n_u`` and ``n_y`` numbers.

    An event in the buffers has a head with the velocities before, the state after and the accounted energies, and
    ``LISTED`` floats and two integers (number and code) for each active contact.
    """
    found = {
        "n_slots": n_slots,
        "event_floats": _length_of_events(EVENT_HEAD + n_u + n_y + BOOKED, LISTED, n_slots),
        "event_integers": _length_of_events(CODE_HEAD, 2, n_slots),
    }
    # the engine decides the others; those that it leaves out are zero
    others = dict.fromkeys((name for name in SLOT_COUNTS if name not in found), 0)
    return {**found, **others, **counts_of(engine, n_slots, others)}


def _map_width(laws: Sequence[ImpactLaw | None]) -> int:
    """Number of parameters per contact of an impact map (a law that maps velocities), 1 without one.

    An impact map gets the parameters of all contacts as one matrix, so all contacts have the same map.
    """
    maps = (law for law in laws if isinstance(law, ImpactMap))
    return next((len(parameter_names(law.impulses, "map")) for law in maps), 1)


def _length_of_events(head: int, per_contact: int, n_slots: int) -> int:
    """Length of a buffer of events: 2048 of the usual size, and as many of the largest size as one instant may have.

    An event takes ``head`` numbers, and ``per_contact`` for each of at most ``n_slots`` active contacts.
    """
    # Python empties the buffers only between instants, so all events of an instant must fit
    usual, largest = head + per_contact * min(n_slots, _CONTACTS_PER_EVENT), head + per_contact * n_slots
    return _EVENTS * usual + MOST_EVENTS * largest
