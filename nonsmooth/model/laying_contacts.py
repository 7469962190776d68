"""Writes contacts and their laws into the memory.

Contacts with the same geometry and laws form a kind. Functions are compiled and parameters read once for each kind.
Each contact gets a copy of the block of its laws; contacts with the same kinematics share its parameters.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from nonsmooth.binding.bounds import FRAMES, try_out
from nonsmooth.binding.compile import bind, parameter_names, parameter_place, vector_place
from nonsmooth.binding.law_functions import LawFunction, law_functions
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import CANDIDATE, FORCE_AND_MOMENT, FRAME, PAIR
from nonsmooth.engine.memory.memory import Heap, Memory, output_block
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import AnisotropicFrictionLaw, CompliantNormalLaw, ImpactMap, StatefulFrictionLaw, TractionLaw
from nonsmooth.model.contact_table import ContactTable
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.laying import BodyLayouts
from nonsmooth.parameters import SharedNumbers, Value
from nonsmooth.system.contact import Contact
from nonsmooth.system.contacts import Contacts
from nonsmooth.system.system import System

_CONTACT = owners.ContactRecord
Kinds: TypeAlias = Sequence[NDArray[np.int64]]
"""Indices of the contacts of each kind."""


@dataclass
class Block:
    """Numbers of a contact behind the arrays of the memory, the same for all contacts of a kind at the start.

    Attributes
    ----------
    offsets : dict
        Offsets in the block, by the declarations of the fields that hold them.
    numbers : list of float
        The block.
    written : list of tuple
        (offset in the block, length) of numbers that the engine or a law writes.
    tables : list of tuple
        (offset of a reference in the block, offset from which the reference counts, table that it refers to).
    """

    offsets: dict[Any, int] = field(default_factory=dict)
    numbers: list[float] = field(default_factory=list)
    written: list[tuple[int, int]] = field(default_factory=list)
    tables: list[tuple[int, int, SharedNumbers]] = field(default_factory=list)

    def store(self, declared: Any, values: Sequence[float]) -> int:
        """Append values to the block; return their offset, which becomes the field ``declared``."""
        start = self.offsets[declared] = len(self.numbers)
        self.numbers += values
        return start

    def output(self, declared: Any, size: int) -> None:
        """Reserve ``size`` floats of the block, which a law writes; their offset becomes the field ``declared``.

        Sentinel numbers follow them. They reveal a law that writes more than ``size`` numbers.
        """
        self.mark_written(declared, self.store(declared, output_block(size)), size)

    def mark_written(self, declared: Any, place: int, size: int) -> None:
        """Mark ``size`` numbers of the block as written in a run; their offset becomes the field ``declared``.

        A saved checkpoint holds such numbers, but no parameters.
        """
        self.offsets[declared] = place
        self.written.append((place, size))


@dataclass
class Kind:
    """Fields and blocks of a contact, the same for all contacts with the same geometry and laws.

    Attributes
    ----------
    fields : dict
        Fields of the declared contact, by their declarations.
    geometry : Block
        Parameters of the kinematics. Nothing writes them, except those of a search for features.
    laws : Block
        Parameters and outputs of the laws.
    """

    fields: dict[Any, int] = field(default_factory=lambda: {_CONTACT.mode: Mode.OPEN})
    geometry: Block = field(default_factory=Block)
    laws: Block = field(default_factory=Block)


def lay_contacts(
    memory: Memory, blocks: Heap, contacts: Contacts, table: ContactTable, kinds: Kinds, bodies: BodyLayouts
) -> None:
    """Write the declared contacts, and reserve Jacobians for as many as the neighbour list can hold.

    Contacts of a kind have the same geometry and laws, so they get the same fields and equal blocks. Contacts with the
    same kinematics share its parameters if nothing writes them: these are most of the numbers of a contact.
    """
    # functions with large tables that were tried out, which takes long
    tried = set[tuple[Any, ...]]()
    # where the parameters of a kinematics are, by its identity
    known: dict[int, int] = {}
    for numbers in kinds:
        contact = contacts[numbers[0]]
        kind = kind_of(memory, contact, tried)
        for declared, value in kind.fields.items():
            memory.declared(declared)[numbers] = value
        _lay_block(memory, blocks, kind.laws, numbers)
        if kind.geometry.written:
            _lay_block(memory, blocks, kind.geometry, numbers)
        elif (start := known.get(id(contact.kinematics))) is not None:
            for declared, offset in kind.geometry.offsets.items():
                memory.declared(declared)[numbers] = start + offset
        else:
            known[id(contact.kinematics)] = _lay_block(memory, blocks, kind.geometry, numbers, is_shared=True)
    lay_states(memory, contacts, kinds)
    # three rows of a Jacobian over the velocities of the largest articulation (a group of bodies tied by joints)
    size = 3 * _lay_sides(memory, table, bodies)
    # any unit vector, until a slip has a direction
    memory.declared(_CONTACT.direction)[:, 0] = 1.0
    # the first of both sides from which anisotropic friction may be opposed
    memory.declared(_CONTACT.facing)[:] = 1
    memory.declared(_CONTACT.size)[:] = table.extents.min(axis=1)
    memory.declared(_CONTACT.spin_axis)[:] = table.revolutions
    lay_law_floats(memory, contacts, kinds)
    n_slots = int(memory[owners.ModelNumbers.n_slots])
    # each place of the neighbour list has Jacobians of its own
    for place in (_CONTACT.jacobian_a, _CONTACT.jacobian_b, _CONTACT.response_a, _CONTACT.response_b):
        memory[place] = blocks.block(size * n_slots) + size * np.arange(n_slots)


def _lay_block(memory: Memory, blocks: Heap, block: Block, numbers: NDArray[np.int64], is_shared: bool = False) -> int:
    """Write a block for each of the contacts ``numbers``, or one for all of them; return the offset of the first."""
    times = 1 if is_shared else len(numbers)
    # the copies of the block follow each other
    first = blocks.repeat(block.numbers, times)
    starts = first + len(block.numbers) * np.arange(times)
    for place, size in block.written:
        blocks.write(starts + place, size)
    for declared, offset in block.offsets.items():
        memory.declared(declared)[numbers] = offset + starts
    for place, start, shared in block.tables:
        for begin in starts.tolist():
            blocks.refer(begin + place, begin + start, shared)
    return first


def by_kind(contacts: Contacts) -> Kinds:
    """Indices of the contacts of each kind. A kind shares the very same objects for geometry and laws."""
    # rows with the same kinematics and laws: their first contacts are of one kind, their second ones of another
    same = defaultdict[tuple[int, ...], list[int]](list)
    for row, start in zip(contacts.rows, contacts.starts.tolist(), strict=False):
        laws = row.laws.normal, row.laws.friction, row.laws.impact
        same[tuple(map(id, (row.kinematics if len(row) > 1 else row.kinematics[0], *laws)))].append(start)
    counts = dict(zip(contacts.starts.tolist(), contacts.counts.tolist(), strict=False))
    return [np.array(starts) + index for starts in same.values() for index in range(counts[starts[0]])]


def lay_states(memory: Memory, contacts: Contacts, kinds: Kinds) -> None:
    """Write the first place of each contact's inner states, and their scales for the error of a step.

    The inner states of friction laws come last in the state, in the order of the contacts.
    """
    laws = {
        number: law
        for numbers in kinds
        if isinstance(law := contacts[numbers[0]].friction, (TractionLaw, StatefulFrictionLaw))
        for number in numbers.tolist()
    }
    scales: list[float] = []
    for number in sorted(laws):
        memory.declared(_CONTACT.inner_states)[number] = len(scales)
        scales += laws[number].state_scale
    n_y = int(memory[owners.ModelNumbers.n_y])
    # not [-len:], which would be all numbers if there are no scales
    memory[owners.Step.y_scale][:n_y][n_y - len(scales) :] = scales


def _lay_sides(memory: Memory, table: ContactTable, bodies: BodyLayouts) -> int:
    """Write bodies and frames of each contact; the result is the largest number of velocities of an articulation.

    An articulation is a group of bodies tied by joints. The frames of a body follow each other, each with its motion
    and a Jacobian of 6 rows.
    """
    # a mechanism without contacts may have no frame
    rows = [(next(iter(b.frames), 0), b.n_u, b.column, b.articulation, b.articulation_n_u) for b in bodies.values()]
    first_frame, n_u, column, articulation, n_u_together = np.array(rows, np.int64).reshape(-1, 5).T
    for number, side in enumerate("ab"):
        body = table.bodies[:, number]
        fields = {
            "body": body,
            "frame": first_frame[body] + (FRAME + 6 * n_u[body]) * table.frames[:, number],
            "n_u": n_u[body],
            "column": column[body],
            "articulation": articulation[body],
            "support_radius": table.support_radii[:, number],
        }
        for name, values in fields.items():
            memory.declared(getattr(_CONTACT, f"{name}_{side}"))[:] = values
    return int(n_u_together[table.bodies].max(initial=0))


def lay_law_floats(memory: Memory, contacts: Contacts, kinds: Kinds) -> None:
    """Write the times [s] and distances [m] of the laws, which are fields of a declared contact.

    These are the contact time of an impact, 0 without an impact law, and the reach: the gap up to which a compliant law
    acts, 0 for a rigid contact. The time of the last try to leave the time-stepping fallback begins as
    minus infinity.
    """
    for numbers in kinds:
        normal, impact = contacts[numbers[0]].normal, contacts[numbers[0]].impact
        memory.declared(_CONTACT.contact_time)[numbers] = 0.0 if impact is None else impact.contact_time
        # time of the last try to leave the time-stepping fallback, which averages forces: never
        memory.declared(_CONTACT.mean_forces_asked)[numbers] = -math.inf
        memory.declared(_CONTACT.reach)[numbers] = normal.reach if isinstance(normal, CompliantNormalLaw) else 0.0


def initial_state(contact: Contact) -> tuple[float, ...]:
    """Inner states of the friction law of a contact at the start of a run; none for a law without them."""
    law = contact.friction
    return law.initial_state if isinstance(law, (TractionLaw, StatefulFrictionLaw)) else ()


def kind_of(memory: Memory, contact: Contact, tried: set[tuple[Any, ...]] | None = None) -> Kind:
    """Compile the functions of a contact, and collect the fields and the block of its kind.

    The kind holds for all contacts of the same geometry and laws. A function with tables takes long to try out.
    ``tried`` holds those tried so far, and gets the new ones; None tries none of them. The address of an impact map is
    written into the memory, because all contacts share it.
    """
    made, law, impact, kinematics = Kind(), contact.friction, contact.impact, contact.kinematics
    geometry = LawFunction(
        _CONTACT.geometry_function, _CONTACT.geometry_parameters, kinematics, kinematics.evaluator, "pair"
    )
    for part in (geometry, *law_functions(law, impact, contact.normal)):
        _add_function(made, contact, part, tried)
    start = initial_state(contact)
    # a law with inner states writes their rates; a traction law also force and moment
    if start or isinstance(law, TractionLaw):
        made.fields[_CONTACT.n_inner_states] = len(start)
        made.laws.store(_CONTACT.inner_states_at_start, start)
        made.laws.output(_CONTACT.traction_out, FORCE_AND_MOMENT + len(start))
        made.laws.output(_CONTACT.rates_out, len(start))
    if isinstance(law, AnisotropicFrictionLaw):
        # the block has the body that carries the axis (0 or 1), the unit axis, and the ratios forward, backward, across
        on_second = float(law.body == "second")
        made.fields[_CONTACT.is_anisotropic] = True
        made.laws.store(
            _CONTACT.anisotropy, (on_second, *np.divide(law.axis, math.hypot(*law.axis)).tolist(), *law.ratios)
        )
    if isinstance(impact, ImpactMap):
        made.laws.store(_CONTACT.map_parameters, _map_values(memory, impact))
    return made


def _add_function(made: Kind, contact: Contact, part: LawFunction, tried: set[tuple[Any, ...]] | None) -> None:
    """Compile a function of the kinematics or of a law, try it out, and add its address and parameters to a kind.

    Parameters that a run writes are marked: features that a search finds, and inner states that a coefficient reads.
    ``tried`` as in :func:`kind_of`.
    """
    function, form, law, owner = part.function, part.form, part.law, f"{type(part.law).__name__} ({contact})"
    available = law.parameters()
    # a coefficient of friction may take the inner states as a parameter, "state"
    is_coefficient = part.address is _CONTACT.friction_function
    with_state = law if is_coefficient and isinstance(law, StatefulFrictionLaw) else None
    if with_state is not None:
        available = {**available, "state": with_state.initial_state}
    tables = {n: v for n in parameter_names(function, form) if isinstance(v := available.get(n), SharedNumbers)}
    # the parameters, with nothing in place of tables: the memory holds each table once, and a reference to it here
    address, values = bind(function, form, {**available, **dict.fromkeys(tables, ())}, owner)
    # geometry with large tables is slow to try out: once for the same function and tables
    if tables and form == "pair":
        key = function, *map(id, tables.values())
        if tried is not None and key not in tried:
            tried.add(key)
            # the trial reads the tables behind the parameters
            _try_function(contact, part, bind(function, form, available, owner)[1])
    else:
        _try_function(contact, part, values)
    is_geometry = part.address is _CONTACT.geometry_function
    block = made.geometry if is_geometry else made.laws
    made.fields[part.address] = address
    start = block.store(part.parameters, values)
    block.tables += [(start + parameter_place(function, form, n), start, table) for n, table in tables.items()]
    if is_geometry and contact.kinematics.candidates is not None:
        # what a search finds: kind and numbers of two features, and the distance up to which they are valid
        block.mark_written(_CONTACT.features, start + vector_place(function, form, values, "candidate"), CANDIDATE + 1)
    if with_state is not None:
        place = start + _place_of_state(with_state, values)
        block.mark_written(_CONTACT.inner_states_copy, place, len(with_state.initial_state))


def _try_function(contact: Contact, part: LawFunction, values: Sequence[float]) -> None:
    """Call a function that writes to a block once as Python, to find one that writes past it.

    Functions of other forms return a number and write nothing, so they need no trial.
    """
    start = initial_state(contact)
    # by form: size of the block, and any valid arguments before the parameters. These are
    # pair: two frames; traction: normal force, slip with spin, inner states; rates: slip speed, inner states
    trials: Mapping[str, tuple[int, Sequence[float | Sequence[float]]]] = {
        "pair": (PAIR, FRAMES),
        "traction": (FORCE_AND_MOMENT + len(start), (1.0, (0.1, 0.2, 0.3, 0.4, 0.5), start)),
        "rates": (len(start), (0.1, start)),
    }
    if part.form in trials:
        size, arguments = trials[part.form]
        owner = f"{type(part.law).__name__} ({contact})"
        try_out(part.function, part.form, part.law.parameters(), values, size, owner, arguments)


def _place_of_state(law: StatefulFrictionLaw, values: Sequence[float]) -> int:
    """Place of the inner states among ``values``, the parameters of a friction coefficient, where the law reads them.

    Raises
    ------
    InvalidInput
        If the coefficient is no function of the state.
    """
    names = parameter_names(law.coefficient, "scalar")
    if "state" not in names:
        raise InvalidInput(
            f"{type(law).__name__}.coefficient",
            "must take the vector `state` among its arguments",
            names,
            "Write coefficient(speed, state, ...), or subclass FrictionLaw if there is no state.",
        )
    return vector_place(law.coefficient, "scalar", values, "state")


def _map_values(memory: Memory, impact: ImpactMap) -> tuple[float, ...]:
    """Compile an impact map, and write its address; the result has its parameters, without the friction coefficient.

    An impact map gives the impulses of all contacts at once. The engine passes the coefficient of friction of each
    contact in front of its parameters, so the map must take it first.

    Raises
    ------
    InvalidInput
        If the coefficient of friction is not its first parameter.
    """
    names = parameter_names(impact.impulses, "map")
    if names[:1] != ("friction",):
        raise InvalidInput(
            f"{type(impact).__name__}.impulses",
            "must take friction as the first of its own arguments",
            names,
            "Write impulses(n, delassus, rates, out, friction, ...).",
        )
    # any coefficient of friction serves for the trial
    available: dict[str, Value] = {**impact.parameters(), "friction": 0.0}
    address, values = bind(impact.impulses, "map", available, type(impact).__name__)
    # number of contacts, Delassus matrix [1/kg], and rates [m/s]: one that approaches and slips
    one_contact = 1, tuple(2.0 * np.eye(3).ravel()), (-1.0, 0.2, 0.1)
    try_out(impact.impulses, "map", available, values, 3, type(impact).__name__, one_contact)
    memory[owners.Options.impact_map] = address
    # without the coefficient
    return values[1:]


def lay_laws(model: LaidOut, system: System) -> LaidOut:
    """Lay out ``system``, which differs from ``model.system`` in its laws only, in the memory of ``model``.

    No run may be in progress in this memory. Addresses and parameters of the laws are overwritten in place, so
    ``model`` must not be used any more. The geometry does not change.

    Raises
    ------
    InvalidInput
        If bodies or contacts differ, or the laws need blocks of other sizes.
    """
    _check_same(model.system, system)
    memory, contacts, former = model.memory, system.contacts, model.system.contacts
    kinds = by_kind(contacts)
    former_kind = {number: k for k, numbers in enumerate(by_kind(former)) for number in numbers.tolist()}
    for numbers in kinds:
        # the contacts `numbers` have equal laws and geometry now, but their former laws may differ: take one contact
        # for each combination of former laws and geometry
        examples = {former_kind[number]: number for number in numbers.tolist()}.values()
        before, after = [kind_of(memory, former[number]) for number in examples], kind_of(memory, contacts[numbers[0]])
        for number, one in zip(examples, before, strict=True):
            # the new parameters must fit in the places of the old ones, within blocks of the same length
            if (one.laws.offsets, len(one.laws.numbers)) != (after.laws.offsets, len(after.laws.numbers)):
                _refuse(contacts[number], former[number])
        for declared, value in after.fields.items():
            memory.declared(declared)[numbers] = value
        # any field with an offset in the block of the laws shows where this block begins for each contact
        for declared, offset in [*after.laws.offsets.items()][:1]:
            starts = memory.declared(declared)[numbers] - offset
            memory.floats[starts[:, None] + np.arange(len(after.laws.numbers))] = after.laws.numbers
    lay_states(memory, contacts, kinds)
    lay_law_floats(memory, contacts, kinds)
    return replace(model, system=system)


def _check_same(one: System, other: System) -> None:
    """Check that two systems differ in their laws only.

    Bodies, joints, loads and guards must be the very same objects. Contacts must have equal bodies, frames and
    geometry, one by one.

    Raises
    ------
    InvalidInput
        If bodies, gravity, joints, loads, guards or contacts differ.
    """
    remedy = "Make it by nonsmooth.with_laws(model.system, ...), or assemble it."
    if list(map(id, one.bodies)) != list(map(id, other.bodies)) or one.gravity != other.gravity:
        raise InvalidInput("with_laws_of", "needs a system of the same bodies", other, remedy)
    ties = ([tie.component for tie in (*two.joints, *two.loads)] + list(two.guards) for two in (one, other))
    if len({tuple(map(id, parts)) for parts in ties}) > 1 or len(one.contacts) != len(other.contacts):
        raise InvalidInput("with_laws_of", "needs the same joints, loads, guards and contacts", other, remedy)
    for first, second in zip(one.contacts, other.contacts, strict=True):
        has_same_bodies = first.first is second.first and first.second is second.second
        if not has_same_bodies or first.frames != second.frames or first.kinematics != second.kinematics:
            raise InvalidInput("with_laws_of", "needs the same contacts", second.name, remedy)


def _refuse(after: Contact, before: Contact) -> None:
    """Raise InvalidInput: the new laws of a contact need another layout of parameters than its former laws.

    The system must then be assembled anew. ``before`` and ``after`` are the contact with the former and the new laws.
    """
    laws = [", ".join(type(law).__name__ for law in (one.normal, one.friction, one.impact)) for one in (before, after)]
    raise InvalidInput(
        f"with_laws_of: the laws of the {after}",
        f"must be of the kinds of {laws[0]}",
        laws[1],
        "Laws of other kinds need blocks of other sizes: assemble the system.",
    )
