"""Writes contacts and their laws into the memory.

Contacts with the same geometry and laws form a kind. Its contacts share all numbers that no run changes. Kinematics are
compiled and their parameters are read once for each kind. The laws are the same for all kinds of a row of contacts, so
they are compiled and read once for each group of equal rows.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from nonsmooth.binding.bounds import FRAMES, try_out
from nonsmooth.binding.compile import address_alone, bind, parameter_names, parameter_place, vector_place
from nonsmooth.binding.law_functions import LawFunction, law_functions
from nonsmooth.binding.source import name_of
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import CANDIDATE, FORCE_AND_MOMENT, FRAME, PAIR
from nonsmooth.engine.memory.heap import Heap, output_block
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import AnisotropicFrictionLaw, CompliantNormalLaw, ImpactMap, StatefulFrictionLaw, TractionLaw
from nonsmooth.model.laying import BodyLayouts
from nonsmooth.model.row_table import RowTable
from nonsmooth.parameters import SharedNumbers, Value
from nonsmooth.system.contact import Contact
from nonsmooth.system.contacts import Contacts

_CONTACT = owners.ContactRecord
Groups: TypeAlias = Sequence[NDArray[np.int64]]
"""Indices of the rows of contacts with the same kinds."""


@dataclass
class Block:
    """Numbers of a kind behind the arrays of the memory, the same for all contacts of a kind at the start.

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
    """Fields and block of the kinematics of a kind of contacts, or of its laws.

    Attributes
    ----------
    fields : dict
        Fields of the record of the kind, by their declarations in the record of active contacts.
    block : Block
        Parameters, and the outputs of laws. Of the parameters of kinematics, a run writes only the features that a
        search finds.
    """

    fields: dict[Any, float] = field(default_factory=dict)
    block: Block = field(default_factory=Block)


def lay_contacts(
    memory: Memory, blocks: Heap, contacts: Contacts, table: RowTable, groups: Groups, bodies: BodyLayouts
) -> None:
    """Write the rows and kinds of declared contacts.

    The contacts of a kind have the same geometry and laws, so they share the fields of its record, and parameters that
    nothing writes. Kinds with the same kinematics share its parameters, too: these are most of the numbers of a kind.
    """
    # functions with large tables that were tried out, which takes long
    tried = set[tuple[Any, ...]]()
    # where the parameters of a kinematics are, by its identity
    known: dict[int, int] = {}
    geometry_stride, law_stride = owners.KindRecord.geometry_stride, owners.KindRecord.law_stride
    number = 0
    for group in groups:
        row, times = contacts.rows[group[0]], len(group)
        memory[owners.RowRecord.first_kind][group], memory[owners.RowRecord.rank][group] = number, np.arange(times)
        # all contacts of a row have the same laws
        laws, kinds = laws_of(memory, row.contact(0)), slice(number, number + len(row))
        write_fields(memory, kinds, laws.fields)
        _lay_block(memory, blocks, laws.block, kinds, times, law_stride)
        for contact in map(row.contact, range(len(row))):
            kind, own = _geometry_of(contact, tried), slice(number, number + 1)
            write_fields(memory, own, kind.fields)
            start = None if kind.block.written else known.get(id(contact.kinematics))
            known[id(contact.kinematics)] = _lay_block(memory, blocks, kind.block, own, times, geometry_stride, start)
            number += 1
    memory[owners.RowRecord.first_contact] = contacts.starts
    lay_states(memory, contacts)
    _lay_sides(memory, table, bodies)


def write_fields(memory: Memory, kinds: slice, fields: Mapping[Any, Any]) -> None:
    """Write fields of the records of kinds, by their declarations in the record of active contacts."""
    for declared, value in fields.items():
        memory[getattr(owners.KindRecord, declared.name)][kinds] = value


def _lay_block(
    memory: Memory, blocks: Heap, block: Block, kinds: slice, n_rows: int, stride: Any, start: int | None = None
) -> int:
    """Write the block of some kinds, and return the offset of its first copy.

    A block that no run changes is written once, for all kinds. Any other block is written for each kind and each of its
    ``n_rows`` contacts. The copies follow one another. Their distance becomes the field ``stride`` of the kinds. If the
    block is already at the offset ``start``, it is not written again.
    """
    n_kinds = kinds.stop - kinds.start
    copies, size = (n_rows, len(block.numbers)) if block.written else (1, 0)
    n_blocks = copies * n_kinds if block.written else 1
    first = blocks.repeat(block.numbers, n_blocks) if start is None else start
    starts = first + size * np.arange(n_blocks)
    for place, length in block.written:
        blocks.write(starts + place, length)
    firsts = first + size * copies * np.arange(n_kinds)
    memory[stride][kinds] = size
    write_fields(memory, kinds, {declared: firsts + offset for declared, offset in block.offsets.items()})
    for place, begin, shared in block.tables if start is None else ():
        blocks.refer(starts + place, starts + begin, shared)
    return first


def groups_of(contacts: Contacts) -> Groups:
    """Indices of the rows with the same kinds: the very same objects for the geometries of their contacts, and laws."""
    same = defaultdict[tuple[int, ...], list[int]](list)
    for number, row in enumerate(contacts.rows):
        laws = row.laws.normal, row.laws.friction, row.laws.impact
        same[tuple(map(id, (row.kinematics if len(row) > 1 else row.kinematics[0], *laws)))].append(number)
    return [np.array(rows) for rows in same.values()]


def lay_states(memory: Memory, contacts: Contacts) -> None:
    """Write the first place of the inner states of each row, and their scales for the error of a step.

    The inner states of friction laws come last in the state, in the order of the contacts.
    """
    scales: list[float] = []
    for number, row in enumerate(contacts.rows):
        if isinstance(law := row.laws.friction, (TractionLaw, StatefulFrictionLaw)):
            memory[owners.RowRecord.inner_states][number] = len(scales)
            scales += len(row) * [*law.state_scale]
    n_y = int(memory[owners.ModelNumbers.n_y])
    # not [-len:], which would be all numbers if there are no scales
    memory[owners.Step.y_scale][:n_y][n_y - len(scales) :] = scales


def _lay_sides(memory: Memory, table: RowTable, bodies: BodyLayouts) -> None:
    """Write sizes, bodies and frames of each row.

    The frames of a body follow each other, each with its motion and a Jacobian of 6 rows.
    """
    # a mechanism without contacts may have no frame
    rows = [(next(iter(b.frames), 0), b.n_u, b.column, b.articulation) for b in bodies.values()]
    first_frame, n_u, column, articulation = np.array(rows, np.int64).reshape(-1, 4).T
    fields: dict[str, np.ndarray] = {"size": table.extents.min(axis=1), "spin_axis": table.revolutions}
    for number, side in enumerate("ab"):
        body = table.bodies[:, number]
        fields |= {
            f"body_{side}": body,
            f"frame_{side}": first_frame[body] + (FRAME + 6 * n_u[body]) * table.frames[:, number],
            f"n_u_{side}": n_u[body],
            f"column_{side}": column[body],
            f"articulation_{side}": articulation[body],
            f"support_radius_{side}": table.support_radii[:, number],
        }
    for name, values in fields.items():
        memory[getattr(owners.RowRecord, name)] = values


def initial_state(law: Any) -> tuple[float, ...]:
    """Inner states of a friction law at the start of a run; none for a law without them."""
    return law.initial_state if isinstance(law, (TractionLaw, StatefulFrictionLaw)) else ()


def _geometry_of(contact: Contact, tried: set[tuple[Any, ...]]) -> Kind:
    """Compile the kinematics of a contact, and collect the fields and the block of its kind.

    A function with large tables takes long to try out, so such a function is tried out once with the same tables.
    ``tried`` holds these functions with their tables, and this function adds to it.
    """
    made, kinematics = Kind(), contact.kinematics
    function, available = kinematics.evaluator, kinematics.values
    names = parameter_names(function, "pair")
    tables = {n: v for n in names if isinstance(v := available.get(n), SharedNumbers)}
    # the parameters, with nothing in place of tables: the memory holds each table once, and a reference to it here
    without_tables, owner = {**available, **dict.fromkeys(tables, ())}, str(contact)
    made.fields[_CONTACT.geometry_function], values = bind(function, "pair", without_tables, owner)
    key = function, *map(id, tables.values())
    if key not in tried:
        # the trial reads the tables behind the parameters
        with_tables = bind(function, "pair", available, owner)[1] if tables else values
        try_out(function, "pair", available, with_tables, PAIR, owner, FRAMES)
    if tables:
        tried.add(key)
    start = made.block.store(_CONTACT.geometry_parameters, values)
    made.block.tables = [(start + parameter_place(function, "pair", n), start, table) for n, table in tables.items()]
    if kinematics.candidates is not None:
        # what a search finds: kind and numbers of two features, and the distance up to which they are valid
        place = start + vector_place(function, "pair", values, "candidate")
        made.block.mark_written(_CONTACT.features, place, CANDIDATE + 1)
    if (bound := kinematics.bound) is not None:
        made.fields[_CONTACT.bound_function] = _address_of_bound(contact, bound, available, values, tables)
    return made


def laws_of(memory: Memory, contact: Contact) -> Kind:
    """Compile the laws of a contact, and collect their fields and their block.

    The address of an impact map is written into the memory, because all contacts share it.
    """
    made, law, impact = Kind(), contact.friction, contact.impact
    # duration of an impact [s], and gap up to which a compliant contact acts [m]
    made.fields[_CONTACT.contact_time] = 0.0 if impact is None else impact.contact_time
    made.fields[_CONTACT.reach] = contact.normal.reach if isinstance(contact.normal, CompliantNormalLaw) else 0.0
    for part in law_functions(law, impact, contact.normal):
        _add_law(made, contact, part)
    start = initial_state(contact.friction)
    # a law with inner states writes their rates; a traction law also force and moment
    if start or isinstance(law, TractionLaw):
        made.fields[_CONTACT.n_inner_states] = len(start)
        made.block.store(_CONTACT.inner_states_at_start, start)
        made.block.output(_CONTACT.traction_out, FORCE_AND_MOMENT + len(start))
        made.block.output(_CONTACT.rates_out, len(start))
    if isinstance(law, AnisotropicFrictionLaw):
        # the block has the body that carries the axis (0 or 1), the unit axis, and the ratios forward, backward, across
        on_second = float(law.body == "second")
        made.fields[_CONTACT.is_anisotropic] = True
        made.block.store(
            _CONTACT.anisotropy, (on_second, *np.divide(law.axis, math.hypot(*law.axis)).tolist(), *law.ratios)
        )
    if isinstance(impact, ImpactMap):
        made.block.store(_CONTACT.map_parameters, _map_values(memory, impact))
    return made


def _owner_of(part: LawFunction, contact: Contact) -> str:
    """Name of the law that a function belongs to, and its contact, for messages."""
    return f"{type(part.law).__name__} ({contact})"


def _add_law(made: Kind, contact: Contact, part: LawFunction) -> None:
    """Compile a function of a law, try it out, and add its address and parameters to a kind.

    Inner states that a coefficient of friction reads are marked as numbers that a run writes.
    """
    function, form, law = part.function, part.form, part.law
    available = law.parameters()
    # a coefficient of friction may take the inner states as a parameter, "state"
    is_coefficient = part.address is _CONTACT.friction_function
    with_state = law if is_coefficient and isinstance(law, StatefulFrictionLaw) else None
    if with_state is not None:
        available = {**available, "state": with_state.initial_state}
    made.fields[part.address], values = bind(function, form, available, _owner_of(part, contact))
    _try_function(contact, part, values)
    start = made.block.store(part.parameters, values)
    if with_state is not None:
        place = start + _place_of_state(with_state, values)
        made.block.mark_written(_CONTACT.inner_states_copy, place, len(with_state.initial_state))


def _address_of_bound(
    contact: Contact,
    bound: Callable[..., None],
    available: Mapping[str, Value],
    values: Sequence[float],
    tables: Mapping[str, SharedNumbers],
) -> int:
    """Compile the bound of a contact, which reads the parameters of its evaluator; return the address.

    The parameters are ``available`` by name, and in the block ``values``. Those in ``tables`` are not in the block.

    Raises
    ------
    InvalidInput
        If its arguments are not those of the evaluator.
    """
    kinematics = contact.kinematics
    wanted, found = (parameter_names(function, "pair") for function in (kinematics.evaluator, bound))
    if found != wanted:
        raise InvalidInput(
            f"{name_of(bound)}, the bound of the {contact}",
            "must have the arguments of the evaluator",
            found,
            f"Name its arguments after a, b and out {', '.join(wanted)}.",
        )
    owner = str(contact)
    # with large tables a trial takes long
    if not tables:
        try_out(bound, "pair", available, values, PAIR, owner, FRAMES)
    return address_alone(bound, "pair", {**available, **dict.fromkeys(tables, ())}, owner)


def _try_function(contact: Contact, part: LawFunction, values: Sequence[float]) -> None:
    """Call a function that writes to a block once as Python, to find one that writes past it.

    Functions of other forms return a number and write nothing, so they need no trial.
    """
    start = initial_state(contact.friction)
    # by form: size of the block, and any valid arguments before the parameters. These are
    # traction: normal force, slip with spin, inner states; rates: slip speed, inner states
    trials: Mapping[str, tuple[int, Sequence[float | Sequence[float]]]] = {
        "traction": (FORCE_AND_MOMENT + len(start), (1.0, (0.1, 0.2, 0.3, 0.4, 0.5), start)),
        "rates": (len(start), (0.1, start)),
    }
    if part.form in trials:
        size, arguments = trials[part.form]
        owner = _owner_of(part, contact)
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
