"""Writes contacts and their laws into the memory.

Contacts with the same geometry and laws form a kind. Functions are compiled and parameters read once for each kind, and
each contact of the kind gets a copy of the same block.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from operator import attrgetter, itemgetter
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from nonsmooth.binding.bounds import try_out
from nonsmooth.binding.compile import bind, parameter_names, parameter_place, vector_place
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import CANDIDATE, FORCE_AND_MOMENT, FRAME, PAIR
from nonsmooth.engine.memory.memory import Heap, Memory, output_block
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import (
    AnisotropicFrictionLaw,
    CompliantNormalLaw,
    FrictionLaw,
    ImpactMap,
    ImpactProcess,
    StatefulFrictionLaw,
    TangentialLaw,
    TractionLaw,
)
from nonsmooth.model.contact_table import ContactTable
from nonsmooth.model.laying import BodyLayouts
from nonsmooth.parameters import Table, Value
from nonsmooth.system.contact import Contact

_CONTACT = owners.Contact
Kinds: TypeAlias = Sequence[list[int]]
"""The numbers of the contacts of each kind."""


class _Function(NamedTuple):
    """A function of a contact.

    Attributes
    ----------
    address, parameters : declaration
        Fields of a contact for the address of the function, and for the place of its parameters.
    function : callable
        The function.
    form : str
        The form of its arguments.
    available : mapping
        Parameters that may be among its arguments.
    part : object
        The kinematics or law that has the function.
    """

    address: Any
    parameters: Any
    function: Callable[..., Any]
    form: str
    available: Mapping[str, Value]
    part: object


@dataclass
class Kind:
    """Fields and block of a contact, the same for all contacts with the same geometry and laws.

    Attributes
    ----------
    fields : dict
        Fields of the declared contact, by their declarations.
    offsets : dict
        Fields that are places in the block, from its start, by their declarations.
    block : list of float
        The block.
    written : list of tuple
        (place in the block, length) of numbers that the engine or a law writes.
    tables : list of tuple
        (place in the block, place from which its distance counts, table).
    """

    fields: dict[Any, int] = field(default_factory=lambda: {_CONTACT.mode: Mode.OPEN})
    offsets: dict[Any, int] = field(default_factory=dict)
    block: list[float] = field(default_factory=list)
    written: list[tuple[int, int]] = field(default_factory=list)
    tables: list[tuple[int, int, Table]] = field(default_factory=list)

    def store(self, declared: Any, values: Sequence[float]) -> int:
        """Append values, whose place is a field of the contact; the result is the place."""
        start = self.offsets[declared] = len(self.block)
        self.block += values
        return start

    def output(self, declared: Any, size: int) -> None:
        """Append numbers that a law writes, whose place is a field of the contact."""
        self.written.append((self.store(declared, output_block(size)), size))


def lay_contacts(
    memory: Memory, blocks: Heap, contacts: Sequence[Contact], table: ContactTable, kinds: Kinds, bodies: BodyLayouts
) -> None:
    """Write the declared contacts, and reserve the Jacobians of the active ones."""
    contact, tried = owners.Contact, set[tuple[Any, ...]]()
    for numbers in kinds:
        kind = kind_of(memory, contacts[numbers[0]], tried)
        starts = blocks.repeat(kind.block, len(numbers)) + len(kind.block) * np.arange(len(numbers))
        for place, size in kind.written:
            blocks.write(starts + place, size)
        for declared, value in kind.fields.items():
            memory.declared(declared)[numbers] = value
        for declared, offset in kind.offsets.items():
            memory.declared(declared)[numbers] = offset + starts
        for place, start, shared in kind.tables:
            for begin in starts.tolist():
                blocks.refer(begin + place, begin + start, shared)
    _lay_states(memory, contacts, kinds)
    size = 3 * _lay_sides(memory, table, bodies)
    memory.declared(contact.direction)[:, 0] = 1.0
    memory.declared(contact.support_radius_a)[:] = table.support_radii[:, 0]
    memory.declared(contact.support_radius_b)[:] = table.support_radii[:, 1]
    memory.declared(contact.size)[:] = table.extents.min(axis=1)
    memory.declared(contact.spin_axis)[:] = table.revolutions
    lay_law_floats(memory, contacts, kinds)
    n_slots = int(memory[owners.Model.n_slots])
    for place in (contact.jacobian_a, contact.jacobian_b, contact.response_a, contact.response_b):
        memory[place] = blocks.block(size * n_slots) + size * np.arange(n_slots)


def by_kind(contacts: Sequence[Contact]) -> Kinds:
    """Numbers of the contacts of each kind."""
    same = defaultdict[tuple[int, ...], list[int]](list)
    parts = [map(id, map(attrgetter(part), contacts)) for part in ("kinematics", "normal", "friction", "impact")]
    for number, key in enumerate(zip(*parts, strict=True)):
        same[key].append(number)
    return list(same.values())


def _lay_states(memory: Memory, contacts: Sequence[Contact], kinds: Kinds) -> None:
    """Write the number of the first inner state of each contact, and the usual size of the inner states."""
    scales: list[float] = []
    laws = [(numbers, contacts[numbers[0]].friction) for numbers in kinds]
    with_states = [(numbers, law) for numbers, law in laws if isinstance(law, (TractionLaw, StatefulFrictionLaw))]
    for number, law in sorted(((number, law) for numbers, law in with_states for number in numbers), key=itemgetter(0)):
        memory.declared(owners.Contact.inner_states)[number] = len(scales)
        scales += law.state_scale
    n_y = int(memory[owners.Model.n_y])
    memory[owners.Step.y_scale][:n_y][n_y - len(scales) :] = scales


def _lay_sides(memory: Memory, table: ContactTable, bodies: BodyLayouts) -> int:
    """Write bodies and frames of each contact; the result is the largest number of velocities of an articulation."""
    layouts, most = [*bodies.values()], 0
    # a mechanism without contacts may have no frame
    first_frame = np.array([next(iter(layout.frames), 0) for layout in layouts], np.int64)
    sizes = np.array([layout.articulation_n_u for layout in layouts], np.int64)
    of_body = {
        "n_u": np.array([layout.n_u for layout in layouts]),
        "column": np.array([layout.column for layout in layouts]),
        "articulation": np.array([layout.articulation for layout in layouts]),
    }
    for side, column in (("a", 0), ("b", 1)):
        body, frame = table.bodies[:, column], table.frames[:, column]
        fields = {"body": body, "frame": first_frame[body] + (FRAME + 6 * of_body["n_u"][body]) * frame}
        for name, values in (fields | {name: values[body] for name, values in of_body.items()}).items():
            memory.declared(getattr(owners.Contact, f"{name}_{side}"))[:] = values
        most = max(most, int(sizes[body].max(initial=0)))
    return most


def lay_law_floats(memory: Memory, contacts: Sequence[Contact], kinds: Kinds) -> None:
    """Write the numbers of the laws that are fields of a declared contact."""
    contact = owners.Contact
    for numbers in kinds:
        normal, impact = contacts[numbers[0]].normal, contacts[numbers[0]].impact
        memory.declared(contact.contact_time)[numbers] = 0.0 if impact is None else impact.contact_time
        # the time-stepping fallback was not tried yet
        memory.declared(contact.mean_forces_asked)[numbers] = -math.inf
        memory.declared(contact.reach)[numbers] = normal.reach if isinstance(normal, CompliantNormalLaw) else 0.0


def initial_state(contact: Contact) -> tuple[float, ...]:
    """Inner states of the friction of a contact at the start."""
    law = contact.friction
    return law.initial_state if isinstance(law, (TractionLaw, StatefulFrictionLaw)) else ()


def kind_of(memory: Memory, contact: Contact, tried: set[tuple[Any, ...]] | None = None) -> Kind:
    """Compile the functions of a contact, and collect the fields and the block of its kind.

    ``tried`` holds the functions with tables that were tried out already. Without it no function with tables is tried.
    """
    made, law, impact = Kind(), contact.friction, contact.impact
    for one in _functions(contact):
        _add_function(made, contact, one, tried)
    start = initial_state(contact)
    if start or isinstance(law, TractionLaw):
        made.fields[_CONTACT.n_inner_states] = len(start)
        made.store(_CONTACT.inner_states_at_start, start)
        made.output(_CONTACT.traction_out, FORCE_AND_MOMENT + len(start))
        made.output(_CONTACT.rates_out, len(start))
    if isinstance(law, AnisotropicFrictionLaw):
        on_second = float(law.body == "second")
        made.fields[_CONTACT.is_anisotropic] = True
        made.store(_CONTACT.anisotropy, (on_second, *np.divide(law.axis, math.hypot(*law.axis)).tolist(), *law.ratios))
    if isinstance(impact, ImpactMap):
        made.store(_CONTACT.map_parameters, _map_values(memory, impact))
    return made


def _functions(contact: Contact) -> Iterator[_Function]:
    """The functions of the kinematics and of the laws, in the order of their parameters in the block."""
    kinematics, normal, impact = contact.kinematics, contact.normal, contact.impact
    yield _Function(
        _CONTACT.geometry_function,
        _CONTACT.geometry_parameters,
        kinematics.evaluator,
        "pair",
        kinematics.parameters(),
        kinematics,
    )
    yield from _friction_functions(contact.friction)
    if isinstance(normal, CompliantNormalLaw):
        yield _Function(
            _CONTACT.normal_function,
            _CONTACT.normal_parameters,
            normal.force,
            "compliance",
            normal.parameters(),
            normal,
        )
    if isinstance(impact, ImpactProcess):
        yield _Function(
            _CONTACT.impact_force_function,
            _CONTACT.impact_force_parameters,
            impact.force,
            "scalar",
            impact.parameters(),
            impact,
        )
        yield _Function(
            _CONTACT.efficiency_function,
            _CONTACT.efficiency_parameters,
            impact.efficiency,
            "scalar",
            impact.parameters(),
            impact,
        )


def _friction_functions(law: TangentialLaw) -> Iterator[_Function]:
    if isinstance(law, TractionLaw):
        yield _Function(
            _CONTACT.traction_function, _CONTACT.traction_parameters, law.traction, "traction", law.parameters(), law
        )
    elif isinstance(law, StatefulFrictionLaw):
        with_state = {**law.parameters(), "state": law.initial_state}
        yield _Function(
            _CONTACT.friction_function, _CONTACT.friction_parameters, law.coefficient, "scalar", with_state, law
        )
        yield _Function(_CONTACT.rates_function, _CONTACT.rates_parameters, law.rates, "rates", law.parameters(), law)
    else:
        assert isinstance(law, FrictionLaw)
        yield _Function(
            _CONTACT.friction_function, _CONTACT.friction_parameters, law.coefficient, "scalar", law.parameters(), law
        )


def _add_function(made: Kind, contact: Contact, one: _Function, tried: set[tuple[Any, ...]] | None) -> None:
    """Compile a function, try it out, and add its address and its parameters to a kind."""
    function, form, available, part = one.function, one.form, one.available, one.part
    owner = f"{type(part).__name__} ({contact})"
    tables = {n: v for n in parameter_names(function, form) if isinstance(v := available.get(n), Table)}
    address, values = bind(function, form, {**available, **dict.fromkeys(tables, ())}, owner)
    _try_function(contact, one, owner, values, tables, tried)
    made.fields[one.address] = address
    at = made.store(one.parameters, values)
    made.tables += [(at + parameter_place(function, form, n), at, table) for n, table in tables.items()]
    if one.parameters is _CONTACT.geometry_parameters and contact.kinematics.candidates is not None:
        made.offsets[_CONTACT.features] = at + vector_place(function, form, values, "candidate")
        # two features and their kind, and the distance to which they are valid
        made.written.append((made.offsets[_CONTACT.features], CANDIDATE + 1))
    if one.parameters is _CONTACT.friction_parameters and isinstance(part, StatefulFrictionLaw):
        made.offsets[_CONTACT.inner_states_copy] = at + _place_of_state(part, values)
        made.written.append((made.offsets[_CONTACT.inner_states_copy], len(part.initial_state)))


def _try_function(
    contact: Contact,
    one: _Function,
    owner: str,
    values: Sequence[float],
    tables: Mapping[str, Table],
    tried: set[tuple[Any, ...]] | None,
) -> None:
    """Call a function that writes to a block once as Python, to find one that writes past it."""
    function, form, available = one.function, one.form, one.available
    start = initial_state(contact)
    if form == "pair":
        key = function, *map(id, tables.values())
        if not tables or (tried is not None and key not in tried):
            if tried is not None:
                tried.add(key)
            all_values = bind(function, form, available, owner)[1] if tables else values
            try_out(function, form, available, all_values, PAIR, owner)
    elif form == "traction":
        arguments = 1.0, (0.1, 0.2, 0.3, 0.4, 0.5), start
        try_out(function, form, available, values, FORCE_AND_MOMENT + len(start), owner, arguments)
    elif form == "rates":
        try_out(function, form, available, values, len(start), owner, (0.1, start))


def _place_of_state(law: StatefulFrictionLaw, values: Sequence[float]) -> int:
    """Place of the inner states among the parameters of a friction coefficient.

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
    """Compile an impact law that maps velocities; the result has its parameters, without the coefficient of friction.

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
    available: dict[str, Value] = {**impact.parameters(), "friction": 0.0}
    address, values = bind(impact.impulses, "map", available, type(impact).__name__)
    one_contact = 1, tuple(2.0 * np.eye(3).ravel()), (-1.0, 0.2, 0.1)
    try_out(impact.impulses, "map", available, values, 3, type(impact).__name__, one_contact)
    memory[owners.Options.impact_map] = address
    return values[1:]
